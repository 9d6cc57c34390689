"""Turn typed English into its normal form: correct written English, with offsets into the original.

A well-written sentence stays as it is. Other sentences are mended in four steps:

1. words: write out the short forms in `WRITTEN`, drop letters repeated for emphasis, and mend typing errors and the
   capitals of names with the `Lexicon`;
2. punctuation: add a space after a comma, a comma after an interjection and around a written-out *tbh*, a full stop
   before a question;
3. the start and end of each sentence: add a capital, and a full stop or question mark;
4. slips of the tongue: leave out the words that the user takes back, as in *I live in Bern, I mean Bonn*.
"""

from __future__ import annotations

import re
import threading
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import takewhile
from typing import Any

from .contractions import CONTRACTIONS, WRITTEN, word_set
from .lexicon import SHORTEST, Lexicon, loaded_lexicon
from .slips import slips


@dataclass(frozen=True, slots=True)
class Normal:
    """A text in its normal form."""

    text: str
    """The normal form: short forms written out, typing errors mended, capitals for names and *I*, a mark at the end."""
    original: str
    """The text as typed."""
    origin: tuple[int, ...]
    """The position in `original` of each character of `text`, and of its end. The positions never decrease."""

    def span(self, start: int, end: int) -> tuple[int, int]:
        """Return the span of `original` that became ``text[start:end]``. An added mark has an empty span."""
        return self.origin[start], self.origin[end]

    def adds(self, start: int, end: int) -> bool:
        """Return whether ``text[start:end]`` was added: nothing in the original corresponds to it."""
        return start < end and self.origin[start] == self.origin[end]

    @property
    def unguessed(self) -> str:
        """The normal form with full stops in place of added question marks, which are only guesses. The networks read it."""
        if "?" not in self.original:
            return self.text.replace("?", ".")
        return "".join("." if mark == "?" and self.adds(at, at + 1) else mark for at, mark in enumerate(self.text))

    @property
    def typed(self) -> str:
        """The normal form with the user's capitals: a word that differs only in capitals stays as the user typed it."""
        if self.text == self.original:
            return self.text
        parts: list[str] = []
        last = 0
        for found in _WORD.finditer(self.text):
            start, end = self.span(*found.span())
            written = self.original[start:end]
            same = written.lower().replace("’", "'") == found[0].lower()
            parts += [self.text[last : found.start()], written if same else found[0]]
            last = found.end()
        return "".join([*parts, self.text[last:]])


@dataclass(slots=True)
class _Piece:
    """A word of the normal form, its span in the original, and the punctuation and space before it (`gap`).

    `first` marks the first word of a sentence. `code` marks a part of an address or a formula, which stays as it is.
    """

    start: int
    end: int
    text: str
    gap: str = ""
    first: bool = False
    code: bool = False

    @property
    def low(self) -> str:
        return self.text.lower()


_WORD = re.compile(r"[^\W_]+(?:['’-][^\W_]+)*")
_STOP = re.compile(r"[.!?…]+[\"')]*\s|\n")
_PASSES = 4
_CHUNK = re.compile(r"\S+")
_CODE = re.compile(r"[@/\\_=&#<>{}|~^*+%]|www\.")
_CROWDED = re.compile(r"[,;:!?]")
_NO_WORD = re.compile(r"\d|^[^a-z]", re.IGNORECASE)
_DOMAINS = word_set("com org net info gov uk us de at eu html txt")

