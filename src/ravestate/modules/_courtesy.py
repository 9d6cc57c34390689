"""What people put before what they mean: thanks, okay, well."""

from __future__ import annotations

__all__ = ["COURTESY"]

COURTESY = (
    r"(?:(?:ok|okay|well|alright|all right|right|so(?! long)|then|oh|great|fine|anyway|(?:many )?thanks|thank you)\b"
    r"(?: (?:very much|much|a lot|again|for (?:the |your )?\w++(?!\s+\w)))*+[\s,.!;:-]*+)*+"
)
"""A regular expression of what may stand before a farewell. It is possessive: what can be matched in two ways would take a
time that doubles with each word."""
