"""Turns that patterns recognise: news or a complaint in the form of a question, and a farewell."""

from __future__ import annotations

import re

LONGEST = 400
"""The maximum number of characters that `is_cry` reads: its pattern takes time that grows with the square of the length."""
_NEWS = re.compile(
    r"\b(?:did|do) you (?:also |even )?know that\b|\bdid you (?:also |even )?know,? (?!that\b|who|what|where|when|why|how|which|whose|whether|if\b"
    r"|him\b|them\b|about|of\b|any|someb|me\b|it\b)[\w']+ .*\w",
    re.IGNORECASE,
)
"""News in the form of a question: *did you know that snails sleep for years?*"""
_CRY = re.compile(
    r"\bwhy\b.*\b(?:always|never|every time|only (?:me|i)|nobody ever|everything|everybody|have to)\b", re.IGNORECASE
)
"""A complaint in the form of a question, if it ends with an exclamation mark or is in capitals."""
_LEAVING = re.compile(
    r"(?:^|[,.!?]|\b(?:bye|and|so|ok|well|then)) *(?:(?:good)?bye|good ?night|adieu|ciao|chau|adios|farewell)(?:,? (?!to\b)\w+){0,3}"
    r"(?: and thanks?\b[\w ]*)?\W*$|^(?:(?:ok|well|so|then|right|now|alright)\W+)*(?:good)?bye\b(?! to\b)"
    r"|\b(?!(?:say|said|says|saying|tell|told|wave|waved|kissed|him|her|them|me|us|you|a|my|his|our|their|the|last|final|no)\b)\w+ bye(?: \w+)?\W*$"
    r"|(?:^|[,.!] *|\b(?:and|so|then) )(?:see|talk to|speak to|catch) (?:you|ya|u) (?:soon|later|tomorrow|then|around|next \w+|on \w+day)\b[\w ,]*\W*$"
    r"|(?:^|[,.!] *|\band )have an? (?:very )?(?:nice|good|great|lovely|wonderful|pleasant) (?:day|evening|night|weekend|afternoon|week|one|time|rest"
    r" of)\b[^.?]*$",
    re.IGNORECASE,
)
"""A farewell at the end of an utterance: *I have to go now, bye!*, *have a nice day*."""


def is_news(text: str) -> bool:
    """Return whether a text tells news in the form of a question."""
    return _NEWS.search(text) is not None


def is_cry(text: str) -> bool:
    """Return whether a text is a complaint in the form of a question: *why does it always hit me!*"""
    letters = [one for one in text if one.isalpha()]
    loud = text.rstrip().endswith("!") or (len(letters) > 9 and sum(map(str.isupper, letters)) > len(letters) / 2)
    return _CRY.search(text[:LONGEST]) is not None and loud


def is_leaving(text: str) -> bool:
    """Return whether a text ends with a farewell: *I have to go now, bye!*, *have a nice day*."""
    return _LEAVING.search(text) is not None
