"""Utterances that are only a greeting, or only a goodbye."""

from __future__ import annotations

import re

from ravestate.modules._courtesy import COURTESY

GREETING = re.compile(
    r"(hi+|hello+|hey+|hiya|howdy|greetings|good (morning|afternoon|evening|day)|hallo+|guten (morgen|tag|abend)|moin)\b",
    re.IGNORECASE,
)
FAREWELL = re.compile(
    rf"{COURTESY}(bye+([ -]bye+)?|goodbye|good bye|good night|see (you|ya)( later| soon| tomorrow)?|farewell(?! \w)|cheerio|ciao|"
    r"take care(?! (of|that|not|to)\b)|tschüss|auf wiedersehen|gute nacht|"
    r"i (have to|must|need to|gotta) go(?! (to (?!bed|sleep)|\w+ing\b|on\b|through\b)))\b",
    re.IGNORECASE,
)
EXTRA_WORDS = 3
"""The number of words that may follow: "hello my dear robot" is a greeting, "hello, can you tell me the time?" is more."""


def is_greeting(text: str) -> bool:
    """Return whether `text` only greets."""
    return _only(GREETING, text)


def is_farewell(text: str) -> bool:
    """Return whether `text` only says goodbye."""
    return _only(FAREWELL, text)


def _only(pattern: re.Pattern[str], text: str) -> bool:
    text = text.strip()
    found = pattern.match(text)
    if found is None or "?" in text:
        return False
    return len(re.findall(r"[^\W_]+", text[found.end() :])) <= EXTRA_WORDS
