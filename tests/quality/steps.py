"""Measure single steps of understanding: the normal form, sums, follow-ups, moves of a game, and the like.

For each set, a function of the same name takes a sentence, and returns its label. A sentence can begin with its situation
in brackets: ``[asked] yes``. The modules were developed with these sentences, so the sets only show that a module gets no
worse. The tests of each module prove the laws that hold for all sentences.
"""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from datetime import date, time
from typing import Any, cast

from quality import measure
from quality.modules import analysed, prepare
from quality.skills import listener, load
from ravestate.language.addressing import addressed
from ravestate.language.lexicon import load_lexicon
from ravestate.language.network import network
from ravestate.language.nonsense import is_nonsense
from ravestate.language.normal import normalise
from ravestate.modules.meta.nlp.introduction import introductions_in
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.modality.visionio.wishes import wish_of
from ravestate.modules.skill.charades import understanding as charades
from ravestate.modules.skill.charades.game import moves_of
from ravestate.modules.skill.genqa.answering import Answer
from ravestate.modules.skill.genqa.question import parse
from ravestate.modules.skill.genqa.reckoning import reckon, scaled
from ravestate.modules.skill.genqa.thread import readings, turn_of
from ravestate.modules.skill.persqa.reading import Reader
from ravestate.modules.skill.persqa.told import Told, recalled, told_in
from ravestate.modules.skill.wildtalk.gate import Gate
from ravestate.modules.skill.wildtalk.listening import Heard
from ravestate.modules.skill.wildtalk.listening.hearing import hear
from ravestate.modules.skill.wildtalk.listening.material import material
from ravestate.modules.skill.wildtalk.listening.repair import repair_in
from ravestate.modules.skill.wildtalk.listening.state import State
from ravestate.modules.skill.wildtalk.listening.tongue import tongue_of

_SITUATION = re.compile(r"(?:\[([^\]]*)\] )?(.*)")
_TODAY = date(2026, 6, 1)
_KNOWN = {"home": ("Hannover",), "name": ("Marlene",), "sister": ("Rosa",), "age": ("33",)}
"""The facts about the user in memory, for `refused_rows`."""


def _parts(sentence: str) -> tuple[str, str]:
    """Return the situation of a sentence (empty if there is none), and the sentence without it."""
    found = _SITUATION.fullmatch(sentence)
    assert found is not None
    return found[1] or "", found[2]


def written_rows(sentence: str) -> str:
    """Return the normal form of a typed sentence."""
    assert load_lexicon() is not None
    return normalise(sentence).text


def addressed_rows(sentence: str) -> str:
    """Return a sentence in which *you* stands for the agent's name, Robin."""
    return addressed(sentence, ["Robin"])


def closing_rows(sentence: str) -> str:
    """Return ``kind: question``: the kind of the first words of an utterance, and the question at its end."""
    found = analysed(sentence).closing
    if found is None:
        return measure.NONE
    return f"{'returned' if found.returned else 'remark' if found.remarks else 'told'}: {found.text}"


def introductions_rows(sentence: str) -> str:
    """Return the name that the user gives. If the name is sure, also return the rest of the utterance."""
    seen = analysed(sentence)
    if (found := seen.introduction) is not None:
        return f"{found.name} / {found.rest}"
    return next((found.name for found in introductions_in(seen.tree)), measure.NONE)


def sums_rows(sentence: str) -> str:
    """Return the result of a sum. Its situation is the time of day (``at 14:50``), or the last answers."""
    situation, text = _parts(sentence)
    now = time.fromisoformat(situation.removeprefix("at ")) if situation.startswith("at ") else None
    told = [] if now else [one for one in situation.split(" | ") if one]
    return reckon(text, told, _TODAY, now=now) or scaled(text) or measure.NONE


def readings_rows(sentence: str) -> list[str]:
    """Return all readings of a follow-up. Its situation has the earlier questions: ``question = answer = title``."""
    situation, text = _parts(sentence)
    said = [one.split(" = ") for one in situation.split(" | ")]
    turns = [turn_of(parse(question), Answer(question, answer, "s", title), 0.0) for question, answer, title in said]
    return [reading.text for reading in readings(parse(text), turns)]


