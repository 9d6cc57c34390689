"""Recognise answers: yes, no, or unsure.

The network (`language.network`) reads the first `LONGEST` characters of a text. The answers in `PLAIN` and
thumbs (👍, 👎) always count. Until the network is loaded, or without the sentence model, only these answers and openings
such as *no, ...* count.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from ravestate.language.classifier import Classifier
from ravestate.language.network import LONGEST
from ravestate.language.normal import plain


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


PLAIN = {
    "yes 2": "yes yeah yep yup aye sure ok okay certainly absolutely definitely of_course yes_please",
    "no 2": "no nope nah never no_way no_thanks no_thank_you certainly_not of_course_not absolutely_not",
    "yes 1": "probably i_guess_so i_think_so kind_of sort_of why_not",
    "no 1": "not_really probably_not i_do_not_think_so rather_not not_now",
    "unsure": "maybe perhaps i_do_not_know no_idea not_sure it_depends beats_me",
}
"""A class → its answers. An underscore stands for a space."""
_PLAIN = {words.replace("_", " "): name for name, listed in PLAIN.items() for words in listed.split()}
_OPENING = re.compile(r"\W*(yes|yeah|yep|no|nope|nah)[,.!]", re.IGNORECASE)
"""An answer before other words: *no. I have to go*."""
_FILLER = re.compile(r"^\W*(?:(?:well|oh|ah|uh|um|er|hm+|so)\b[\s,.!…]*)+(?=\w)", re.IGNORECASE)
"""Words without meaning before an answer."""
_RETURNED = re.compile(r"[\s,.!;]+(?:and|what about|how about) (?:you|yours|yourself)\W*$", re.IGNORECASE)
"""A question back, after an answer: *yes, and you?*."""
_REPEATED = re.compile(r"\b(\w+)(?:[\s,]+\1\b)+", re.IGNORECASE)
_YES = (
    "yes|yeah|yep|yup|yea|aye|sure|ok|okay|of course|certainly|absolutely|definitely|please do|do it|do that|go ahead|i am sure|"
    "i'm sure|you may|you can|i agree|(?:delete|erase|remove) (?:me|it|that|everything|it all|all of it|all)|"
    "forget (?:me|everything|all of it)|👍"
)
_BEGINS = re.compile(rf"\W*(?:(?:oh|well|so)\W+)*(?:{_YES})(?!\w)", re.IGNORECASE)
_ONLY = re.compile(rf"{_BEGINS.pattern}(?:\W+(?:{_YES}|please|thanks|thank you|now|all|everything))*\W*", re.IGNORECASE)
_REFUSES = re.compile(r"\b(?:no|not|never|do ?nt|nothing|stop|cancel|leave|wait)\b|n['’]t\b", re.IGNORECASE)
_LETTER = re.compile(r"[\W_]*[^ynk\W\d_]?[\W_]*", re.IGNORECASE)
"""A text without letters and digits, or with a single letter that is no answer (*y*, *n* and *k* are answers). The
network has not learnt such texts."""
_EMOJI = re.compile(r"\W*([👍👎])")
_ANSWERS = Classifier("answers")


def yesno_of(text: str) -> YesNo:
    """Return what `text`, an utterance in normal form, means as an answer.

    Example:
        >>> yesno_of("Yes, but not now."), yesno_of("I like tea.")
        (YesNo(yes=0, no=1, unsure=False), YesNo(yes=None, no=None, unsure=None))
    """
    if emoji := _EMOJI.match(text):
        return YesNo(2, 0, False) if emoji[1] == "👍" else YesNo(0, 2, False)
    if _LETTER.fullmatch(text):
        return YesNo()
    text = _FILLER.sub("", text)
    text = _REPEATED.sub(r"\1", _RETURNED.sub(".", text[:LONGEST]))
    name = _PLAIN.get(plain(text)) or _ANSWERS.best(text)[0]
    if name in ("", "-") and (opening := _OPENING.match(text)):
        name = _PLAIN[opening[1].lower()]
    meaning, _, strength = name.partition(" ")
    if meaning not in ("yes", "no", "unsure"):
        return YesNo()
    return YesNo(int(strength) if meaning == "yes" else 0, int(strength) if meaning == "no" else 0, meaning == "unsure")


def is_only_yes(text: str) -> bool:
    """Return whether a text is a clear *yes* and nothing else: *yes, delete it please*.

    Require such a *yes* before a step that cannot be undone: the network may mistake *I love it here* for a *yes*.
    """
    return _ONLY.fullmatch(text) is not None


def begins_with_yes(text: str) -> bool:
    """Return whether a text begins with a clear *yes*, and has no word of refusal, such as *not* or *wait*."""
    return _BEGINS.match(text) is not None and _REFUSES.search(text) is None
