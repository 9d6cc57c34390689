"""The complete text agent computes nothing twice for one utterance."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from ravestate import modules
from ravestate.cli.complete import COMPLETE
from ravestate.language import normal
from ravestate.language.encoder import Encoder
from ravestate.language.reranker import Reranker
from ravestate.modules.meta.nlp.pipeline import Pipeline
from ravestate.testing import simulate


@pytest.fixture
def work(monkeypatch: pytest.MonkeyPatch) -> dict[str, list[Any]]:
    """The texts that the encoder, the parser, the cross-encoder and the normal form have processed."""
    done: dict[str, list[Any]] = {"encoded": [], "parsed": [], "compared": [], "normalised": []}
    encode, read, score, normalised = Encoder._encode, Pipeline._read, Reranker.score_pairs, normal._normalised

    def note_encoded(encoder: Encoder, texts: Sequence[str]) -> Any:
        done["encoded"].append(list(texts))
        return encode(encoder, texts)

    def note_parsed(pipeline: Pipeline, orders: list[Any]) -> None:
        done["parsed"] += [order.normal.text for order in orders]
        read(pipeline, orders)

    def note_compared(reranker: Reranker, pairs: Sequence[tuple[str, str]]) -> Any:
        done["compared"] += pairs
        return score(reranker, pairs)

    def note_normalised(text: str, *more: Any) -> Any:
        done["normalised"].append((text, *more))
        return normalised(text, *more)

    monkeypatch.setattr(Encoder, "_encode", note_encoded)
    monkeypatch.setattr(Pipeline, "_read", note_parsed)
    monkeypatch.setattr(Reranker, "score_pairs", note_compared)
    monkeypatch.setattr(normal, "_normalised", note_normalised)
    return done


def test_an_utterance_is_encoded_parsed_and_normalised_once(tmp_path: Path, work: dict[str, list[Any]]) -> None:
    settings = {
        "ontology": {"path": tmp_path / "memory.lbug"},
        "genqa": {"index": tmp_path / "index.sqlite"},
        "wildtalk": {"backend": "listen"},
        "emotion": {"emoji": False},
    }
    parts = [getattr(modules, name) for name in COMPLETE]
    with simulate(*parts, settings=settings, seed=1) as agent:
        agent.say("what do you think of jazz?")  # this first utterance loads the models
        for done in work.values():
            done.clear()
        said = len(agent.said)
        agent.say("do you like chess?")
        assert len(agent.said) > said
    assert work["encoded"] == [["do you like chess"]]  # one call of the encoder for the matchers of all modules
    assert work["parsed"] == ["Do you like chess?"]
    assert work["compared"] == []  # a question about the agent needs no document
    assert len(work["normalised"]) == len(set(work["normalised"]))
