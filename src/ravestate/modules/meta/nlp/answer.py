"""Recognise answers: yes, no, or unsure.

The answer is at the beginning of a text. *Yes*, *no* and short answers (*I do*) are closed classes of words, read here; all other
answers resemble an example in ``answers.yaml``. Each part between commas is read on its own.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ravestate.language.contractions import word_set
from ravestate.language.matcher import bundled_matcher
from ravestate.language.normal import plain


@dataclass(frozen=True, slots=True)
class YesNo:
    """The meaning of a text as an answer. All three are None for a text that is not an answer.

    Example:
        >>> yesno_of("probably not")
        YesNo(yes=0, no=1, unsure=False)
    """

    yes: int | None = None
    """0: no, 1: weakly, 2: surely."""
    no: int | None = None
    """0: no, 1: weakly, 2: surely."""
    unsure: bool | None = None
    """Whether the speaker does not know."""

    def __bool__(self) -> bool:
        """Return whether the text is an answer."""
        return self.yes is not None


NEITHER = YesNo()
UNSURE = YesNo(0, 0, True)
YES = (YesNo(1, 0, False), YesNo(2, 0, False))
"""Weakly, surely."""
NO = (YesNo(0, 1, False), YesNo(0, 2, False))
_CLASSES = {"yes_1": YES[0], "yes_2": YES[1], "no_1": NO[0], "no_2": NO[1], "unsure": UNSURE}

_PART = re.compile(r"([^.,;:!?…\n]*)([.,;:!?…\n]*)")
_STRETCHED = re.compile(r"([a-z])\1{2,}")
_TURN = re.compile(r"\b(?:but|although|though|however)\b")
_HEDGE = re.compile(r"\b(?:probably|maybe|perhaps|possibly|i guess|i suppose)\b(?! (?!yes|no|so|not)\w)")
"""A hedge before an answer or at the end of a part; *maybe he is at home* hedges a statement."""
_FILLERS = word_set("well oh ah uh um er hm hmm mm honestly actually so and then please sorry thanks frankly ha haha")
_YES = word_set("yes yeah yep yup yea ya yah yay yess aye ok okay okey sure")
_NO = word_set("no nope nah nay naw")
_AUXILIARIES = word_set("am is are was were do does did have has had can could will would shall should may might must")
_PRONOUNS = word_set("i you he she it we they that this there")
_NO_NOUN = (
    _PRONOUNS | _FILLERS | _NO | word_set("my your the a because not never thank thanks but if let sir ma'am maam way")
)
"""Words that do not continue a *no* before a noun: *no brothers*."""
_LONGEST = 400
"""Answers are short: the rest of a long text is not read."""


def yesno_of(text: str) -> YesNo:
    """Return the meaning of `text` as an answer.

    Example:
        >>> yesno_of("yes, but not now"), yesno_of("I like tea")
        (YesNo(yes=0, no=1, unsure=False), YesNo(yes=None, no=None, unsure=None))
    """
    if emoji := re.match(r"\W*([👍👎])", text):
        return YES[1] if emoji[1] == "👍" else NO[1]
    first, *others = _TURN.split(_plain(text), maxsplit=1)
    answer = _answer(first)
    other = _answer(others[0]) if others else NEITHER
    if not any(word not in _FILLERS for word in first.replace(",", " ").split()):
        return other  # thanks, but no
    if not answer or not other or other == UNSURE or (answer.yes and other.yes) or (answer.no and other.no):
        return answer
    return YES[0] if other.yes else NO[0]


def _plain(text: str) -> str:
    """Return the beginning of a text in plain form, with its punctuation."""
    parts = _PART.findall(_STRETCHED.sub(r"\1", text[:_LONGEST].lower()))
    return "".join(plain(words) + marks for words, marks in parts)


def _answer(text: str) -> YesNo:
    """Return the answer of the first part that is more than a filler, with the parts up to the end of its sentence."""
    found = NEITHER
    hedged = False
    for words, marks in _parts(text):
        answer = _of_part(words)
        if "?" in marks and words[:2] != ["why", "not"]:
            break
        if hedge := _HEDGE.search(" ".join(words)):
            hedged = True
            if found and hedge[0] == " ".join(words):
                continue
        if found in (NEITHER, UNSURE):
            if not answer:
                break
            found = answer
        elif answer in (*YES, *NO):
            if bool(answer.yes) != bool(found.yes):
                return UNSURE if hedged or 1 in (found.yes, found.no) else found
            found = max(found, answer, key=lambda side: (side.yes or 0) + (side.no or 0))
        if any(mark in ".!?…\n" for mark in marks):
            break
    if hedged and found in (YES[1], NO[1]):
        return YES[0] if found.yes else NO[0]
    return found


def _parts(text: str) -> Iterator[tuple[list[str], str]]:
    """Yield the parts of a text without fillers before them: their words, and the punctuation after them."""
    for part, marks in _PART.findall(text):
        words = part.split()
        while words and words[0] in _FILLERS:
            del words[0]
        if words:
            yield words, marks


def _of_part(words: Sequence[str]) -> YesNo:
    """Return the meaning of a part as an answer."""
    part = " ".join(words)
    match = bundled_matcher("answers").match(part)
    if match is not None and match.example == part:
        return _CLASSES[match.name]
    if hedge := re.match(_HEDGE, part):
        answer = _of_part(part[hedge.end() :].split()) if hedge[0] != part else UNSURE
        if answer in (YES[1], NO[1]):
            return YES[0] if answer.yes else NO[0]
    first, *rest = words
    if first in _YES and not (first == "sure" and rest and rest[0] in _AUXILIARIES):
        return YES[1]
    if first in _NO and (first != "no" or not rest or rest[0] in _NO_NOUN):
        return NO[1]
    if (short := _short_answer(words)) is not None:
        return short
    return NEITHER if match is None else _CLASSES[match.name]


def _short_answer(words: Sequence[str]) -> YesNo | None:
    """Return the meaning of a pronoun with an auxiliary alone: *I do*, *she really is not*."""
    if not (len(words) > 1 and words[0] in _PRONOUNS):
        return None
    adverb = words[1].endswith("ly") or words[1] in ("sure", "just", "still", "always")
    rest = [word for word in words[1 + adverb :] if word != "really"]
    if rest and rest[0] in _AUXILIARIES and rest[1:] in ([], ["not"]):
        return NO[1] if rest[1:] else YES[1]
    return None
