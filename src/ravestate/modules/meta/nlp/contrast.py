"""Contrasts: *Leipzig, not Leeds*, *not Leeds but Leipzig*. A contrast asserts one phrase, and denies only the other.

The parser finds no common structure for contrasts: it attaches *not* to the verb, or takes the denied word for a second
object, an apposition or a verb. `join_contrasts` gives all contrasts one structure: the denied phrase is a conjunct of the
asserted phrase, and the negation depends on the denied phrase. A *repaired tree* (see `repair.repaired`) has this structure.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ravestate.language.contractions import word_set

from .phrase import Phrase, phrase_of
from .tree import SUBJECTS, Tree, Word, is_tree
from .verbs import NEGATIONS, PLACES, VERBAL

_NOUNS = ("NOUN", "PROPN", "NUM", "PRON", "X")
_INNER = (*_NOUNS, "DET", "ADJ", "PART")
_OBJECTS = ("dobj", "attr", "acomp", "pobj", "oprd")
LONGEST = 3
"""The maximum number of words on each side of a contrast in a text without a verb. The word *not* is not counted."""
_SKIPPED = (",", "-", "–", "—", ";", "(")
_ASIDE = word_set(
    "today tonight tomorrow yesterday now day week month year time weekend night morning evening moment "
    "chance problem bit clue word idea lot all any anymore more one thing way"
)
"""Heads of phrases before which *not* makes no contrast: *I live in Rome, not all the time*, *not a chance*."""
_EXCEPTED = word_set("anything anyone anybody anywhere nothing nobody none everything everybody everyone all")
"""Words after which *but* means *except*: *I don't eat anything but rice*."""


@dataclass(frozen=True, slots=True)
class Contrast:
    """The asserted phrase (`right`) and the denied phrase (`wrong`): *Bern* and *Bonn*, in *it's Bern, not Bonn*."""

    right: Phrase
    wrong: Phrase


def contrasts_of(tree: Tree) -> tuple[Contrast, ...]:
    """Return the contrasts of phrases in a repaired tree, also in texts without a verb."""
    denied = [word for word in tree.words if word.dep == "conj" and word.pos not in VERBAL and is_denied(tree, word)]
    pairs = ((tree.head(word), word) for word in denied)
    return tuple(
        Contrast(phrase_of(tree, _noun(tree, right)), phrase_of(tree, _noun(tree, wrong)))
        for right, wrong in pairs
        if right.pos not in VERBAL
    )


def is_denied(tree: Tree, word: Word) -> bool:
    """Return whether, in a repaired tree, a negation denies only this conjunct, or only the prepositional phrase around it."""
    above = tree.head(word)
    if word.dep == "pobj" and above.dep == "conj":
        word = above
    return word.dep == "conj" and any(_denies(tree, child) for child in tree.children(word, "neg"))


def contrasted_with(tree: Tree, word: Word) -> bool:
    """Return whether, in a repaired tree, a contrast asserts this noun and denies another noun in its place."""
    tops = (word, tree.head(word)) if word.dep == "pobj" else (word,)
    return any(is_denied(tree, other) for other in tree.children_of(tops, "conj"))


def join_contrasts(tree: Tree) -> list[Word]:
    """Return the words of a tree, in which the denied phrase of each contrast becomes a conjunct of the asserted phrase."""
    if (words := _fragment(tree)) is not None:
        return words
    for word in tree.words:
        pair = _before_not(tree, word) if word.low == "not" else None
        pair = _after_not(tree, word) if word.low in ("but", ",") else pair
        if pair is not None:
            tree = Tree(tree.text, _joined(tree, *pair))
    return list(tree.words)


def _before_not(tree: Tree, negation: Word) -> tuple[Word, Word, Word, Sequence[Word]] | None:
    """Return the parts of *Bern not Bonn*; None if there is no such contrast.

    The parts are the head of the asserted phrase, the head of the denied phrase, the negation, and the denied words.
    """
    span = _span(tree, negation.index + 1)
    last = _back(tree, negation.index - 1)
    if last is None or not span:
        return None
    wrong = _top(tree, span)
    if wrong is None or _noun(tree, wrong).low in _ASIDE or _is_negated(tree, negation):
        return None
    verbless = not any(word.pos in VERBAL and word not in span for word in tree.words)
    for right in _tops(tree, last):
        if (right.pos == "ADP") != (wrong.pos == "ADP") or _is_vague(right):
            continue
        alike = (right.dep, right.head) == (wrong.dep, wrong.head) and right.dep in (*_OBJECTS, "prep")
        mistaken = len(span) == 1 and wrong.pos in (*VERBAL, "ADJ") and right.pos == "PROPN" and wrong.tag != "VBG"
        if not (alike or mistaken or _kind(right) == _kind(wrong)):
            continue
        if (verbless or right.dep in SUBJECTS) and _determiners(tree, right) != _determiners(tree, wrong):
            return None  # "my name not Tom", without a verb
        return right, wrong, negation, span
    return None


