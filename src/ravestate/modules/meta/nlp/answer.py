"""Recognise answers: yes, no, or unsure.

The answer is at the beginning of a text. This file reads *yes*, *no* and short answers (*I do*) word for word. Other
answers are compared with the examples in ``answers.yaml``. Each part between commas is read on its own.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import zip_longest

from ravestate.language.contractions import word_set
from ravestate.language.matcher import bundled_matcher
from ravestate.language.normal import plain
from ravestate.language.sentences import sentences
from ravestate.language.shape import shape


@dataclass(frozen=True, slots=True)
class YesNo:
    """The meaning of a text as an answer. If the text is not an answer, all fields are None.

    Example:
        >>> yesno_of("probably not")
        YesNo(yes=0, no=1, unsure=False)
    """

    yes: int | None = None
    """The strength of the *yes* in the text: 0 (none), 1 (weak) or 2 (sure)."""
    no: int | None = None
    """The strength of the *no* in the text: 0 (none), 1 (weak) or 2 (sure)."""
    unsure: bool | None = None
    """Whether the speaker does not know."""

    def __bool__(self) -> bool:
        """Return whether the text is an answer."""
        return self.yes is not None


_SCORES = {"yes_2": 2, "yes_1": 1, "unsure": 0, "no_1": -1, "no_2": -2}
"""Class of examples → its score, from 2 (surely yes) to -2 (surely no)."""
_PART = re.compile(r"([^.,;:!?…\n]*)([.,;:!?…\n]*)")
_STRETCHED = re.compile(r"([a-z])\1{2,}")
_TURN = re.compile(r"\b(?:but|although|though|however)\b")
_HEDGE = re.compile(r"\b(?:probably|prob|maybe|perhaps|possibly|i guess|i suppose)\b(?! (?!yes|no|so|not)\w)")
"""A hedge before an answer or at the end of a part. In *maybe he is at home*, it does not count: no answer follows."""
_WEAKENING = re.compile(
    r"(?:just |only )?(?:a (?:bit|little)|sort of|kinda|kind of|in a way|on the whole|in (?:principle|theory)|as far as i know|i might"
    r"|(?:it )?looks like it|it seems so|more or less|reasonably|tolerably|mostly|i hope(?: so)?|at least i hope so|perhaps|maybe)\b(?! you)"
)
"""Beginnings of a part beside a *yes* that make it weak: *in a way, yes*, *yes, perhaps a small one*."""
_PLAINLY = re.compile(r"yes|yeah|yep|no|nope|nah")
_UNFIT = re.compile(
    r"\b(?:not|never|no|nobody|none|nothing|don't|who|what|when|where|why|how|which|said|told|he|she|they|tell|give|do|please)\b"
)
"""Words of a part that no answer follows: it denies, asks, reports or orders something."""
_FILLERS = word_set("well oh ah uh um er hm hmm mm honestly actually so and then please sorry frankly ha haha")
_COURTESIES = ("thanks", "thank you", "many thanks")
"""Parts before an answer: *thank you, but no*."""
_STANCE = word_set("sadly unfortunately regrettably luckily fortunately thankfully happily")
"""Words before an answer that say how the speaker feels about it. Alone, they are answers."""
_TRAILING = word_set(
    "lol lmao rofl haha hehe please sorry thanks though actually honestly mate man bro dude buddy dear"
)
"""Words after an answer that do not change it."""
_VERB = "am|is|are|was|were|do|does|did|have|has|had|can|could|will|would|shall|should|may|might|must"
_YES = re.compile(
    rf"(?:yes|yeah|yep|yup|yea|ya|yah|yay|yess|aye|(?:ok|kk|okay|okey)(?! so\b)|sure(?! (?:{_VERB}|enough)\b))\b(?! (?:was|is|means)\b)"
)
_NO = re.compile(
    r"(?:nope|nah|nay|naw|no(?! (?!(?:i|you|he|she|it|we|they|that|this|there|my|your|the|a|well|oh|please|sorry|thanks?|"
    r"no|nope|because|cause|since|not|never|but|if|let|sir|ma'am|maam|way)\b)))\b"
)
"""The word *no*, unless a noun follows, as in *no brothers*."""
_SHORT = re.compile(
    rf"(?:i|you|he|she|it|we|they|that|this|there|(?:all|both|each|most|every\w+)(?: of \w+)?|(?:my|our|his|her|their|the) "
    rf"\w+(?: \w+)?) (?:\w+ly |sure |just |still |always )?(?:{_VERB})(?: really)?( not)?$"
)
"""A short answer: *I do*, *she certainly is not*, *my sister does*."""
_SOMEBODY = word_set("my our his her their the he she they some most others everyone everybody")
"""First words of an answer after *but* that is about other people: *no, but my cousin does*."""
_LEAD = 2
"""The maximum number of words before a comma that introduce an answer: *I mean, sure*."""
_LONGEST = 400
"""The maximum number of characters that are read, because answers are short."""


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
    if not any(_parts(first)):  # as in "thanks, but no"
        score = other
    elif score is not None and other and score * other <= 0 and others[0].split()[0] not in _SOMEBODY:
        score = 1 if other > 0 else -1
    if score is None and len([*_parts(" ".join([first, *others]))]) + len(others) > 1 and "?" not in text:
        score = _score_of_sentence(text)  # as in "thanks, but I'm fine"
    return YesNo() if score is None else YesNo(max(score, 0), max(-score, 0), score == 0)


def _score(text: str) -> int | None:
    """Return the score of a text's first sentence. Skip sentences that consist of fillers."""
    found: int | None = None
    opened = hedged = weak = False
    parts = list(_parts(text))
    for (part, marks), (after, _) in zip_longest(parts, parts[1:], fillvalue=("", "")):
        score = _score_of_part(part, asks="?" in marks)
        weak = weak or (_explicit(part) is None and _WEAKENING.match(part) is not None)
        if (hedge := _HEDGE.search(part)) is not None:
            hedged = True
            if found is not None and hedge[0] == part:
                continue
        if not found:
            if score is None and len(part.split()) > _LEAD and not _answers_after(part, marks, after):
                break
            found = found if score is None else score
            opened = _explicit(part) is not None
        elif score and score * found < 0:
            if hedged:
                return 0
            whole = None if opened else _score_of_sentence(text)
            return found if whole is None else whole
        elif score:
            found = max(found, score, key=abs)
        echoes = (
            found is None and "?" in marks and len(part.split()) <= _LEAD and _PLAINLY.fullmatch(after)
        )  # "what? no!"
        if not echoes and not {*".!?…\n"}.isdisjoint(marks):
            break
    return found // abs(found) if found and (hedged or (weak and found > 0)) else found