_WH = word_set("what who where when why how which whose whom what's who's where's when's why's how's")
_BE = word_set("is are was were am isn't aren't wasn't weren't")
_AUX = _BE | word_set(
    "do does did don't doesn't didn't can could will would shall should may might have has had "
    "can't couldn't won't wouldn't shouldn't haven't hasn't hadn't"
)
_STATING = word_set(
    "i you he she it we they there that this my your let's i'm you're it's that's he's she's we're they're"
)
"""Words that begin statements."""
_INTERJECTION = word_set("hi hello hey yes yeah yep no nope ok okay thanks sorry wow oh well bye")
_OPENING = _INTERJECTION | word_set("and but so then now")
"""Words after which a clause may begin like a sentence."""
_GOVERNING = _AUX | word_set(
    "know tell me ask wonder see say guess remember forget forgot about of and or but so nor neither as than that if"
)
"""Words before a clause that belongs to the same sentence: *know* in *I know who you are*."""
_SUPPOSING = word_set("think hope guess bet believe glad")
"""Words after which *ur* means *you are* if just one more word follows in the sentence: *I think ur funny*."""
_PLACED = word_set("called named from in")
_NAMING = _PLACED | word_set("am i'm to")
_PEOPLE = word_set(
    "mother mum mom father dad sister brother wife husband partner boyfriend girlfriend fiance fiancee daughter son child kid "
    "baby friend mate buddy cousin uncle aunt auntie nan gran grandma grandpa grandmother grandfather granddaughter grandson "
    "niece nephew boss colleague neighbour neighbor flatmate roommate dog puppy cat kitten pet rabbit hamster horse parrot"
)
"""Words that may stand between *my* and a name: *my brother josh*."""
_INTRODUCING = ("name is", "name's", "this is")
"""Words before a name. An unknown word after them is probably a name, not a typing error."""
_PARTS_OF_NAMES = word_set("new north south east west san santa los las saint el la puerto costa rio cape hong")
"""First words of place names: *New York*."""
_AT = word_set("at by until till before after from since around about is and")
"""Words after which the figure 2 means a time or a number, not *to*."""
_SET_OFF = frozenset(["to be honest"])
"""Written forms that have commas around them."""
_COUNTED = word_set("times days weeks months years hours minutes people")
_FIRST = frozenset(entry.partition(" ")[0] for entry in WRITTEN if " " in entry)

_ANY_SUBJECT = "(?:i|you|he|she|it|we|they)"
_ANY_AUX = f"(?:{'|'.join(sorted(_AUX, reverse=True))})"
_DONE = (
    "(?:sports|exercises|dishes|chores|things|drugs|tricks|crafts|puzzles|crosswords|sums|always|us|as|this|his|yes)"
)
"""Words after *do* in an order or a statement. Before other plurals, *do* begins a question: *do dogs dream*."""
_ASKS = re.compile(
    rf"""(?:(?:i'm|i|fine|good)\ (?:.*\ )?)?and\ you$ | (?:what|how)\ about\b | (?:what|who|where|when|why|how)'s\b |
    (?:what|who|why|which|whose)\b(?!\ (?:{_ANY_SUBJECT}|an?)\b) |
    (?:where|when|how|whom)(?:\ (?!{_ANY_SUBJECT}\b)\S+){{0,2}}\ {_ANY_AUX}(?!\S) |
    (?:do|don't|have|may|might)\ (?!it\b){_ANY_SUBJECT}\b | do\ (?!{_DONE}\b)(?:[a-z]{{2,}}s|people|children|fish|mice)\ [a-z]+ | (?!(?:do|don't|have|may|might)\b){_ANY_AUX}\ (?!not\b)""",
    re.VERBOSE,
)
"""The beginning of a question. *Do it* and *have a nice day* are not questions."""
_ASKS_ANEW = re.compile(
    rf"""(?:what|who|where|when|why|how|which|whose|whom)\ {_ANY_AUX}\ (?:{_ANY_SUBJECT}|your|my)\b |
    how\ \S+\ {_ANY_AUX}\ {_ANY_SUBJECT}\b | (?:what|how)\ about\ you\b""",
    re.VERBOSE,
)
_ASKS_YOU = re.compile(r"(?:do|are|can|did|would|will|have|could) you \S")
"""The beginning of a question right after a statement, if the statement has a subject."""

LONGEST = 2000
"""The maximum number of characters that get a normal form; the rest of a text stays as typed."""
REMEMBERED = 64
"""The number of normal forms that are kept, because many rules read the same utterance."""