def _after_not(tree: Tree, but: Word) -> tuple[Word, Word, Word, Sequence[Word]] | None:
    """Return the parts of *not Bonn but Bern* and of *not Bonn, Bern*, as `_before_not` does."""
    span, last = _span(tree, but.index + 1), _back(tree, but.index - 1)
    right = _top(tree, span) if span else None
    if last is None or right is None:
        return None
    after = tree.words[span[-1].index + 1 :][:1]
    for wrong in _tops(tree, last):
        inner = [word for word in tree.subtree(wrong) if word.index <= last.index and word.low not in NEGATIONS]
        if not inner:
            continue
        before = tree.words[: inner[0].index]
        negation = next((word for word in reversed(before) if _denies(tree, word) or word.pos == "PUNCT"), None)
        if negation is None or negation.pos == "PUNCT" or wrong.low in _EXCEPTED:
            continue
        opens = negation == before[-1]
        verb = next((above for above in tree.ancestors(wrong) if above.pos in VERBAL), None)
        ours = (
            opens or tree.head(negation) == verb or (verb is not None and tree.head(negation) in tree.ancestors(verb))
        )
        if but.low == "," and not (opens and _begins(before[:-1]) and (not after or after[0].pos == "PUNCT")):
            continue
        subject = bool(after) and after[0].pos in VERBAL
        if (subject and not opens) or not ours or (right.pos == "ADP") != (wrong.pos == "ADP"):
            continue
        if _kind(right) == _kind(wrong) or (right.dep, right.head) == ("conj", wrong.index):
            return right, wrong, negation, inner
    return None


def _fragment(tree: Tree) -> list[Word] | None:
    """Join the contrast in a text without a verb (*Leipzig, not Leeds*); return None for other texts.

    The tags in such a text are unreliable, so the punctuation, *but* and *not* separate the two sides.
    """
    parts = [word for word in tree.words if not _begins(tree.words[: word.index + 1])]
    while parts and parts[-1].pos == "PUNCT":
        parts.pop()
    marks = [word for word in parts if word.pos == "PUNCT" or word.low == "but"]
    clausal = any(word.pos in ("AUX", "PRON", "ADP") or word.tag in ("VBD", "VBP") for word in parts)
    if clausal or not marks or marks[-1].index - marks[0].index >= len(marks):
        return None  # several commas
    first = [word for word in parts if word.index < marks[0].index]
    second = [word for word in parts if word.index > marks[-1].index]
    right, denied = (second, first) if first and first[0].low == "not" else (first, second)
    if not denied or denied[0].low != "not" or not 0 < len(right) <= LONGEST or not 1 < len(denied) <= LONGEST + 1:
        return None
    negation, *wrong = denied
    tops = [next((word for word in reversed(side) if word.pos in _NOUNS), side[-1]) for side in (right, wrong)]
    words = [replace(word, head=tops[word in (*wrong, negation)].index) for word in tree.words]
    words[negation.index] = replace(words[negation.index], dep="neg")
    for top, dep in zip(tops, ("ROOT", "conj"), strict=True):
        kind = {} if top.pos in (*_NOUNS, "ADJ") else {"pos": "NOUN", "tag": "NN"}
        words[top.index] = replace(top, dep=dep, head=tops[0].index, **kind)
    return words


def _joined(tree: Tree, right: Word, wrong: Word, negation: Word, span: Sequence[Word]) -> list[Word]:
    """Return the words of a tree in which `wrong`, with the words `span`, is the denied conjunct of `right`."""
    words = list(tree.words)
    places = {word.index for word in span}
    inside = any(word.index in places for word in tree.ancestors(right))
    later = right.index > wrong.index and right.dep not in SUBJECTS and right not in tree.ancestors(wrong)
    if inside or later:  # the asserted phrase takes the place of the denied phrase in its sentence
        top = wrong.head == wrong.index
        words[right.index] = replace(right, dep=wrong.dep, head=right.index if top else wrong.head)
    for word in tree.words:
        if word.index in places and word != wrong and word.head not in places:
            words[word.index] = replace(words[word.index], head=wrong.index)
        elif word.index not in places and word != right and word.head in places:
            words[word.index] = replace(words[word.index], head=right.index)
    if right.dep == "dep" and tree.head(right).pos in VERBAL:
        words[right.index] = replace(words[right.index], dep="attr")
    verbal = wrong.pos in (*VERBAL, "ADJ") and right.pos in ("NOUN", "PROPN")
    kind = {"pos": right.pos, "tag": right.tag, "lemma": wrong.text} if verbal else {}
    words[wrong.index] = replace(wrong, dep="conj", head=right.index, **kind)
    words[negation.index] = replace(words[negation.index], dep="neg", head=wrong.index)
    return words if is_tree(words) else list(tree.words)


