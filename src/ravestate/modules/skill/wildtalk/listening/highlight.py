"""The highlight of an utterance: the phrase that carries most information, from the agent's view.

*The wife packed me egg sandwiches again* has the highlight *egg sandwiches*. A listener who repeats it shows that they
have listened. The information of a word is the negative logarithm of its frequency in English. The highlight is the
noun phrase, with its prepositional phrases, whose words have most information.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ravestate.language.contractions import word_set
from ravestate.language.lexicon import Lexicon, loaded_lexicon
from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.tree import SUBJECTS, Tree, Word

from .echo import DENYING, IMAGINING, echo

LONGEST = 8
"""The maximum number of words of a highlight."""
SHORT = 5
"""An unknown word with fewer letters counts as a slip of the pen."""
SUBTITLES = 1.6e9
"""The number of words in the corpus from which `Lexicon` takes its frequencies."""
DULL = 7.0
"""The information, in nats, that a word must exceed to count. *Time* and *thing* have less, *sock* has 11."""
UNKNOWN = 13.5
"""The maximum information of a word, in nats. Unknown words have this value, because they may be slips."""
LEAST = 2.4
"""The minimum information of a highlight, in nats above `DULL`."""
KNOWN_LEAST = 4.0
"""The same for definite phrases, such as *the timer* and *my teeth*, which are mostly mentioned in passing."""
NUMBER = 3.0
"""The information of a number beside a noun, in nats above `DULL`: *fourteen years*."""
BEFORE = 0.5
"""The share of its information that a phrase before *but* keeps: *the room is lovely, but the stairs are steep*."""
LATER, SUBJECT, BESIDE, KNOWN = 1.2, 0.55, 0.55, 0.4
"""Factors for the information of a word. `LATER`: it is near the end, where the point often is. `SUBJECT`: it is the
subject, which is often known. `BESIDE`: it is part of a place, a time or a subordinate clause. `KNOWN`: the user said it
before."""

_EMPTY = word_set(
    "thing things stuff lot lots bit kind sort way time times day days one ones something anything nothing everything"
    " someone somebody anyone anybody everyone everybody nobody guy guys people today tomorrow yesterday tonight morning"
    " weekend weekends afternoon evening night week weeks month months year years moment minute minutes hour hours monday tuesday wednesday"
    " thursday friday saturday sunday january february march april june july august september october november december"
    " spring summer autumn winter easter christmas row mate bro dude dear robot bot buddy pal goodnight bye goodbye hello hi name names rest"
    " end part side place point case fact reason idea matter lol haha ok okay"
)
"""Nouns that name nothing, or only a time."""
_LEFT = ("det", "amod", "compound", "nummod", "poss", "case", "nmod", "quantmod", "predet", "advmod")
_DEFINITE = word_set("the my our your his her its their it's")
_LAST = word_set("lol haha btw tho though lmao xd pls please again too")
"""Words that may be tagged as a part of the phrase before them."""
_PLACES = ("GPE", "LOC", "FAC", "EVENT", "PRODUCT", "WORK_OF_ART", "NORP")
"""Kinds of names that may be a highlight."""
_PRONOUNS = word_set("mine yours his hers ours theirs")
_DROPPED = word_set("some any such whatever its maybe perhaps probably just only")
"""Words that sound odd at the beginning of an exclamation. *Its* mostly is a typed *it's*."""
_PLACING = word_set("in on under behind off onto into over without inside across around through between among outside")
"""Prepositions with which a highlight may begin."""
_DENYING = DENYING | word_set("without")
_COMPARING = word_set("like than as per versus")
"""Prepositions whose phrases are no part of a thing: *a cup of water like a lunatic*."""
_IMAGINING = IMAGINING | word_set("if unless whether")


@dataclass(frozen=True, slots=True)
class Highlight:
    """A phrase of the user."""

    text: str
    """The phrase from the agent's view, without a capital: *half your moustache*."""
    information: float
    """The information of its words, in nats above `DULL`."""
    start: int
    """The index of its noun in the utterance."""