def _answers_after(part: str, marks: str, after: str) -> bool:
    """Return whether an answer follows a long part that is none: *after my coffee, yes*.

    *Ok* and the like are no such answers, because they often only end a sentence: *you must not do that, ok*.
    """
    return marks in (",", ":") and _PLAINLY.fullmatch(after) is not None and _UNFIT.search(part) is None


def _parts(text: str) -> Iterator[tuple[str, str]]:
    """Yield each part of a text, without the fillers around it, and the punctuation after it."""
    for part, marks in _PART.findall(text):
        words: list[str] = [] if part in _COURTESIES else part.split()
        while words and (words[0] in _FILLERS or (words[0] in _STANCE and len(words) > 1)):
            del words[0]
        while len(words) > 1 and words[-1] in _TRAILING:
            del words[-1]
        if words:
            yield " ".join(words), marks


def _score_of_part(part: str, asks: bool) -> int | None:
    """Return the score of a part.

    A part with a question mark counts only if the example that it resembles has the same word order. For a sure *yes*
    or *no*, this must be the word order of a question.
    """
    match = bundled_matcher("answers").match(part)
    score = _SCORES[match.name] if match is not None else None
    if match is not None and asks:
        order = shape(match.example)[3]
        return score if order == shape(part)[3] and (order or match.name[-1] != "2") else None
    if asks or (match is not None and match.example == part):
        return score
    if short := _SHORT.match(part):
        return -2 if short[1] else 2
    word = _explicit(part)
    return score if word is None else word


def _explicit(part: str) -> int | None:
    """Return the score of a part that begins with *yes* or *no*; None for any other."""
    return 2 if _YES.match(part) else -2 if _NO.match(part) else None


def _score_of_sentence(text: str) -> int | None:
    """Return the score of a text's first sentence as a whole: its parts have no score, or contradict each other."""
    match = next(iter(bundled_matcher("answers").match_all(sentences(text)[:1])), None)
    return None if match is None else _SCORES[match.name]
