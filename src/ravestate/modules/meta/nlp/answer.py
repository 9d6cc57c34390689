"""Recognise answers: yes, no, or unsure.

The reader takes cues from the beginning of the text, up to the first word that is not a cue. A cue means yes, no or unsure,
hedges, denies, intensifies, or fills. `_weigh` combines the cues; ``answer_cues.py`` lists them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from .answer_cues import CUES, FOLLOWERS, STATERS, STRICT, UNKNOWNS, Cue
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


NEITHER = YesNo()
UNSURE = YesNo(0, 0, True)

_TOKEN = re.compile(r"[^\W_]+(?:[-'][^\W_]+)*|[.,;:!?…\n]+|👍|👎")
_STRETCHED = re.compile(r"(.)\1{2,}")
_PUNCTUATION = frozenset(".,;:!?…\n")
_TURNS = frozenset(["but", "although", "though", "however"])
_IDLE = word_set(
    "really honestly just actually simply truly quite personally still totally absolutely definitely certainly sure surely"
)
"""Adverbs without effect between *I* and its verb: *I really don't know*."""
_PLAIN = word_set("yes yeah yep no nope probably maybe perhaps i")
"""Words that certainly begin another answer."""
_LONGEST_CUE = max(len(cue) for cue in CUES)
_CONTRACTIONS = {
    "can't": "can not",
    "cannot": "can not",
    "won't": "will not",
    "dont": "do not",
    "doesnt": "does not",
    "didnt": "did not",
    "isnt": "is not",
    "cant": "can not",
    "wouldnt": "would not",
    "im": "i am",
    "i'm": "i am",
    "id": "i would",
    "thats": "that is",
    "it's": "it is",
    "that's": "that is",
    "let's": "let us",
    "dunno": "do not know",
    "idk": "i do not know",
    "wanna": "want to",
    "gotta": "got to",
    "kinda": "kind of",
    "sorta": "sort of",
    "we'll": "we will",
}
_ENDINGS = {"n't": " not", "'d": " would", "'ll": " will", "'ve": " have", "'re": " are"}


def yesno_of(text: str) -> YesNo:
    """Return the meaning of `text` as an answer.

    Example:
        >>> yesno_of("not certainly but ok"), yesno_of("I like tea")
        (YesNo(yes=1, no=0, unsure=False), YesNo(yes=None, no=None, unsure=None))
    """
    words = _words(text)
    answer, end = _answer(words)
    for turn in range(end, len(words)):
        if words[turn] in _TURNS:
            other, _ = _answer(words[turn + 1 :])
            thanked = not answer and turn == end  # thanks, but no
            return other if thanked else _turned(answer, other)
    return answer


def _turned(first: YesNo, second: YesNo) -> YesNo:
    """Return the meaning of two answers with *but* between them."""
    if not first or not second or second == UNSURE or (first.yes and second.yes) or (first.no and second.no):
        return first
    return YesNo(1, 0, False) if second.yes else YesNo(0, 1, False)


def _words(text: str) -> list[str]:
    """Return the first words in lower case, without contractions, and with punctuation."""
    found: list[str] = []
    for token in _TOKEN.findall(text[:400].lower().replace("’", "'")):
        word = _STRETCHED.sub(r"\1", token)
        if word in _CONTRACTIONS:
            found += _CONTRACTIONS[word].split()
            continue
        for ending, meaning in _ENDINGS.items():
            if word.endswith(ending) and len(word) > len(ending):
                word = word.removesuffix(ending) + meaning
        found += word.split() or [token]
    return [
        word
        for index, word in enumerate(found)
        if not (word in _IDLE and 0 < index < len(found) - 1 and _is_idle(found[index - 1], found[index + 1]))
    ]


def _is_idle(before: str, after: str) -> bool:
    """Return whether an adverb between these words has no effect."""
    return (before in ("i", "we", "have", "am", "do") and after != "not") or (
        before == "not" and after in ("know", "want", "mind", "think", "believe", "like")
    )


def _answer(words: list[str]) -> tuple[YesNo, int]:
    """Return the answer at the beginning of `words`, and its end."""
    cues: list[Cue] = []
    reader = _Reader(words)
    index = 0
    while index < len(words):
        if words[index][0] in _PUNCTUATION:
            if "?" in words[index] and cues and words[index - 2 : index] != ["why", "not"]:
                return NEITHER, index
            index += 1
            continue
        cue, length = reader.cue_at(index)
        if cue is None:
            break
        cues.append(cue)
        index += length
    if index < len(words) and _is_question(words, index, cues):
        return NEITHER, index
    return _weigh(cues), index