def recalled_rows(sentence: str) -> str:
    """Return the statements that answer a question of the user. Its situation has the user's earlier sentences."""
    situation, text = _parts(sentence)
    said: list[Told] = []
    for one in situation.split(" | "):
        said += told_in(Reader(analysed(one)), said)[1]
    return " | ".join(one.text for one in recalled(Reader(analysed(text)), said, {})) or measure.NONE


def charades_rows(sentence: str) -> str:
    """Return the move that an utterance makes in the game of charades. Its situation is the step of the game."""
    step, text = _parts(sentence)
    move = charades.understand(analysed(text), moves_of(cast("Any", step)))
    return measure.NONE if move is None else f"{move.kind} {move.name}".strip()


def repairs_rows(sentence: str) -> str:
    """Return how a user objects to the agent's last answer. The situation is the user's utterance and this answer."""
    situation, text = _parts(sentence)
    before, said = situation.split(" | ")
    found = repair_in(analysed(text), State(said=(said,), before=before))
    return measure.NONE if found is None else f"{found.kind}: {found.again.lower().rstrip('.')}".rstrip(": ")


def refused_rows(sentence: str) -> str:
    """Return why the agent must not say a sentence of a model. Its situation is the user's utterance."""
    situation, text = _parts(sentence)
    return Gate("Ravestate", situation, known=_KNOWN, pipeline=pipeline("")).refuse(text) or measure.NONE


def answer_tones_rows(sentence: str) -> str:
    """Return the tone of the listener's answer to an utterance at the beginning of a conversation."""
    return listener().answer(Heard(sentence, analysed(sentence)), State(), random.Random(0)).state.tone or measure.NONE


def asked_rows(sentence: str) -> str:
    """Return the kind of a question that asks for no fact, and the area of life that it is about."""
    asked = hear(material(), Heard(sentence, analysed(sentence)), State()).asked
    parts = () if asked is None else (asked.kind, asked.area.name if asked.area else "")
    return " / ".join(filter(None, parts)) or measure.NONE


def tongues_rows(sentence: str) -> str:
    """Return the language of an utterance that is not English, or ``nonsense``."""
    return tongue_of(sentence, material().tongues) or ("nonsense" if is_nonsense(sentence) else measure.NONE)


def performances_rows(sentence: str) -> str:
    """Return the performance that an utterance asks for: ``joke``, ``song``, ``story`` or ``game``."""
    wish = listener().wish(Heard(sentence, analysed(sentence)), State())
    if wish is None:
        return measure.NONE
    return wish.kind if wish.kind in ("joke", "song", "story") else "game"


def wishes_rows(sentence: str) -> str:
    """Return whether the user wants the agent to remember or forget their face."""
    return wish_of(sentence) or measure.NONE


SETS: dict[str, Callable[[str], str | list[str]]] = {
    function.__name__: function
    for function in (
        written_rows, addressed_rows, closing_rows, introductions_rows, sums_rows, readings_rows, recalled_rows, charades_rows,
        repairs_rows, refused_rows, answer_tones_rows, asked_rows, tongues_rows, wishes_rows, performances_rows,
    )
}  # fmt: skip
FLOORS = {name: 1 - max(0.05, 1.01 / len(measure.labelled(name))) for name in SETS} | {
    "answer_tones_rows": 0.8,
    "performances_rows": 0.94,
}
"""The minimum share of right labels: one sentence, or 5 %, may be wrong. Tones are a matter of opinion, and people ask for
performances in many ways."""
UNASKED = 0.01
"""The maximum share of utterances in `performances_rows` that ask for no performance, but get one."""


def result(name: str) -> measure.Result:
    """Measure the set `name`. If a step has several results, one of them must be the label."""
    load()
    charades.load()
    network().load()
    cases = measure.labelled(name)
    labels = dict(cases)
    prepare(_parts(text)[1] for text, _ in cases)

    def see(text: str) -> str:
        found = SETS[name](text)
        if isinstance(found, str):
            return found
        return labels[text] if labels[text] in found else " | ".join(found)

    return measure.measure_labels(name, see, cases)


def results() -> list[measure.Result]:
    """Measure every set of this file."""
    return [result(name) for name in SETS]
