"""Measure whole conversations: how often the last answer of the complete agent fits.

Each row of talks_rows.tsv has a cause, a few utterances of the user, and a regular expression for the last answer. If
the expression begins with ``!``, the answer must not match the rest.
"""

from __future__ import annotations

import re
from pathlib import Path

from end_to_end.conversation import Conversation
from quality import measure
from ravestate.modules.skill.wildtalk.small_talk import learn_all

FLOORS = {
    "show": 0.85,
    "repair": 0.75,
    "offence": 0.9,
    "self": 0.8,
    "news": 0.85,
    "bye": 0.9,
    "advice": 0.9,
    "closing": 0.8,
    "persons": 0.9,
}
"""The minimum share of fitting answers for each cause."""


def rows(cause: str) -> list[tuple[list[str], str]]:
    """Return the conversations of a cause, each with the expression for its last answer."""
    lines = (measure.HERE / "talks_rows.tsv").read_text(encoding="utf-8").splitlines()
    found = [line.split("\t") for line in lines if line and not line.startswith("#")]
    return [(talk.split(" | "), wanted) for name, talk, wanted in found if name == cause]


def measured(cause: str, folder: Path) -> measure.Result:
    """Return the share of conversations whose last answer fits."""
    learn_all()
    cases, misses = rows(cause), list[str]()
    for place, (talk, wanted) in enumerate(cases):
        answer = last_answer(talk, folder / str(place))
        found = re.search(wanted.removeprefix("!"), answer) is not None
        if not answer or found == wanted.startswith("!"):
            misses.append(f"{' | '.join(talk)} -> {answer}")
    return measure.Result(cause, len(cases), {"right": 1 - len(misses) / len(cases)}, misses)


def last_answer(talk: list[str], folder: Path) -> str:
    """Return the agent's answer to the last utterance of a conversation."""
    folder.mkdir(parents=True)
    settings = {"wildtalk": {"backend": "listen"}, "idle": {"bored_after": 500.0}}
    with Conversation(folder, settings, without=("fillers", "emotion")) as conversation:
        said = [conversation.say(line, 3.0) for line in talk]
    return " ".join(line.text for line in said[-1])


if __name__ == "__main__":
    import tempfile

    for name in FLOORS:
        result = measured(name, Path(tempfile.mkdtemp()))
        print(name, f"{result.shares['right']:.0%} of {result.cases}", *result.misses, sep="\n  ")