def _is_question(words: list[str], index: int, cues: list[Cue]) -> bool:
    """Return whether the words after the answer make it a question: *right now?*, but not *yes, and you?*."""
    if any(word[0] in _PUNCTUATION for word in words[:index]) and any(cue.takes_side for cue in cues):
        return False
    for word in words[index:]:
        if word[0] in _PUNCTUATION:
            return "?" in word
    return False


class _Reader:
    """A finder of cues with a cache: some cues count only before another cue."""

    def __init__(self, words: list[str]) -> None:
        self._words = words
        self._known: dict[int, tuple[Cue | None, int]] = {}

    def cue_at(self, index: int) -> tuple[Cue | None, int]:
        """Return the longest cue at `index`, and its length in words."""
        if index not in self._known:
            self._known[index] = self._find(index)
        return self._known[index]

    def _find(self, index: int) -> tuple[Cue | None, int]:
        for length in range(min(_LONGEST_CUE, len(self._words) - index), 0, -1):
            phrase = tuple(self._words[index : index + length])
            cue = CUES.get(phrase)
            if cue is not None and self._may_end(cue, phrase, index + length):
                return cue, length
        return None, 0

    def _may_end(self, cue: Cue, phrase: tuple[str, ...], index: int) -> bool:
        """Return whether a cue may end here: *I do* is an answer, *I do the dishes* is not."""
        words = self._words
        if index == len(words) or words[index][0] in _PUNCTUATION or words[index] in _TURNS:
            return True
        if cue is Cue.UNSURE and words[index] in UNKNOWNS:
            return True
        if cue in (Cue.HEDGE, Cue.MAYBE) and words[index] in STATERS:  # I guess I do, but not: I guess he is at home
            following, _ = self.cue_at(index)
            return following is not None and following.takes_side
        if cue is Cue.SURE and words[index] in ("the", "a", "an"):
            return False
        if phrase not in STRICT:
            if cue in (Cue.FILLER, Cue.NOT) or words[index] in FOLLOWERS:
                return True
            return self.cue_at(index)[0] is not None
        while index < len(words):
            following, length = self.cue_at(index)
            if following is None:
                return words[index][0] in _PUNCTUATION
            if cue in (Cue.HEDGE, Cue.MAYBE) and following.takes_side:
                return True
            if words[index] in _PLAIN:  # I do yes, but not: I am fine
                return True
            if following is not Cue.FILLER:
                return False
            index += length
        return True


def _weigh(cues: list[Cue]) -> YesNo:
    """Return the combined meaning of cues."""
    cues = [cue for cue in cues if cue is not Cue.FILLER]
    sides: list[tuple[str, int]] = []  # sides with strengths
    hedged = denied = sure = False
    for cue in cues:
        if cue is Cue.UNSURE:
            sides.append(("unsure", 0))
        elif cue in (Cue.YES, Cue.YES_WEAK):
            sides.append(("no" if denied else "yes", 1 if cue is Cue.YES_WEAK or (denied and not sure) else 2))
        elif cue in (Cue.NO, Cue.NO_WEAK):
            sides.append(("no", 2 if cue is Cue.NO else 1))
        hedged |= cue in (Cue.HEDGE, Cue.MAYBE)
        sure |= cue is Cue.SURE
        denied |= cue is Cue.NOT
    if not sides:
        return _of_adverbs(cues)
    said = sides[0][0]
    torn = len({side for side, _ in sides}) > 1
    if said == "unsure" or (torn and (hedged or sides[0][1] == 1)):  # maybe yes, maybe no; sometimes yes, sometimes no
        return UNSURE
    strength = max(strong for side, strong in sides if side == said)
    if hedged or any(side == "unsure" for side, _ in sides):
        strength = 1
    elif sure and said == "yes":
        strength = 2
    return YesNo(strength, 0, False) if said == "yes" else YesNo(0, strength, False)


def _of_adverbs(cues: list[Cue]) -> YesNo:
    """Return the meaning of adverbs alone: *probably*, *absolutely not*, *not really*."""
    if not cues:
        return NEITHER
    hedged = any(cue in (Cue.HEDGE, Cue.MAYBE) for cue in cues)
    if Cue.NOT in cues:
        doubted = cues[0] is Cue.NOT and Cue.SURE in cues  # not really, but: really not
        return YesNo(0, 1 if hedged or doubted else 2, False)
    if Cue.MAYBE in cues and Cue.SURE not in cues and Cue.HEDGE not in cues:
        return UNSURE
    if hedged:
        return YesNo(1, 0, False)
    return YesNo(2, 0, False)
