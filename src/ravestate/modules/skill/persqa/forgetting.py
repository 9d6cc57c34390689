"""Requests to forget: *forget me*, *forget where I live*."""

from __future__ import annotations

import re
from collections.abc import Mapping

from .inquiries import inquiry
from .patterns import either
from .statements import statements
from .topics import Fact

_MINE = r"(about me|of me|me|myself|my (personal )?(data|name|information|info|details|profile|memory)|(the )?(data|information) (about|on|of) me)"
_FORGET = re.compile(
    r"(?<![\w'])"
    + either(rf"""
        (forget|erase|delete|remove|wipe|clear) (all |everything |anything |whatever )?((that )?(you (know|have|remember|stored|saved)|i told you) )?{_MINE}(?= *($|[.,;!?]|please|now|and|again|completely|entirely|for ?ever|from your))
        (forget|delete|erase) (all|everything) (that )?(i (have )?(told|said)|i've told)( to)?( you)?
        (please )?(don't|do not) remember me\b
    """),
    re.IGNORECASE,
)  # fmt: skip
_ASKED_TO = re.compile(r"((can|could|would|will) you |(want|like) (you )?to )(please |just )*$", re.IGNORECASE)
_OTHERWISE = re.compile(
    r"((don't|do not|never|won't|didn't|not|will|did|have|would|could) (\w+ )?(you )?(ever )?|"
    r"\b(i|we|you|they|he|she|people|everybody|everyone|who|to) (will |would |always |might |may |could )*)$",
    re.IGNORECASE,
)
"""Words before *forget me* that make it something other than a request."""


def wants_to_be_forgotten(text: str) -> bool:
    """Return whether the user wants all that is known about them forgotten.

    Example:
        >>> wants_to_be_forgotten("please forget me"), wants_to_be_forgotten("don't forget me")
        (True, False)
    """
    for match in _FORGET.finditer(text):
        before = text[: match.start()]
        if _ASKED_TO.search(before) or not _OTHERWISE.search(before):
            return True
    return False


_REQUEST = re.compile(
    r"^\W*(?:(?:please|now|and|ok|okay|just)\W+)*(?:(?:can|could|would|will) you (?:please )?|i want you to )?(?:please |just )?"
    r"(?:forget|delete|erase|unlearn|don't remember|do not remember) (?:about )?(?:that )?(?P<what>.+)$",
    re.IGNORECASE,
)
_OWN = re.compile(r"(?:(?:what|where|who|when|how old|everything|anything|all) )?(?:i|i'm|my|me)\b", re.IGNORECASE)


def to_forget(text: str, known: Mapping[str, tuple[str, ...]]) -> list[Fact] | None:
    """Return the known facts that the user wants forgotten; None if the text is not such a request.

    Args:
        text: The result of `phrase.plain`.
        known: Values by topic.

    Example:
        >>> to_forget("please forget where I live", {"home": ("Ulm",)})
        [Fact(topic='home', values=(), gone=True)]
    """
    request = _REQUEST.match(text)
    if request is None:
        return None
    what = request["what"].strip(" .!?")
    topics = [topic for topic, values in known.items() if what.casefold() in [value.casefold() for value in values]]
    if topics:
        return [Fact(topic, (what,), gone=True) for topic in topics]
    found = [Fact(fact.topic, fact.values, gone=True) for fact in statements(what)]
    if not found and (asked := inquiry(what)):
        found = [Fact(asked.topic, (), gone=True)]
    return found if found or _OWN.match(what) else None