def _span(tree: Tree, start: int) -> list[Word]:
    """Return the words of the phrase that begins at index `start`.

    A single word counts as a phrase even if the tagger takes it for a verb or an adverb.
    """
    found: list[Word] = []
    for word in tree.words[start:]:
        if word.pos not in _INNER and not (word.pos == "ADP" and (not found or word.low == "of")):
            break
        found.append(word)
    rest = tree.words[start + len(found) :]
    alone = not found and rest[:1] and (len(rest) == 1 or rest[1].pos in ("PUNCT", "CCONJ"))
    return [rest[0]] if alone and rest[0].pos in (*VERBAL, "ADV") else found


def _top(tree: Tree, span: Sequence[Word]) -> Word | None:
    """Return the head of the phrase `span`: its preposition, or its noun."""
    if span[0].pos == "ADP":
        return span[0] if any(word in span for word in tree.children(span[0], "pobj")) else None
    places = {word.index for word in span}
    tops = [word for word in span if word.head not in places or word.head == word.index]
    tops = [word for word in tops if word.pos not in ("DET", "PART")]
    return tops[-1] if tops else None


def _tops(tree: Tree, last: Word) -> list[Word]:
    """Return the possible heads of the phrase that ends with `last`, the lowest in the tree first.

    If there are more than two, heads with a determiner come first.
    """
    found = [last] if last.pos in (*_NOUNS, "ADJ") and last.low not in PLACES else []
    for word in tree.ancestors(last) if found or last.low in PLACES else ():
        if word.index > last.index or (word.pos in VERBAL and word.dep != "relcl"):
            break
        if word.pos in (*_NOUNS, "ADJ", "ADP") and (word.dep not in ("conj", "appos")):
            found.append(word)
    determined = [word for word in found if word.pos != "ADP" and _determiners(tree, word)]
    return [*determined, *(word for word in found if word not in determined)] if len(found) > 2 else found


def _back(tree: Tree, place: int) -> Word | None:
    """Return the last word of the phrase before a negation or *but*, searching back from index `place`.

    A comma or an adverb may stand between this word and the negation.
    """
    skipped = ("ADV", "CCONJ") if any(word.pos in VERBAL for word in tree.words) else ("ADV", "CCONJ", "PUNCT")
    while place >= 0 and (tree.words[place].low in _SKIPPED or tree.words[place].pos in skipped):
        place -= 1
    return tree.words[place] if place >= 0 else None


def _is_negated(tree: Tree, negation: Word) -> bool:
    """Return whether another negation stands before this one in its sentence."""
    for word in reversed(tree.words[: negation.index]):
        if word.low in (".", "!", "?", ":"):
            return False
        if word.low in NEGATIONS and word.dep == "neg":
            return True
    return False


def _noun(tree: Tree, top: Word) -> Word:
    return next(iter(tree.children(top, "pobj")), top) if top.pos == "ADP" else top


def _denies(tree: Tree, word: Word) -> bool:
    """Return whether a word is a negation, or the end of *no longer*."""
    before = tree.before(word)
    return word.low in NEGATIONS or (word.low == "longer" and before is not None and before.low == "no")


def _begins(before: Sequence[Word]) -> bool:
    """Return whether only interjections stand before a word: *no, not Leeds*."""
    return all(word.pos in ("INTJ", "PUNCT") or word.low in ("no", "nope", "nah", "sorry", "oh") for word in before)


def _is_vague(word: Word) -> bool:
    """Return whether a word is a pronoun that *not* cannot contrast: *i* in *i not understand*, *it* in *she did it, not me*."""
    return word.pos == "PRON" and (word.dep in SUBJECTS or word.low in ("it", "that", "this"))


def _kind(word: Word) -> str:
    return "noun" if word.pos in _NOUNS else word.pos


def _determiners(tree: Tree, word: Word) -> set[str]:
    return {child.low for child in tree.children(word, "det", "poss")}