def highlight_in(seen: Analysis, words: Sequence[Word], known: str = "", *, asked: bool = False) -> Highlight | None:
    """Return the highlight of some words of an utterance; None if nothing in them stands out.

    Args:
        seen: The analysis of the utterance.
        words: The words of its statements.
        known: The user's previous utterance, whose words count less.
        asked: Whether the words are a question. If so, nouns that the user does not assert count, too.
    """
    lexicon, tree = loaded_lexicon(), seen.tree
    before = set(known.lower().split())
    inside = {word.index for word in words}
    named = [entity.text.lower().split() for entity in seen.entities if entity.label in _PLACES]
    places = {word.index for word in words if any(word.low in name for name in named)}
    turn = max((word.index for word in words if word.low == "but"), default=-1)  # the point follows *but*
    found: list[Highlight] = []
    for place, noun in enumerate(words):
        if not _names(tree, noun, places) or not (asked or _is_asserted(tree, noun)):
            continue
        for phrase in map(_without_tail, _phrases(tree, noun, inside)):
            if lexicon is not None and any(lexicon.rare(word.low) and len(word.low) < SHORT for word in phrase):
                continue  # a slip of the pen
            if not 0 < len(phrase) <= LONGEST or any(word.pos == "PUNCT" and word.text not in "-’'" for word in phrase):
                continue
            told = _information(lexicon, phrase, before)
            told *= 1 + (LATER - 1) * place / len(words)
            told *= _weight(tree, noun) * (BEFORE if noun.index < turn else 1.0)
            text = _written(lexicon, echo(tree, phrase))
            bare = phrase[phrase[0].pos == "ADP" :]  # "on the telly" says no more than "the telly"
            plainly = bare[0].low in _DEFINITE and not any(word.pos in ("ADJ", "NUM", "ADP") for word in bare)
            if told >= (KNOWN_LEAST if plainly else LEAST) and text:
                found.append(Highlight(text, told, noun.index))
    return max(found, key=lambda one: one.information, default=None)


def _written(lexicon: Lexicon | None, text: str) -> str:
    """Return a phrase with capitals for its names: *to Portugal*."""
    return (
        text if lexicon is None else " ".join(lexicon.name(word) if word.islower() else word for word in text.split())
    )


def _weight(tree: Tree, noun: Word) -> float:
    """Return the factor for a noun's information, by its place in the sentence."""
    while noun.dep == "conj" and tree.head(noun).pos in ("NOUN", "PROPN"):
        noun = tree.head(noun)
    share = SUBJECT if noun.dep in SUBJECTS and tree.head(noun).lemma != "be" else 1.0
    share *= BESIDE if noun.dep == "pobj" and tree.head(tree.head(noun)).pos not in ("NOUN", "PROPN") else 1.0
    return share * (BESIDE if any(word.dep in ("relcl", "advcl", "acl") for word in tree.ancestors(noun)) else 1.0)


def _without_tail(phrase: list[Word]) -> list[Word]:
    while phrase and phrase[-1].low in _LAST:
        phrase = phrase[:-1]
    return phrase


def _names(tree: Tree, noun: Word, places: set[int]) -> bool:
    """Return whether a word can be the noun of a highlight: it names something. `places`: the words of other names."""
    if noun.pos == "ADJ" and noun.dep in ("acomp", "oprd"):
        return bool(tree.children(noun, "advmod"))  # "faintly pink"
    if noun.pos not in ("NOUN", "PROPN") or len(noun.low) < 3:
        return False
    counted = any(word.low not in ("one", "1") for word in tree.children(noun, "nummod"))
    if not counted and not _EMPTY.isdisjoint((noun.low, noun.lemma.lower())):
        return False
    if noun.dep in ("compound", "npadvmod", "intj", "nmod", "vocative"):
        return False
    if noun.pos == "PROPN" and noun.index not in places and not noun.text.islower():
        return False  # a person's name alone is no highlight
    left = {word.low for word in tree.children(noun)}
    gerund = noun.low.endswith("ing") and not left.isdisjoint(("its", "it's"))  # "its raining" as people type it
    return not gerund and left.isdisjoint(("no", "what", "which"))


