"""Corrections: *Leipzig, not Leeds*, *it's not Leeds, it's Leipzig*, *no, Leipzig*.

A fact has a *topic*, such as *home*, and *values*, such as *Ulm*.

The parse gives the wrong value and the right value. The wrong value tells which fact the user corrects: a known fact about
them or their relatives, no matter when it was mentioned. Without a wrong value, users correct the fact that was mentioned
last. If that fact does not suit the right value, they correct the only known fact that does.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from ravestate.modules import nlp

from .answers import without_opening
from .changes import is_partial, is_similar, may_correct, misheard
from .kinds import FITTING, kind_of, likeness
from .reading import Reader
from .talk import Talk
from .told import Told, retold_with
from .topics import NOW, TOPICS, WORDS, Fact
from .values import number_in, value_of
from .wording import among, mentioned, same

_SUBJECTS = frozenset(["it", "that", "this", "he", "she", "they", "i"])
_CONTENT = frozenset(["NOUN", "PROPN", "NUM", "ADJ", "VERB", "X"])
_PLAIN: dict[str, float] = {"place": 0.0, "number": 0.0, "organisation": 0.5, "work": 0.5}
"""Kind of value for which a bare value shows which fact is meant (*no, Leipzig*) → the `likeness` that the value must
exceed."""
_MEANING = frozenset(["meant", "mean", "said"])
_POINTING = frozenset(["that", "this", "these", "those"])


@dataclass(frozen=True, slots=True)
class Correction:
    """The facts and free statements that a correction adds, and the free statements that it removes (`gone`).

    A *free statement* belongs to no topic: *Jonas plays the violin*.
    """

    facts: tuple[Fact, ...] = ()
    free: tuple[Told, ...] = ()
    gone: tuple[Told, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.facts or self.gone)


def corrected_in(
    reader: Reader, text: str, talk: Talk, told: Sequence[Told], read: Collection[str], *, asked: bool
) -> Correction:
    """Return the correction in an utterance.

    Args:
        reader: The reader of the utterance, which finds the facts in it.
        text: The utterance, with its short forms written out.
        talk: The state of the conversation.
        told: The known free statements.
        read: The values that the utterance states as facts anyway: Leipzig, in *I live in Leipzig, not Leeds*.
        asked: Whether a question of the agent is open. If so, a correction must name the wrong value, or spell the
            right one.
    """
    seen, recent = reader.seen, talk.correctable
    if not recent or talk.age:  # a fact of the user's last utterance takes precedence over the agent's last words
        recent = mentioned(talk.spoken, reader.known) or recent
    latest = talk.latest if recent == talk.last else reader.known.get(recent, ())
    for wrong, right in _pairs(reader):
        if among(right, read):
            continue
        topics = [topic for topic, had in reader.known.items() if among(wrong, had) and _is_about(seen, topic, recent)]
        topic = recent if recent in topics else topics[0] if len(topics) == 1 else ""
        if topic and (value := value_of(right, TOPICS[topic], seen)):
            return Correction(_instead(topic, value, (wrong,)))
        if free := [(one, retold_with(one, right)) for one in told if _may_retell(seen, one, wrong)]:
            return Correction(free=tuple(new for _, new in free), gone=tuple(old for old, _ in free))
    rest = without_opening(text)
    if not seen.contrasts and rest and not asked and seen.question is None:
        topic = _opposed(reader, rest, recent, latest, answers=talk.spoken.rstrip().endswith("?"))
        for value in reader.values_in(rest, topic) if topic else ():
            return Correction(_instead(topic, value, latest if topic == recent else ()))
    if recent and may_correct(seen, recent) and (facts := misheard(text, recent, latest, seen)):
        return Correction(_instead(recent, facts[0].values[0], latest))
    return Correction()


def denied_in(said: Iterable[Told], told: Sequence[Told]) -> tuple[Told, ...]:
    """Return the free statements that an utterance denies: *Rosa doesn't play the violin*."""
    denied = {replace(one, verb=one.verb.removeprefix("not ")).key for one in said if one.verb.startswith("not ")}
    return tuple(one for one in told if one.key in denied)


