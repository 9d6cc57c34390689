"""Every reason that a trace or an explanation gives, with its wording (L25). The board's page is built from this table."""

from __future__ import annotations

from enum import StrEnum
from typing import Self

__all__ = ["DropReason", "LossReason", "Outcome", "PassReason", "Reason", "StopReason", "Verdict"]


class Reason(StrEnum):
    """A reason: one word for programs, and a phrase for people.

    Attributes:
        words: The phrase.
        tone: How the board colours it: ``good``, ``busy``, ``bad`` or ``plain``.

    Example:
        >>> LossReason.say("age")
        'the spike was too old'
    """

    words: str
    tone: str

    def __new__(cls, value: str, words: str, tone: str = "plain") -> Self:
        """Create a member from its value, phrase and tone."""
        self = str.__new__(cls, value)
        self._value_, self.words, self.tone = value, words, tone
        return self

    @classmethod
    def say(cls, value: str) -> str:
        """Return the phrase for a value. A value from a newer release's trace stands for itself."""
        try:
            return cls(value).words
        except ValueError:
            return value


class Outcome(Reason):
    """How a run ended (L18): the predicate of a sentence about its rule."""

    DONE = "done", "finished"
    RESIGNED = "resigned", "resigned"
    FAILED = "failed", "failed"
    RETIRED = "retired", "retired"
    INTERRUPTED = "interrupted", "was interrupted"
    WIPED = "wiped", "was stopped because its spike was wiped"


class StopReason(Reason):
    """Why the engine asked a run to stop."""

    INTERRUPTED = "interrupted", "its until condition was met"
    TIMEOUT = "timeout", "its timeout ran out"
    WIPED = "wiped", "its spike was wiped"


class LossReason(Reason):
    """Why an activation gave up a spike."""

    AGE = "age", "the spike was too old"
    CONSUMED = "consumed", "another rule answered it"
    RESIGNED = "resigned", "the rule resigned"
    ELIMINATED = "eliminated", "its patience ran out while others waited"
    WITHDRAWN = "withdrawn", "the spike was withdrawn"
    RETIRED = "retired", "the rule retired"


class PassReason(Reason):
    """Why a rule did not take a spike."""

    PAYLOAD = "payload", "its payload did not match the predicate"
    CONSUMED = "consumed", "another rule had answered its cause"
    CAUSED = "caused", "the rule itself was among its causes"


class DropReason(Reason):
    """Why a spike was withdrawn (L20, L23)."""

    OVERFLOW = "overflow", "its signal had too many spikes"
    SUPERSEDED = "superseded", "a later spike replaced it"
    WIPED = "wiped", "it was wiped"


class Verdict(Reason):
    """How far a rule came for an input, from the furthest to the least far."""

    FIRED = "fired", "It fired", "good"
    RUNNING = "running", "It is running", "busy"
    WAITING = "waiting", "It is ready and waiting", "busy"
    OUTRUN = "outrun", "It was ready, but another rule answered"
    FAILED = "failed", "It failed", "bad"
    RESIGNED = "resigned", "It resigned"
    GATED = "gated", "A slot predicate was false"
    YOUNG = "young", "A spike was too young"
    ELIMINATED = "eliminated", "Its patience ran out"
    WITHDRAWN = "withdrawn", "A spike was withdrawn"
    LACKED = "lacked", "It lacked a signal"
    PASSED = "passed", "It did not take the spike"
    UNTOUCHED = "untouched", "Nothing it hears occurred"
    RETIRED = "retired", "It had retired"
