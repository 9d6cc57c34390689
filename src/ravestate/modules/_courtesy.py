"""Polite words before a sentence: thanks, okay, well."""

from __future__ import annotations

COURTESY = (
    r"(?:(?:ok|okay|well|alright|all right|right|so(?! long)|then|oh|great|fine|anyway|(?:many )?thanks|thank you)\b"
    r"(?: (?:very much|much|a lot|again|for (?:the |your )?\w++(?!\s+\w)))*+[\s,.!;:-]*+)*+"
)
"""A regular expression for the polite words that may precede a farewell.

Its quantifiers are possessive: a pattern that could match in two ways would double its time with each word.
"""
