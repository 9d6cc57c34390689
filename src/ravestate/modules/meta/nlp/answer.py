"""Recognise answers: yes, no, or unsure.

The answer is at the beginning of a text. *Yes*, *no* and short answers (*I do*) are closed classes of words, read here; all other
answers resemble an example in ``answers.yaml``. Each part between commas is read on its own.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ravestate.language.matcher import bundled_matcher
from ravestate.language.normal import plain
from ravestate.language.shape import shape

from .word_set import word_set


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


_CLASSES = {"yes_2": 2, "yes_1": 1, "unsure": 0, "no_1": -1, "no_2": -2}
"""The classes of examples as scores."""

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
        return YesNo(2, 0, False) if emoji[1] == "👍" else YesNo(0, 2, False)
    spoken = _PART.findall(_STRETCHED.sub(r"\1", text[:_LONGEST].lower()))
    first, *others = _TURN.split("".join(plain(words) + marks for words, marks in spoken), maxsplit=1)
    score, other = _score(first), _score(others[0]) if others else None
    if not any(_parts(first)):  # thanks, but no
        score = other
    elif score is not None and other and score * other <= 0:
        score = 1 if other > 0 else -1
    return YesNo() if score is None else YesNo(max(score, 0), max(-score, 0), score == 0)


def _score(text: str) -> int | None:
    """Return the score of the first part that is more than a filler, with the parts up to the end of its sentence."""
    found: int | None = None
    hedged = False
    for words, marks in _parts(text):
        score = _score_of_part(words, asks="?" in marks)
        if hedge := _HEDGE.search(" ".join(words)):
            hedged = True
            if found is not None and hedge[0] == " ".join(words):
                continue
        if not found:
            if score is None:
                break
            found = score
        elif score:
            if score * found < 0:
                return 0 if hedged or abs(found) == 1 else found
            found = max(found, score, key=abs)
        if any(mark in ".!?…\n" for mark in marks):
            break
    return found and (found // abs(found) if hedged else found)


def _parts(text: str) -> Iterator[tuple[list[str], str]]:
    """Yield the parts of a text without fillers before them: their words, and the punctuation after them."""
    for part, marks in _PART.findall(text):
        words = part.split()
        while words and words[0] in _FILLERS:
            del words[0]
        if words:
            yield words, marks


def _score_of_part(words: Sequence[str], asks: bool) -> int | None:
    """Return the score of a part. A question is an answer if it is a weak one, or if it resembles an example that asks."""
    match = bundled_matcher("answers").match(" ".join(words))
    score = _CLASSES[match.name] if match is not None else None
    if match is not None and asks:
        return score if abs(score or 0) < 2 or shape(match.example)[3] else None
    if asks or (match is not None and match.example == " ".join(words)):
        return score
    first, *rest = words
    if first in _YES and not (first == "sure" and rest and rest[0] in _AUXILIARIES):
        return 2
    if first in _NO and (first != "no" or not rest or rest[0] in _NO_NOUN):
        return -2
    if first in _PRONOUNS and rest:  # a short answer: *I do*, *she really is not*
        adverb = rest[0].endswith("ly") or rest[0] in ("sure", "just", "still", "always")
        verb = [word for word in rest[adverb:] if word != "really"]
        if verb and verb[0] in _AUXILIARIES and verb[1:] in ([], ["not"]):
            return -2 if verb[1:] else 2
    return score
