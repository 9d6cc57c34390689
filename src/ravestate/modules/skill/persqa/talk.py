"""The state of the conversation about the user, and its transitions.

A fact has a *topic*, such as *home*, and *values*, such as *Ulm*.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

from .told import Told

FORGET = "forget"
"""The topic of the question whether the agent should really forget the user."""

CONFIRM = "confirm"
"""The topic of the question that tests whether the user is the person of the same name in memory."""

ENOUGH = 1_000
"""A number of tries that is so great that the agent never asks about the topic again."""

TRIES = 2
"""The maximum number of questions about one topic in a conversation."""

LONGEST = 100
"""The maximum number of the user's statements, and of the user's sentences, that a conversation remembers."""

CORRECTABLE = 2
"""The maximum number of utterances between a fact and its correction in a few words: "no, Bremen"."""


@dataclass(frozen=True, slots=True)
class Question:
    """A question of the agent."""

    topic: str
    since: float
    """Seconds from the beginning of the context to the question."""
    turns: int = 0
    """The number of the user's utterances since the question, none of which answered it."""
    heard: bool = False
    """Whether the agent has said the question."""
    spoken_over: bool = False
    """Whether the agent has said something else since the question. If so, a mere "no" may not answer the question."""

    @property
    def fresh(self) -> bool:
        """Whether neither the user nor the agent has spoken since the question."""
        return not self.turns and not self.spoken_over


