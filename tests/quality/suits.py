"""Learn the weights with which the listener judges whether replies from its bank suit an utterance.

    python tests/quality/suits.py

This command learns the constants of `wildtalk.listening.suitability` from suits_rows.tsv, and prints them. It takes a
minute.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import numpy as np

from ravestate.language.nearest import Nearest
from ravestate.language.reranker import Reranker
from ravestate.language.sentences import sentences
from ravestate.modules.skill.wildtalk.listening.lookup import BESIDE
from ravestate.modules.skill.wildtalk.listening.suitability import Evidence

if TYPE_CHECKING:
    from numpy.typing import NDArray

if __package__:
    from . import measure
else:
    import measure

DECAY = 0.02
"""The weight decay (L2) of normalised features."""
STEPS, RATE = 1500, 0.5


def evidence(name: str) -> tuple[list[Evidence], NDArray[Any]]:
    """Return the evidence of each row of a set, and its label: 1 if the replies suit the utterance."""
    lines = (measure.HERE / f"{name}.tsv").read_text(encoding="utf-8").splitlines()
    rows = [line.split("\t") for line in lines if line and not line.startswith("#")]
    groups = [(utterance, sentences.split(" | ")) for utterance, _, sentences in rows]
    scores = iter(Reranker().score_pairs([(text, said) for said, texts in groups for text in texts]).tolist())
    examples = [text for _, texts in groups for text in texts]
    index, places = Nearest(examples), iter(range(len(examples)))
    index.load()
    found: list[Evidence] = []
    for said, examples in groups:
        at = [next(places) for _ in examples]
        texts = [said, *(one for one in sentences(said) if len(one.split()) >= BESIDE)]
        near = max(index.compared(texts, at))
        found.append(Evidence(near, index.similarities(said, at), [next(scores) for _ in examples]))
    return found, np.array([int(label == "suits") for _, label, _ in rows])


def weights(learnt: list[Evidence], labels: NDArray[Any]) -> NDArray[Any]:
    """Return the constant and the weights that a logistic regression learns."""
    features = np.array([one.features() for one in learnt])
    middle, spread = features.mean(axis=0), features.std(axis=0)
    inputs = np.c_[np.ones(len(features)), (features - middle) / spread]
    found = np.zeros(inputs.shape[1])
    for _ in range(STEPS):
        slope = inputs.T @ (1 / (1 + np.exp(-inputs @ found)) - labels) / len(labels)
        found -= RATE * (slope + DECAY * np.r_[0.0, found[1:]])
    raw = found[1:] / spread
    return np.r_[found[0] - (raw * middle).sum(), raw]


if __name__ == "__main__":
    rows, suit = evidence("suits_rows")
    print("WEIGHTS =", *np.round(weights(rows, suit), 3))
    print("ROUGH =", *np.round(weights([Evidence(one.near, one.meanings) for one in rows], suit), 3))
    sys.exit(0)