def _instead(topic: str, value: str, wrong: Sequence[str]) -> tuple[Fact, ...]:
    gone = tuple(one for one in wrong if TOPICS[topic].many and not same(one, value))
    return (Fact(topic, (value,)), *([Fact(topic, gone, gone=True)] if gone else []))


def _pairs(reader: Reader) -> Iterator[tuple[str, str]]:
    """Yield pairs of wrong and right words, from contrasts and from two clauses (*it's not Leeds, it's Leipzig*)."""
    seen = reader.seen
    for one in seen.contrasts:
        yield one.wrong.text, one.right.text
    denied = ""
    for said in seen.statements:
        if (
            said.subject.text.lower() in _SUBJECTS
            and said.verb == "be"
            and not is_partial(reader, said)
            and said.object.text
            and not said.question
        ):
            if denied and not said.negated:
                yield denied, said.object.text
            denied = said.object.text if said.negated else ""


def _is_about(seen: nlp.Analysis, topic: str, recent: str) -> bool:
    """Return whether the words beside a contrast may be about the fact of this topic, and about nothing else."""
    pointing = any(said.subject.text.lower() in _POINTING for said in seen.statements)
    now = any(word.low in NOW for word in seen.tree.words)
    return may_correct(seen, topic) and not now and (topic == recent or not pointing)


def _may_retell(seen: nlp.Analysis, one: Told, wrong: str) -> bool:
    """Return whether a contrast may correct a free statement.

    Each clause of the utterance must have the subject of the free statement, or a pronoun as its subject.
    """
    if not same(one.object, wrong):
        return False
    about = {one.subject.lower(), one.who.lower(), *_SUBJECTS}
    return all(
        said.subject.text.lower() in about and (said.verb == one.verb or said.subject.text.lower() == "it")
        for said in seen.statements
    )


def _opposed(reader: Reader, rest: str, recent: str, latest: Sequence[str], *, answers: bool) -> str:
    """Return the topic that words such as *no, Leipzig* correct; empty if this is not clear.

    It is the topic mentioned last, or else the only known topic that the value suits. If the agent's last words were a
    question (`answers`), the user's words may answer it, so only the topic mentioned last counts.
    """
    seen, known = reader.seen, reader.known
    values = {topic: reader.values_in(rest, topic) for topic in {*known, recent} - {""}}
    if recent and may_correct(seen, recent) and any(_is_like(one, recent, latest) for one in values[recent]):
        return recent
    if answers or not (
        seen.yesno.no or "contradiction" in seen.acts or _MEANING & {word.low for word in seen.tree.words}
    ):
        return ""
    fitting = [
        topic
        for topic, had in known.items()
        if had and TOPICS[topic].kind in _PLAIN and may_correct(seen, topic)
        if any(
            _is_all(one, rest, seen) and _is_like(one, topic, least=_PLAIN[TOPICS[topic].kind]) for one in values[topic]
        )
    ]
    return fitting[0] if len(fitting) == 1 else ""


def _is_all(value: str, rest: str, seen: nlp.Analysis) -> bool:
    """Return whether the words `rest` are nothing but a value, perhaps with a verb such as *is* or *mean*."""
    words, low = {*value.lower().split(), *WORDS["speaking"]}, rest.lower()
    content = (word for word in seen.tree.words if word.pos in _CONTENT and word.low in low)
    return all({word.low, word.lemma} & words for word in content)


def _is_like(value: str, topic: str, latest: Sequence[str] = (), least: float = 0.0) -> bool:
    """Return whether a value suits the kind of a topic, or is spelled almost like one of the `latest` values."""
    kind = topic if topic in FITTING else TOPICS[topic].kind
    if kind == "number" or number_in(value):
        return kind == "number"
    free = kind in ("name", "people") or kind not in FITTING
    free = free or (
        kind == "activity" and value.islower() and kind_of(value) == "person"
    )  # a rare word, such as "ludo"
    return free or likeness(value, kind) > least or any(is_similar(value, one) for one in latest)
