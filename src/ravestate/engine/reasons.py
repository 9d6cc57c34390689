"""All reasons that traces and explanations give, with their wording (law L25).

The board's page uses this table, too.
"""

from __future__ import annotations

from enum import StrEnum
from typing import Any, Self


def reason(*parts: str) -> Any:
    """Return the value of a `Reason` member. Without this function, type checkers would take the member for a tuple."""
    return parts


class Reason(StrEnum):
    """A reason: one word for programs, and a phrase for people.

    Attributes:
        words: The phrase for people.
        tone: The colour of the phrase on the board: ``good``, ``busy``, ``bad`` or ``plain``.
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
        """Return the phrase for a value. For an unknown value from a newer release's trace, return the value itself."""
        try:
            return cls(value).words
        except ValueError:
            return value


class Outcome(Reason):
    """An outcome of a run (L18); the phrase completes a sentence that begins with the rule's name."""

    DONE = reason("done", "finished")
    RESIGNED = reason("resigned", "resigned")
    FAILED = reason("failed", "failed")
    RETIRED = reason("retired", "retired")
    INTERRUPTED = reason("interrupted", "was interrupted")
    WIPED = reason("wiped", "was stopped because its spike was wiped")


class StopReason(Reason):
    """A reason for which the engine asked a run to stop."""

    INTERRUPTED = reason("interrupted", "its until condition was met")
    TIMEOUT = reason("timeout", "its timeout ran out")
    WIPED = reason("wiped", "its spike was wiped")


class LossReason(Reason):
    """A reason for which an activation gave up a spike."""

    AGE = reason("age", "the spike was too old")
    CONSUMED = reason("consumed", "another rule answered it")
    RESIGNED = reason("resigned", "the rule resigned")
    ELIMINATED = reason("eliminated", "its patience ran out while others waited")
    WITHDRAWN = reason("withdrawn", "the spike was withdrawn")
    DOUBLED = reason("doubled", "another attempt of the rule holds it")
    RETIRED = reason("retired", "the rule retired")


class PassReason(Reason):
    """A reason for which a rule did not take a spike."""

    PAYLOAD = reason("payload", "its payload did not match the predicate")
    CONSUMED = reason("consumed", "another rule had answered its cause")
    CAUSED = reason("caused", "the rule itself was among its causes")


class DropReason(Reason):
    """A reason for which a spike was withdrawn (L20, L23)."""

    OVERFLOW = reason("overflow", "its signal had too many spikes")
    SUPERSEDED = reason("superseded", "a later spike replaced it")
    WIPED = reason("wiped", "it was wiped")


class Verdict(Reason):
    """The stage that a rule reached for an input; the furthest stage comes first."""

    FIRED = reason("fired", "It fired", "good")
    RUNNING = reason("running", "It is running", "busy")
    WAITING = reason("waiting", "It is ready and waiting", "busy")
    OUTRUN = reason("outrun", "It was ready, but another rule answered")
    FAILED = reason("failed", "It failed", "bad")
    RESIGNED = reason("resigned", "It resigned")
    GATED = reason("gated", "A slot predicate was false")
    YOUNG = reason("young", "A spike was too young")
    ELIMINATED = reason("eliminated", "Its patience ran out")
    WITHDRAWN = reason("withdrawn", "A spike was withdrawn")
    LACKED = reason("lacked", "It lacked a signal")
    PASSED = reason("passed", "It did not take the spike")
    UNTOUCHED = reason("untouched", "Nothing it hears occurred")
    RETIRED = reason("retired", "It had retired")