def _is_asserted(tree: Tree, noun: Word) -> bool:
    """Return whether a noun is neither denied nor imagined."""
    if any(word.low == "any" for word in tree.children(noun)):
        return False
    for above in tree.ancestors(noun):
        helpers = {word.low for word in tree.children(above)}
        if helpers & (_DENYING | _IMAGINING):
            return False
        if above.dep in ("ROOT", "conj"):
            break
    return True


def _phrases(tree: Tree, noun: Word, inside: set[int]) -> Iterator[list[Word]]:
    """Yield the phrases of a noun: first with its own words only, then also with the phrases directly after it."""
    left = [word for word in tree.subtree(noun) if word.index < noun.index and _belongs(tree, word, noun)]
    while left and (left[0].low in _DROPPED or left[0].pos in ("CCONJ", "PUNCT", "INTJ")):
        left.pop(0)
    core = [*left, noun]
    if [word.index for word in core] != list(range(core[0].index, noun.index + 1)) or core[0].low in _PRONOUNS:
        return
    head = tree.head(noun)
    if noun.dep == "pobj" and head.index == core[0].index - 1 and head.low in _PLACING and head.index in inside:
        core = [head, *core]
    elif noun.dep == "pobj" and noun.tag == "NN" and core[0] is noun:
        return  # "train" of "by train"
    after = next((word for word in tree.words if word.index == noun.index + 1), None)
    if after is not None and after.pos in ("NOUN", "PROPN", "PART") and after.start == noun.end + 1:
        return  # "the conductors" of "the conductors glasses"
    yield core
    grown = list(core)
    for _ in range(2):
        after = next((word for word in tree.words if word.index == grown[-1].index + 1), None)
        if after is None or after.index not in inside:
            return
        loose = after.low in _COMPARING or (
            noun.pos == "PROPN" and after.low not in ("of", "to")
        )  # "from Ghent with a bad hip"
        if after.pos == "ADP" and after.dep in ("prep", "agent") and not loose and not tree.children(after, "pcomp"):
            more = tree.subtree(after)
        elif (after.low in ("again", "too") or (after.low == "of" and after.dep == "prep")) and after.pos != "VERB":
            more = [after]
        else:
            clause = next((one for one in tree.children(noun, "relcl") if tree.subtree(one)[0] is after), None)
            if clause is None or len(tree.subtree(clause)) > 4:
                return
            more = tree.subtree(clause)
        nouns = [word for word in more if word.pos in ("NOUN", "PROPN", "PRON", "NUM")]
        if len(grown) + len(more) > LONGEST or (more[0].pos == "ADP" and (not nouns or nouns[-1].low in _EMPTY)):
            return
        if [word.index for word in more] != list(range(grown[-1].index + 1, grown[-1].index + 1 + len(more))):
            return
        grown = [*grown, *more]
        yield list(grown)


def _belongs(tree: Tree, word: Word, noun: Word) -> bool:
    while word.index != noun.index:
        if word.dep not in _LEFT:
            return False
        word = tree.head(word)
    return True


def _information(lexicon: Lexicon | None, phrase: Sequence[Word], before: set[str]) -> float:
    total = 0.0
    for word in phrase:
        if word.pos == "NUM":
            total += NUMBER
        if word.pos not in ("NOUN", "PROPN", "ADJ", "VERB", "ADV") or word.low in _EMPTY:
            continue
        count = max(lexicon.count(word.low), lexicon.count(word.lemma.lower())) if lexicon is not None else 0
        nats = min(UNKNOWN, -math.log(max(count, 1) / SUBTITLES))
        weight = KNOWN if word.low in before else 1.0
        total += max(0.0, nats - DULL) * weight * (1.0 if word.pos in ("NOUN", "PROPN", "ADJ") else 0.5)
    return total
