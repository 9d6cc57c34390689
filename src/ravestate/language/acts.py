"""Recognise the user's acts in an utterance: a greeting, thanks, a wish for quiet... ``acts.yaml`` lists the acts."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence

from .asides import LAUGHTER
from .contractions import word_set
from .feelings import clauses
from .lexicon import loaded_lexicon
from .matcher import Match, Matcher, bundled_matcher
from .nonsense import is_nonsense
from .normal import normalise, plain
from .replies import replies
from .sentences import sentences as sentences_of
from .shape import shape

LONGEST = 2000
"""The maximum number of characters of an utterance that are read."""

COURTESY = frozenset({"thanks", "acknowledgement", "apology", "wish"})
"""Acts that often accompany other acts: "thanks, bye", "okay, hello"."""
FORMULAS = frozenset({"greeting", "farewell", *COURTESY})
"""Acts whose short examples (formulas) may precede other words, as in "hello, what is your name"."""
FORMULA_WORDS = 4
"""The maximum number of words of a formula."""
ADDRESS_WORDS = 3
"""The maximum number of words besides the act for which `only` is true: "hello" with "my dear robot"."""

WISHES = frozenset({"quiet", "stop", "forget_me", "farewell", "play"})
"""Acts that a negation cancels: "don't be quiet"."""

_NEGATION = re.compile(r"\b(?:do not|don['’]?t|did not|didn['’]?t|not|never)\s+(?:you |ever )?", re.IGNORECASE)
_PAUSE = re.compile(r"[,;:()–—…]+|\s-+\s")
_ASKED = re.compile(r"(?:will|can|could|would|should|do|did|are) (?:i|you|we|they)\b", re.IGNORECASE)
"""The beginning of a question. The question "will you be here tomorrow" is not a farewell."""
_PLAYFUL = re.compile(
    rf"\b(?:{LAUGHTER}|jk|(?:just |only )kidding|joking|kinda funny|but (?:\w+ )*(?:funny|cute|sweet|love you"
    r"|like you|lovable|charming))\b|[:;]-?[)DPp](?!\w)|[😂🤣😄😜😉😅😆😁]",
    re.IGNORECASE,
)
LEAVING = 0.07
"""If the probability that a farewell suits as a reply is smaller than this, the text is no farewell."""
_SUBJECTS = word_set("i you he she it we they")
_LINKS = word_set("and then now so but")
_GOES_ON = word_set("is was are were be means of for to that which by in on at s")
"""A formula before one of these words is part of a sentence, not an act: "thanks to the rain", "hello is a song"."""


def heard(text: str, names: Collection[str] = ()) -> tuple[str, ...]:
    """Encode and return the sentences of an utterance in the normal form. Read at most 2000 characters.

    Args:
        text: The user's words.
        names: The agent's names, which get capitals. The clauses that may show a feeling are encoded with *you* in
            place of these names.
    """
    said = sentences_of(normalise(text[:LONGEST], names).text)
    bundled_matcher("acts").prepare([*said, *clauses(said, names)])
    return said


def acts(sentences: Sequence[str]) -> dict[str, Match]:
    """Return the acts in the sentences of an utterance, each with the sentence that shows it best.

    Until the matcher of the acts is loaded, only sentences and formulas that equal an example are recognised.

    Example:
        >>> sorted(acts(["Thanks, bye!"]))
        ['farewell', 'thanks']
    """
    found: dict[str, Match] = {}
    for sentence in _read(sentences):
        for match in sentence.acts:
            if match.name not in found or match.score > found[match.name].score:
                found[match.name] = match
    return found


def only(act: str, sentences: Sequence[str]) -> bool:
    """Return whether an utterance contains `act`, and apart from it only courtesies and a few other words.

    Example:
        >>> only("greeting", ["Hello, my dear robot!"]), only("greeting", ["Hello, who are you?"])
        (True, False)
    """
    parts = _read(sentences)
    names = {match.name for part in parts for match in part.acts}
    if act not in names or names - COURTESY - {act} or _ASKED.match(sentences[-1]):
        return False
    others = [word for part in parts for word in part.others]
    if not others:
        return True
    more = "?" in sentences[-1] or others[0] in _SUBJECTS or shape(" ".join(others))[3] > 0
    return len(others) <= ADDRESS_WORDS and not more and not any(part.differs for part in parts)


def is_playful(text: str) -> bool:
    """Return whether a text is playful. If it is, an insult in it is banter: *you are hopeless lol*."""
    return _PLAYFUL.search(text) is not None


def _read(sentences: Sequence[str]) -> list[_Sentence]:
    matcher = bundled_matcher("acts")
    sentences = [sentence[:LONGEST] for sentence in sentences]
    matches = [None if _taken_back(matcher, one) else one for one in matcher.match_all(sentences)]
    matches = [None if is_nonsense(text) else one for text, one in zip(sentences, matches, strict=True)]
    return [_Sentence(matcher, *pair) for pair in zip(sentences, matches, strict=True)]


def _taken_back(matcher: Matcher, found: Match | None) -> bool:
    """Return whether a text that matches one of `WISHES` is no wish after all.

    It is none if it is a mere name ("Bonn"), or if a negation cancels the wish. It is no farewell if a farewell does not
    suit as a reply. "Don't talk" stays a wish, because its example is also negative.
    """
    if found is None or found.name not in WISHES or (said := plain(found.text)) in matcher.exact:
        return False
    lexicon = loaded_lexicon()
    if (lexicon is not None and lexicon.name(said) != said) or (found.name == "farewell" and not _parts(found.text)):
        return True
    asserted = _NEGATION.sub("", found.text, count=1)
    wish = matcher.match(asserted) if asserted != found.text else None
    return wish is not None and wish.name == found.name and not _NEGATION.search(wish.example)


def _parts(text: str) -> bool:
    """Return whether a farewell may suit as a reply to a text. It does not suit *so that's gone now*."""
    return replies().kinds(text).get("leaves", 1.0) >= LEAVING


