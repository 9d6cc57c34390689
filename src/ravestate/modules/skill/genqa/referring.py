"""Questions that refer to the previous one: *and its capital?*, *and of Spain?*."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from ravestate.modules._text import printable

LONGEST = 200
"""Characters of a question that may refer to another."""


@dataclass(frozen=True, slots=True)
class Before:
    """The previous question, in a form that can be understood alone."""

    question: str
    title: str
    """The title of the document with the answer."""
    at: float
    """Its time, in seconds since the context began."""

    @property
    def subject(self) -> str:
        """Its subject, in its own words; empty if that cannot be found."""
        named = re.search(rf"\b(?:the )?{re.escape(self.title)}\b", self.question, re.IGNORECASE)
        if named is not None and self.title:
            return named[0]
        last = re.search(r"\b(?:of|in|for|from) ((?:the )?[\w' -]+)$", self.question)
        return last[1] if last else ""


def completed(heard: str, before: Before | None) -> str | None:
    """Return the question with the reference written out; None if there is no question that it may refer to.

    Example:
        >>> before = Before("what is the population of Austria?", "Austria", 0.0)
        >>> completed("And its capital?", before), completed("And of Spain?", before)
        ("Austria's capital", 'what is the population of Spain')
        >>> completed("And its capital?", None) is None
        True
    """
    if len(heard) > LONGEST:
        return heard
    sentences = re.split(r"(?<=[.!?])\s+", " ".join(printable(heard).replace("’", "'").split()))
    asked = sentences[-1].rstrip(" ?!.")
    subject = before.subject if before else ""
    rest = _LEAD.sub("", asked, count=1)
    if _ITS.match(rest) or _THERE.search(rest):
        return _written_out(rest, subject) if subject else None
    if (rest == asked and not _OF.fullmatch(asked)) or _ASKS.match(rest):
        return heard
    new = _SUBJECT.fullmatch(rest)
    if new is None:
        return None
    if before is None or not subject:
        return None
    if new["of"] is None and rest.lower().startswith("the ") and rest[4:5].islower():
        return f"{rest} of {subject}"
    return re.sub(
        rf"\b{re.escape(subject)}\b", lambda _: new["it"], before.question.rstrip(" ?!."), flags=re.IGNORECASE
    )


def other_wordings(question: str) -> Iterator[str]:
    """Yield questions whose answer decides a yes-or-no question.

    Example:
        >>> list(other_wordings("Is Paris the capital of Germany?"))
        ['what is the capital of Germany']
    """
    question = question.strip(" ?!.")
    for pattern, instead in _YES_NO:
        if (found := pattern.fullmatch(question)) is not None:
            yield found.expand(instead)


def _written_out(text: str, subject: str) -> str:
    text = _ITS.sub(lambda found: f"{found['before']}{subject}'s", text)
    return _THERE.sub(f"in {subject}", text)


_LEAD = re.compile(
    r"^(?:(?:ok|okay|thanks|thank you|so|well|oh)\W+)*(?:(?:and|or|but)(?: (?:what|how) about)?|what about|how about)\s+",
    re.IGNORECASE,
)
_OF = re.compile(r"(?:of|in|for|from) [\w' -]+$", re.IGNORECASE)
_SUBJECT = re.compile(
    r"(?P<of>(?:of|in|for|from|with) )?(?P<it>(?!(?:an?|me|you|us|my|your|our|this|that|if|when|with|not|now)\b)[\w'-]+(?: [\w'-]+){0,3})",
    re.IGNORECASE,
)
_ASKS = re.compile(
    r"(?:who|whom|whose|what|which|where|when|why|how|is|are|was|were|do|does|did|can|could|has|have|will|would|should)\b",
    re.IGNORECASE,
)
_THERE = re.compile(
    r"(?<!\bis )(?<!\bare )(?<!\bwas )(?<!\bwere )\bthere\b(?! (?:is|are|was|were|be|a|an|any|really)\b)",
    re.IGNORECASE,
)
# A noun before the pronoun takes it: "how do plants make their food" needs no other question.
_ITS = re.compile(
    r"^(?P<before>(?:(?:what|who|where|when|how|which|and|is|are|was|were|does|do|did|can|much|many|big|large|old|long|"
    r"high|'s|what's|who's|where's|about|tell|me) )*)(?:its|their|the country's)\b",
    re.IGNORECASE,
)
_YES_NO = (
    (
        re.compile(r"(?:is|was|isn't|wasn't) [\w' .-]+? (the [\w' -]+ of [\w' .-]+)", re.IGNORECASE),
        r"what is \1",
    ),
    (
        re.compile(r"(?:is|isn't) ([\w' .-]+?) (?:situated |located )?in (?:the )?[\w' .-]+", re.IGNORECASE),
        r"where is \1",
    ),
)
