"""Find names in introductions of users: *it's me, Ilka*, *Ilka here*, *my name is Ada, and I have had a long day*."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace

from .tree import Tree
from .verbs import VERBAL

SHORTEST = 3
"""An utterance says more than the user's name if it has at least this many words besides the introduction."""

_CLAUSE = re.compile(
    r"[.!?;:,…–—()\n]+\s*|\s(?:and|but|so|by the way|btw)\s(?=(?:i|my|we|our|it|this|that|the|he|she|they|there)\b)",
    re.IGNORECASE,
)
_OPENERS = (
    r"(?:(?:and|but|so|oh|ah|well|now|yes|yeah|no|nope|ok|okay|hi|hiya|hello|hey|hallo|there|again|actually|sorry|"
    r"anyway|good \w+|nice to meet you|by the way|btw) )*"
)
_CLOSERS = r"(?: (?:again|here|speaking|by the way|actually|now|then|today|too|at your service|as it happens))*"
_WORD = r"[^\W\d_](?:[\w'’-]*\w)?"
_NAME = re.compile(rf"(?P<name>{_WORD}(?: {_WORD}){{0,2}}?)")
_BESIDE = r"(?: from \w.*)?"
_IT_IS = r"it(?: is|['’]?s)|this is"
_FRAMES = [
    re.compile(frame, re.IGNORECASE)
    for frame in (
        rf"{_OPENERS}(?P<sure>my name(?: is|['’]s)|(?:you (?:can|may) )?call me|i(?: am|['’]m) called) {_NAME.pattern}{_CLOSERS}{_BESIDE}",
        rf"{_OPENERS}(?P<sure>name['’]s|(?-i:[Mm]y name(?= [A-Z]))) {_NAME.pattern}{_CLOSERS}{_BESIDE}",
        rf"{_OPENERS}(?:(?P<pointing>{_IT_IS})(?P<me> me)?|i(?: am|['’]m)) {_NAME.pattern}{_CLOSERS}{_BESIDE}",
        rf"{_OPENERS}{_NAME.pattern} (?P<here>(?:again )?here(?: again)?){_BESIDE}",
    )
]
_ME = re.compile(rf"{_OPENERS}(?:{_IT_IS})(?: only| just)? me{_CLOSERS}", re.IGNORECASE)
_POLITE = re.compile(
    r"(?:hi|hello|hey|good (?:morning|evening|day|afternoon)|(?:nice|pleased|glad) to meet you|there|you too)",
    re.IGNORECASE,
)
"""A part that is only polite."""


@dataclass(frozen=True, slots=True)
class Introduction:
    """A possible introduction: *I'm Ilka*, but also *I'm tired*."""

    name: str
    """The words in the place of a name: *Ilka*, *tired*."""
    rest: str
    """The words of the utterance outside the introduction, without polite words."""
    sure: bool = False
    """Whether the words around the name can only introduce a name: *my name is*, *call me*."""
    pointing: bool = False
    """Whether the words may also be about another person or thing: *it's Ilka*, *this is Ilka*."""
    present: bool = False
    """Whether the words say who is here: *it's me, Ilka*, *this is Ilka*, *Ilka here*."""
    late: bool = False
    """Whether a verb stands before the introduction: *my dog isn't Rex, it's Max*."""

    def named(self, persons: Collection[str]) -> Introduction | None:
        """Return the introduction, with a capital for the name; None if the rest is too short, or the name is doubtful.

        The rest must have at least `SHORTEST` words, without *my name*. The name must be one word. Unless the introduction
        is `sure`, the name must also be among `persons`.
        """
        known = self.sure or self.name.lower() in map(str.lower, persons)
        if (
            not known
            or " " in self.name
            or "my name" in self.rest.lower()
            or len(re.findall(r"\w+", self.rest)) < SHORTEST
        ):
            return None
        return replace(self, name=self.name[:1].upper() + self.name[1:])


def introductions_in(tree: Tree) -> Iterator[Introduction]:
    """Yield the words of an utterance that may be the user's name, each with the rest of the utterance."""
    ends = [*_CLAUSE.finditer(tree.text)]
    starts = [0, *(end.end() for end in ends)]
    stops, marks = [*(end.start() for end in ends), len(tree.text)], [*(end[0] for end in ends), ""]
    pieces, before = [tree.text[start:stop].strip() for start, stop in zip(starts, stops, strict=True)], ""
    for place, (piece, mark) in enumerate(zip(pieces, marks, strict=True)):
        if "?" in mark and not before:
            continue
        found = next(filter(None, (frame.fullmatch(piece) for frame in _FRAMES)), None)
        me = _ME.fullmatch(before)
        found = found or (_NAME.fullmatch(piece) if me else None)
        before = piece
        if found is None or _ME.fullmatch(piece):
            continue
        told, others = found.groupdict(), [at for at in range(len(pieces)) if at != place and pieces[at]]
        kept = (at for at in others if not (_POLITE.fullmatch(pieces[at]) or _ME.fullmatch(pieces[at])))
        rest = "".join(pieces[at] + (marks[at] if at + 1 != place else " ") for at in kept).strip(" ,")
        late = any(word.pos in VERBAL and word.start < starts[place] for word in tree.words)
        pointing = told.get("pointing") or ""
        present = bool(me or told.get("me") or told.get("here") or pointing.lower() == "this is")
        yield Introduction(told["name"], rest, bool(told.get("sure")), bool(pointing), present, late)