def normalise(text: str, names: Collection[str] = ()) -> Normal:
    """Return the normal form of `text`. A new sentence takes about a millisecond, a recent one no time.

    Typing errors and the capitals of names are mended only after a call of `load_lexicon`.

    Args:
        text: The text as typed.
        names: Names to write with capitals, such as the agent's and the user's.

    Example:
        >>> normalise("u cant do that can u").text
        "You can't do that can you."
    """
    if len(text) > LONGEST:
        start = text[:LONGEST].rfind(" ") + 1 or LONGEST
        begun = normalise(text[:start], names)
        rest = range(start, len(text) + 1)
        return Normal(begun.text + text[start:], text, (*begun.origin[:-1], *rest))
    known = tuple((part.lower(), part) for name in names for part in name.split())
    with _sharing:
        shared = _shared(text, known, loaded_lexicon())
    return shared.normal()


class _Shared:
    """A normal form that one thread computes, while other threads that ask for the same form wait."""

    def __init__(self, *given: Any) -> None:
        self._given = given
        self._lock = threading.Lock()
        self._normal: Normal | None = None

    def normal(self) -> Normal:
        with self._lock:
            if self._normal is None:
                self._normal = _normalised(*self._given)
            return self._normal


_shared = lru_cache(maxsize=REMEMBERED)(_Shared)
_sharing = threading.Lock()  # held only during the look-up, so threads with other texts need not wait


def _normalised(text: str, names: tuple[tuple[str, str], ...], lexicon: Lexicon | None) -> Normal:
    known = dict(names)
    normal = Normal(text, text, tuple(range(len(text) + 1)))
    for punctuated in (False, True):  # first the words, because the punctuation depends on them
        for _ in range(_PASSES):  # words that one pass mends may let the next pass mend more
            again = _once(normal.text, known, lexicon, punctuated)
            if again.text == normal.text:
                break
            normal = Normal(again.text, text, tuple(normal.origin[place] for place in again.origin))
    while slip := next(slips(normal.text), None):  # "in Rome, no, Bern, no, Bonn" has two
        start, end = slip
        normal = Normal(normal.text[:start] + normal.text[end:], text, normal.origin[:start] + normal.origin[end:])
    return normal


def _once(text: str, known: dict[str, str], lexicon: Lexicon | None, punctuated: bool) -> Normal:
    pieces = _pieces(text, lexicon)
    words = [piece.text for piece in pieces if any(map(str.isalpha, piece.text))]
    if len(words) > 1 and all(map(str.isupper, words)) and sum(len(word) > 2 for word in words) > 1:  # SHOUTED
        for piece in pieces:
            piece.text = piece.low
    pieces = _mended(pieces, known, lexicon)
    if punctuated:
        _punctuate(pieces)
    return _joined(pieces, text)


@lru_cache(maxsize=256)  # all matchers ask for the same sentences
def plain(text: str) -> str:
    """Return a text in its plain form, for comparisons: lower case, no punctuation, short forms written out.

    Example:
        >>> plain("What's up, Doc?")
        'what is up doc'
    """
    words = [found[0].replace("’", "'").lower() for found in _WORD.finditer(text)]
    words = " ".join(WRITTEN.get(word, word).lower() for word in words).split()
    return " ".join(CONTRACTIONS.get(word, word) for word in words)


def _pieces(text: str, lexicon: Lexicon | None) -> list[_Piece]:
    """Return the words of a text as pieces; the last piece has no word, only the end of the text."""
    pieces: list[_Piece] = []
    codes = [found.span() for found in _CHUNK.finditer(text) if _CODE.search(found[0])]
    last = 0
    for found in _WORD.finditer(text):
        code = any(start <= found.start() < end for start, end in codes)
        gap = text[last : found.start()]
        if pieces and not code and _crowded(pieces[-1].text, gap, found[0], lexicon):
            gap += " "
        first = not pieces or bool(_STOP.search(gap))
        pieces.append(_Piece(found.start(), found.end(), found[0].replace("’", "'"), gap, first, code))
        last = found.end()
    pieces.append(_Piece(len(text), len(text), "", text[last:]))
    return pieces


