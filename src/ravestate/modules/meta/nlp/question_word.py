"""The kinds of questions."""

from __future__ import annotations

from enum import Enum


class QuestionWord(Enum):
    """The kinds of questions. In a `Triple` it is the unknown."""

    PERSON = "person"
    """who, whom, whose"""
    PLACE = "place"
    """where"""
    OBJECT = "object"
    """what, which"""
    FORM = "form"
    """how"""
    TIME = "time"
    """when, what time"""
    REASON = "reason"
    """why"""
    AMOUNT = "amount"
    """how many, how old, how often"""
    YES_NO = "yes_no"
    """A question without a question word; never part of a `Triple`."""

    def __repr__(self) -> str:
        return f"QuestionWord.{self.name}"
