"""How the talk about the user stands. Values, and how they follow from one another."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, fields, replace

__all__ = ["FORGET", "TRIES", "Question", "Talk"]

FORGET = "forget"
"""What is asked about when the user wants to be forgotten; no topic."""

ENOUGH = 1_000
"""Whoever was asked so often is not asked again."""

TRIES = 2
"""So often a topic is brought up in one talk at most."""

CORRECTABLE = 2
"""So many utterances long "no, Bremen" means what was learnt last."""


@dataclass(frozen=True, slots=True)
class Question:
    """What the agent has asked.

    Attributes:
        topic: What about.
        since: When, in seconds since the context began.
        turns: How often the user has spoken since without answering it.
        heard: Whether it has been said.
        spoken_over: Whether the agent has said something else since, unasked: a mere no may be meant for that.
    """

    topic: str
    since: float
    turns: int = 0
    heard: bool = False
    spoken_over: bool = False

    @property
    def fresh(self) -> bool:
        """Whether nobody has said anything since."""
        return not self.turns and not self.spoken_over


@dataclass(frozen=True, slots=True)
class Talk:
    """How the talk stands.

    Attributes:
        question: What was asked and is not answered yet.
        tries: How often each topic was asked.
        closed: Topics that are not asked in this talk any more.
        ignored: How many questions in a row the user has left without a word.
        told: Topics that the user has told about in this talk.
        last: The topic that was learnt, or mentioned, last.
        latest: What was said about it.
        age: How often the user has spoken since.
        met: Whether memory was asked about the user.
        remembered: What it had of him then.
        once: What he has told in this talk, whether it still counts or not.
        newcomer: Whether it had never heard of him.
        reminded: Whether the user knows that he is remembered.
        trouble: Why memory failed last; empty while it works.
        warned: Whether the user was told so.
        quiet: Whether the user has taken leave.
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

    def asking(self, topic: str, now: float) -> Talk:
        """The agent asks about `topic`."""
        return replace(
            self,
            question=Question(topic, now),
            tries={**self.tries, topic: self.tries.get(topic, 0) + 1},
        )

    def pending(self, now: float, within: float) -> Question | None:
        """The question that words of now may answer: it is not too old, and the user has not left it behind."""
        question = self.question
        if question is None or question.turns > 1 or now - question.since > within:
            return None
        return question

    def listening(self, *, leave: bool) -> Talk:
        """The user speaks; `leave`: he says goodbye."""
        question = self.question
        return replace(
            self,
            question=None if question is None or leave else replace(question, turns=question.turns + 1),
            ignored=0,
            age=self.age + 1,
            quiet=leave,
        )

    def speaking(self) -> Talk:
        """The agent says something: the question itself, an answer to the user, or something else."""
        question = self.question
        if question is None or question.spoken_over:
            return self
        if not question.heard:
            return replace(self, question=replace(question, heard=True))
        return self if question.turns else replace(self, question=replace(question, spoken_over=True))

    def waiting(self) -> Talk:
        """The question was left without a word."""
        return replace(self, question=None, ignored=self.ignored + 1)

    def closing(self, *topics: str) -> Talk:
        """These topics are not asked any more."""
        return replace(self, question=None, closed=self.closed | set(topics))

    def learning(self, topics: Collection[str], last: str, latest: tuple[str, ...]) -> Talk:
        """The user has told about `topics`; what matters most of it are the `latest` values about the `last` one."""
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
        """These values, by topic, are to be forgotten; nobody asks for others."""
        remembered = {
            topic: tuple(value for value in values if value not in gone.get(topic, ()))
            for topic, values in self.remembered.items()
        }
        once = {topic: (*self.once.get(topic, ()), *values) for topic, values in gone.items()}
        tries = dict.fromkeys(gone, ENOUGH)
        talk = self.learning(gone.keys(), "", ())
        return replace(talk, remembered=remembered, once={**self.once, **once}, tries={**self.tries, **tries})

    def mentioning(self, topic: str, values: tuple[str, ...]) -> Talk:
        """The agent says what it knows about a topic, which the user may put right."""
        return replace(self, last=topic, latest=values, age=0)

    def rebased(self, base: Talk, after: Talk) -> Talk:
        """The talk as it is now, with what has changed from `base` to `after`; not where it has gone on since `base`."""
        names = [one.name for one in fields(Talk)]
        changed = [name for name in names if getattr(self, name) == getattr(base, name)]
        return replace(self, **{name: getattr(after, name) for name in changed})

    @property
    def correctable(self) -> str:
        """The topic that "no, Bremen" would correct; empty if there is none."""
        return self.last if self.age <= CORRECTABLE else ""