def _crowded(before: str, mark: str, after: str, lexicon: Lexicon | None) -> bool:
    """Return whether a space is missing after the mark between two words. No space is missing in *example.org*."""
    if _NO_WORD.search(after) or (len(before) < 2 and not before.isdigit()):
        return False
    if mark == ".":
        words = before.lower(), after.lower()
        return after not in _DOMAINS and lexicon is not None and all(map(lexicon.known, words))
    return bool(_CROWDED.fullmatch(mark)) and "." not in before


def _mended(pieces: Sequence[_Piece], known: dict[str, str], lexicon: Lexicon | None) -> list[_Piece]:
    """Return the pieces with their words mended; up to three words may become one piece."""
    mended: list[_Piece] = []
    index = 0
    while index < len(pieces):
        piece, following = pieces[index], pieces[index + 1 :]
        before = " ".join(other.low for other in mended[-2:])
        size = 1 if piece.code else _longest(piece, following, before)
        if size > 1:
            phrase = " ".join(other.low for other in pieces[index : index + size])
            piece.text, piece.end = _cased(WRITTEN[phrase], piece), pieces[index + size - 1].end
        elif piece.code:
            pass
        elif piece.low in known:
            piece.text = piece.text if piece.text != piece.low else known[piece.low]
        elif written := _written(piece, following, before.rpartition(" ")[2], lexicon):
            piece.text = _cased(written, piece)
            if written in _SET_OFF:
                _add_commas(piece, following[0])
        elif lexicon is not None and piece.text == piece.low:
            piece.text = _by_lexicon(piece.text, before, following[0] if following else None, lexicon)
        mended.append(piece)
        index += size
    return mended


def _add_commas(*pieces: _Piece) -> None:
    """Add a comma before each word that follows another word of its sentence without a mark."""
    for piece in pieces:
        if piece.text and not piece.first and piece.gap.isspace():
            piece.gap = "," + piece.gap


def _longest(piece: _Piece, following: Sequence[_Piece], before: str) -> int:
    """Return the number of words of the longest entry of `WRITTEN` that begins at `piece`; 1 if there is none."""
    for size in (3, 2) if piece.low in _FIRST else ():
        rest = following[: size - 1]
        phrase = " ".join([piece.low, *(other.low for other in rest)])
        if phrase not in WRITTEN or not all(other.gap.isspace() for other in rest):
            continue
        figure = phrase.startswith("2 ") and before.rpartition(" ")[2] in _AT
        if not figure and not (phrase.endswith(" 2") and following[1].low in _COUNTED):
            return size
    return 1


def _written(piece: _Piece, following: Sequence[_Piece], last: str, lexicon: Lexicon | None) -> str | None:
    """Return the form of a word in `WRITTEN`; None if the word is not there, or means something else here."""
    word, low = piece.text, piece.low
    opens = piece.first or last in _OPENING
    asks = low in ("its", "ur") and any("?" in other.gap for other in following)
    if low == "its":
        verb = any(other.low in _AUX for other in following[:4])
        begins = piece.first or last in _INTERJECTION
        return "it's" if begins and len(following) > 0 and not (asks or verb or word.isupper()) else None
    if low in ("lets", "k", "ya") and (not opens or word == "K"):
        return None
    if low == "ur" and (opens or last in _SUPPOSING) and not asks and len(following) > 1 and not following[1].text:
        return "you're"  # "ur funny"
    typed = word in (low, "I") or (len(word) > 2 if word.isupper() else piece.first)
    if not typed or (len(word) < 3 and word != low and lexicon is not None and lexicon.name(low) != low):
        return None
    return "yes" if low == "ya" else WRITTEN.get(low)


