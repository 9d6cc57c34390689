"""The state of the conversation about the user, and its transitions."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, fields, replace

FORGET = "forget"
"""The topic of the question whether the user really wants to be forgotten."""

CONFIRM = "confirm"
"""The topic of the question by which somebody who says a known name shows that they are that person."""

MORE = "more"
"""The topic of a question that asks for no fact: any words answer it."""

ENOUGH = 1_000
"""The number of tries after which the agent never asks about a topic again."""

TRIES = 2
"""The maximum number of questions about one topic in a conversation."""

CORRECTABLE = 2
"""The number of utterances during which "no, Bremen" corrects the last fact."""


@dataclass(frozen=True, slots=True)
class Question:
    """A question of the agent.

    Attributes:
        topic: Its topic.
        since: Seconds from the beginning of the context to the question.
        turns: The number of utterances since, without an answer.
        heard: Whether it has been said.
        spoken_over: Whether the agent has said something else since, unasked: a mere no may answer that.
    """

    topic: str
    since: float
    turns: int = 0
    heard: bool = False
    spoken_over: bool = False

    @property
    def fresh(self) -> bool:
        """Whether neither side has spoken since."""
        return not self.turns and not self.spoken_over


@dataclass(frozen=True, slots=True)
class Talk:
    """The state of the conversation.

    Attributes:
        question: The open question.
        tries: The number of questions about each topic.
        closed: Topics that this conversation does not ask about any more.
        ignored: The number of unanswered questions in a row.
        told: Topics that the user told about in this conversation.
        last: The topic that was learnt or mentioned last.
        latest: Its values.
        age: The number of utterances since then.
        met: Whether memory was asked about the user.
        remembered: The facts that memory had.
        once: All values of this conversation, also those that no longer hold.
        newcomer: Whether memory did not know the user.
        reminded: Whether the agent has shown that it remembers.
        trouble: The last failure of memory; empty while it works.
        warned: Whether the user knows about the trouble.
        quiet: Whether the user has said goodbye.
        doubt: The topic that the user must confirm before the agent takes them for the person of their name.
        wants_out: Whether they asked to be forgotten before the agent knew who they are.
        formal: Whether the last question asked for a fact, and nothing personal was said since.
        spoke: Seconds from the beginning of the context to the user's last words.
        picked_up: The keys of free statements to which the agent came back.
    """

    question: Question | None = None
    tries: Mapping[str, int] = field(default_factory=dict[str, int])
    closed: frozenset[str] = frozenset()
    ignored: int = 0
    told: frozenset[str] = frozenset()
    last: str = ""
    latest: tuple[str, ...] = ()
    age: int = 0
    met: bool = False
    remembered: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    once: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    newcomer: bool = False
    reminded: bool = False
    trouble: str = ""
    warned: bool = False
    quiet: bool = False
    doubt: str = ""
    wants_out: bool = False
    formal: bool = False
    spoke: float = 0.0
    picked_up: frozenset[str] = frozenset()

    def asking(self, topic: str, now: float) -> Talk:
        """Ask about `topic`."""
        return replace(
            self,
            formal=topic != MORE,
            question=Question(topic, now),
            tries={**self.tries, topic: self.tries.get(topic, 0) + 1},
        )

    def pending(self, now: float, within: float) -> Question | None:
        """Return the question that the user may answer now; None if it is too old or the user ignored it."""
        question = self.question
        if question is None or question.turns > 1 or now - question.since > within:
            return None
        return question

    def listening(self, now: float, *, leave: bool) -> Talk:
        """Count an utterance of the user; `leave` means a goodbye."""
        question = self.question
        return replace(
            self,
            question=None if question is None or leave else replace(question, turns=question.turns + 1),
            ignored=0,
            age=self.age + 1,
            quiet=leave,
            spoke=now,
        )

    def speaking(self) -> Talk:
        """Count an utterance of the agent: its question, an answer to the user, or something else."""
        question = self.question
        if question is None or question.spoken_over:
            return self
        if not question.heard:
            return replace(self, question=replace(question, heard=True))
        return self if question.turns else replace(self, question=replace(question, spoken_over=True))

    def waiting(self) -> Talk:
        """Give up the question; the user has not answered it."""
        return replace(self, question=None, ignored=self.ignored + 1)

    def closing(self, *topics: str) -> Talk:
        """Close topics for this conversation."""
        return replace(self, question=None, closed=self.closed | set(topics))

    def learning(self, topics: Collection[str], last: str, latest: tuple[str, ...]) -> Talk:
        """Note that the user told about `topics`; a correction would concern the `latest` values of `last`."""
        answered = self.question is not None and self.question.topic in topics
        return replace(
            self,
            question=None if answered else self.question,
            told=self.told | set(topics),
            last=last,
            latest=latest,
            age=0,
        )

    def striking(self, gone: Mapping[str, tuple[str, ...]]) -> Talk:
        """Remove values by topic, and ask for no others."""
        remembered = {
            topic: tuple(value for value in values if value not in gone.get(topic, ()))
            for topic, values in self.remembered.items()
        }
        once = {topic: (*self.once.get(topic, ()), *values) for topic, values in gone.items()}
        tries = dict.fromkeys(gone, ENOUGH)
        talk = self.learning(gone.keys(), "", ())
        return replace(talk, remembered=remembered, once={**self.once, **once}, tries={**self.tries, **tries})

    def mentioning(self, topic: str, values: tuple[str, ...]) -> Talk:
        """Note that the agent states a topic, which the user may correct."""
        return replace(self, last=topic, latest=values, age=0)

    def rebased(self, base: Talk, after: Talk) -> Talk:
        """Return this state with the changes from `base` to `after`, except where it has changed since `base`."""
        names = [one.name for one in fields(Talk)]
        changed = [name for name in names if getattr(self, name) == getattr(base, name)]
        return replace(self, **{name: getattr(after, name) for name in changed})

    @property
    def correctable(self) -> str:
        """The topic that "no, Bremen" would correct; empty if there is none."""
        return self.last if self.age <= CORRECTABLE else ""