@dataclass(frozen=True, slots=True)
class Talk:
    """The state of the conversation."""

    question: Question | None = None
    tries: Mapping[str, int] = field(default_factory=dict[str, int])
    closed: frozenset[str] = frozenset()
    """Topics that this conversation does not ask about any more."""
    ignored: int = 0
    """The number of unanswered questions in a row."""
    told: frozenset[str] = frozenset()
    """Topics about which the user told something in this conversation."""
    last: str = ""
    """The topic that the agent has learnt or mentioned most recently."""
    latest: tuple[str, ...] = ()
    """The values of the topic `last`. The user may correct them in a few words: "no, Bremen"."""
    age: int = 0
    """The number of utterances since the agent learnt or mentioned `last`."""
    met: bool = False
    """Whether the agent has asked memory about the user."""
    remembered: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    once: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    """All values that this conversation saved or removed, including values that no longer hold."""
    returns: bool = False
    """Whether the user has talked to the agent before, as far as memory knows."""
    newcomer: bool = False
    """Whether the user was new to memory."""
    reminded: bool = False
    """Whether the agent has mentioned that it remembers the user."""
    trouble: str = ""
    """The last failure of memory; empty while memory works."""
    warned: bool = False
    """Whether the agent has told the user about the trouble."""
    quiet: bool = False
    """Whether the user has said goodbye or left, and has said nothing since."""
    parted: bool = False
    """Whether the user has said goodbye at any time. Another name then belongs to another person."""
    doubt: str = ""
    """A topic about which the user must first answer a question, to prove who they are; empty if there is no doubt."""
    wants_out: bool = False
    """Whether the user asked to be forgotten before the agent knew who they are."""
    asked: float | None = None
    """Seconds from the beginning of the context to the last question that the agent asked in a silence."""
    touched: frozenset[str] = frozenset()
    """Topics for which the user has used typical words, such as *office* for the occupation."""
    person: str = ""
    """The topic of the relative whom the user mentioned last."""
    spoken: str = ""
    """The agent's last words. The user may correct a fact in these words: "no, Bremen"."""
    spoke: float = 0.0
    """Seconds from the beginning of the context to the user's last words."""

    said: tuple[Told, ...] = ()
    """The user's last statements of any kind, oldest first."""
    words: tuple[str, ...] = ()
    """The user's last sentences, as they were written, oldest first; without questions."""
    turns: int = 0
    moved: bool = False
    """Whether the user's last utterance shows a feeling or is a joke."""
    busy: bool = False
    """Whether the user's last utterance asks something, or tells at some length something that persqa does not note."""

    @property
    def asked_before(self) -> bool:
        """Whether the agent has asked for something in this conversation."""
        return bool(self.tries)

    def asking(self, topic: str, now: float) -> Talk:
        """Ask about `topic`."""
        tries = {**self.tries, topic: self.tries.get(topic, 0) + 1}
        return replace(self, question=Question(topic, now), tries=tries)

    def pending(self, now: float, within: float) -> Question | None:
        """Return the question that the user may answer now; None if it is too old or the user ignored it."""
        question = self.question
        return question if question and question.turns <= 1 and now - question.since <= within else None

    def listening(self, now: float, *, leave: bool = False, person: str = "", **noted: Any) -> Talk:
        """Count an utterance of the user. `leave`: whether it says goodbye; `noted`: the new values of other fields."""
        question = replace(self.question, turns=self.question.turns + 1) if self.question and not leave else None
        counts = {"ignored": 0, "age": self.age + 1, "turns": self.turns + 1, "quiet": leave, "spoke": now}
        counts |= {"parted": self.parted or leave}
        return replace(self, question=question, person=person or self.person, **counts, **noted)

    def speaking(self, words: str = "") -> Talk:
        """Note the agent's words. The first words after `asking` are the question itself; later words are something else."""
        question = self.question
        if question is not None and not (question.heard and question.turns):
            question = replace(question, heard=True, spoken_over=question.heard)
        return replace(self, question=question, spoken=words)

    def waiting(self) -> Talk:
        """Give up the open question, because the user has not answered it."""
        return replace(self, question=None, ignored=self.ignored + 1)

    def closing(self, *topics: str) -> Talk:
        """Close topics for this conversation, and give up the open question."""
        return replace(self, question=None, closed=self.closed | set(topics))

    def learning(self, topics: Collection[str], last: str, latest: tuple[str, ...]) -> Talk:
        """Note the topics that the user told about. The user may correct `latest`, the values of the topic `last`."""
        answered = self.question is not None and self.question.topic in topics
        told = replace(self, question=None if answered else self.question, told=self.told | set(topics))
        return told.mentioning(last, latest)

    def striking(self, gone: Mapping[str, tuple[str, ...]]) -> Talk:
        """Remove the values in `gone`, and do not ask about their topics again."""
        remembered = {
            topic: tuple(value for value in values if value not in gone.get(topic, ()))
            for topic, values in self.remembered.items()
        }
        talk = replace(self, remembered=remembered, tries={**self.tries, **dict.fromkeys(gone, ENOUGH)})
        return talk.keeping(gone).learning(gone.keys(), "", ())

    def keeping(self, values: Mapping[str, tuple[str, ...]]) -> Talk:
        """Note values that this conversation saves or removes, even if memory has not finished yet."""
        return replace(
            self, once={**self.once, **{topic: self.once.get(topic, ()) + values[topic] for topic in values}}
        )

    @property
    def ever(self) -> Mapping[str, tuple[str, ...]]:
        """All values that memory had before this conversation, and all values that this conversation saved or removed."""
        topics = {**self.remembered, **self.once}
        return {topic: self.remembered.get(topic, ()) + self.once.get(topic, ()) for topic in topics}

    def mentioning(self, topic: str, values: tuple[str, ...]) -> Talk:
        """Note that the agent states the values of a topic, so that the user may correct them."""
        return replace(self, last=topic, latest=values, age=0)

    def rebased(self, base: Talk, after: Talk) -> Talk:
        """Return this state with the changes from `base` to `after`. Fields that already differ from `base` stay."""
        mine, old, new = ({one.name: getattr(talk, one.name) for one in fields(Talk)} for talk in (self, base, after))
        return Talk(**unless_changed(mine, old, new))

    @property
    def correctable(self) -> str:
        """The topic that a correction such as "no, Bremen" is about; empty if there is none."""
        return self.last if self.age <= CORRECTABLE else ""


def unless_changed(mine: Mapping[str, Any], base: Mapping[str, Any], after: Mapping[str, Any]) -> dict[str, Any]:
    """Return `mine` with the changes from `base` to `after`. Entries of `mine` that already differ from `base` stay."""
    kept = {key: value for key, value in mine.items() if value != base.get(key)}
    return {**{key: value for key, value in after.items() if mine.get(key) == base.get(key)}, **kept}