def _by_lexicon(word: str, before: str, after: _Piece | None, lexicon: Lexicon) -> str:
    """Mend the typing errors of a word in lower case; write a name with its capital."""
    stem, mark, end = word.partition("'")
    last = before.rpartition(" ")[2]
    own = before.startswith(("my ", "our ")) and last in _PEOPLE
    placed = own or last in _PLACED or before.endswith(_INTRODUCING)
    named = lexicon.name(stem)
    if named == stem and (placed or last in _NAMING):
        named = lexicon.possible_name(stem)
    if named != stem or mark or not stem.isalpha():
        return ("I" if stem == "i" and mark else named) + mark + end
    if last in _PLACED and stem in _PARTS_OF_NAMES and after and lexicon.name(after.low) != after.low:
        return stem.capitalize()  # New York
    short = lexicon.unstretched(stem)
    if short != stem:
        return WRITTEN.get(short, lexicon.name(short))
    mended = lexicon.correction(stem)
    if (placed or last in _NAMING) and (mended == stem or len(stem) < 7):
        unknown = placed and len(stem) >= SHORTEST and stem.isascii() and lexicon.rare(stem)
        return stem.capitalize() if unknown else stem
    return mended


def _cased(written: str, piece: _Piece) -> str:
    """Return `written`, with a capital if the typed word begins with one."""
    return written[0].upper() + written[1:] if piece.text[0].isupper() else written


def _punctuate(pieces: Sequence[_Piece]) -> None:
    """Add the capitals, commas and final marks that are missing."""
    start = 0
    for index, piece in enumerate(pieces):
        if index and (piece.first or index == len(pieces) - 1):
            _end(pieces[start:index], piece)
            start = index
        elif index and piece.gap.isspace() and "\n" not in piece.gap:
            if index == start + 1 and pieces[start].low in _INTERJECTION and piece.low in _STATING | _WH | _AUX:
                piece.gap = "," + piece.gap
            elif _asks_anew(pieces[start:index], " ".join(other.low for other in pieces[index : index + 4])):
                _end(pieces[start:index], piece, ".")
                piece.first, start = True, index
        if piece.first and piece.text[:1].islower() and not piece.code:
            piece.text = piece.text[0].upper() + piece.text[1:]


def _end(sentence: Sequence[_Piece], following: _Piece, mark: str = "") -> None:
    """Add the mark at the end of a sentence, unless it has one."""
    gap = following.gap
    if gap.strip() or not any(letter.isascii() for piece in sentence for letter in piece.text):
        return
    words = [piece.low for piece in sentence]
    while len(words) > 1 and words[0] in _INTERJECTION | {"and", "but", "so"} and words != ["and", "you"]:
        del words[0]
    following.gap = (mark or ("?" if _ASKS.match(" ".join(words)) else ".")) + gap


def _asks_anew(sentence: Sequence[_Piece], following: str) -> bool:
    """Return whether a question begins after a statement, with no mark between them."""
    asks = _ASKS_ANEW.match(following)
    if not asks and not _ASKS_YOU.match(following):  # the usual case: the checks below would take long in a long text
        return False
    before = [piece.low for piece in sentence]
    if len(before) < 2 or before[-1] in _GOVERNING or before[0] in _AUX - _BE or not _WH.isdisjoint(before):
        return False
    return bool(asks) or not _STATING.isdisjoint(before)


def _joined(pieces: Sequence[_Piece], original: str) -> Normal:
    """Return the pieces as a text with its offsets."""
    parts: list[str] = []
    origin: list[int] = []
    last = 0
    for piece in pieces:
        origin += _aligned(piece.gap, original[last : piece.start], last)
        origin += _aligned(piece.text, original[piece.start : piece.end], piece.start)
        parts += [piece.gap, piece.text]
        last = piece.end
    return Normal("".join(parts), original, (*origin, len(original)))


def _aligned(written: str, typed: str, start: int) -> list[int]:
    """Return the origin of each written character. Equal beginnings and ends match; the rest is spread evenly."""
    size, wide = len(typed), len(written)
    if size == wide:
        return list(range(start, start + size))
    low, typed_low = written.lower(), typed.lower()
    head = _same(low, typed_low)
    tail = _same(low[head:][::-1], typed_low[head:][::-1])
    inner, width = size - head - tail, wide - head - tail
    between = [start + head + min(inner * place // max(width, 1), inner) for place in range(width)]
    return [*range(start, start + head), *between, *range(start + size - tail, start + size)]


def _same(one: str, other: str) -> int:
    """Return the number of equal letters at the beginning of two words."""
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(one, other, strict=False)))