class _Sentence:
    """The acts of a sentence, and the words that belong to no act."""

    def __init__(self, matcher: Matcher, sentence: str, whole: Match | None) -> None:
        formulas: dict[str, Match] = {}
        self.others: list[str] = []
        for part in _PAUSE.split(sentence):
            self.others += _after_formulas(matcher, plain(part).split(), formulas)
        if "farewell" in formulas and self.others and not _parts(sentence):  # "see you get it"
            del formulas["farewell"]
        if whole is not None and not formulas:
            self.others = []
        self.differs = matcher.loaded and whole is None and bool(self.others)
        """Whether the sentence as a whole resembles no act, although it begins with a formula."""
        found = ([whole] if whole is not None else []) + [
            m for m in formulas.values() if whole is None or m.name != whole.name
        ]
        if len(found) > 1 or self.others:
            found = [match for match in found if match.name != "acknowledgement" or match is whole]
        self.acts: Sequence[Match] = found


def _after_formulas(matcher: Matcher, words: list[str], found: dict[str, Match]) -> list[str]:
    """Add the formulas at the beginning of `words` to `found`; return the words after them."""
    while words:
        size = _formula(matcher.exact, words)
        if not size:
            break
        text, words = " ".join(words[:size]), words[size:]
        name = matcher.exact[text]
        found.setdefault(name, Match(1.0, text, 1.0, name=name, text=text))
        if name in COURTESY and words[:1] == ["for"]:  # "thanks for the book": the rest belongs to the thanks
            return []
        while words and words[0] in _LINKS:
            words = words[1:]
    return words


def _formula(examples: Mapping[str, str], words: list[str]) -> int:
    """Return the number of words of the longest formula at the beginning of `words`; 0 if there is none."""
    if words[0] in _SUBJECTS:
        return 0
    for size in range(min(FORMULA_WORDS, len(words)), 0, -1):
        name, after = examples.get(" ".join(words[:size])), "".join(words[size : size + 1])
        if name in FORMULAS and (after not in _GOES_ON or (after == "for" and name in COURTESY)):
            return size
    return 0
