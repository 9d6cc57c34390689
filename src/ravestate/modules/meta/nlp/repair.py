"""Correct systematic errors of the pipeline in short sentences. The docstring of each repair shows an example.

A repair recognises the error by words and labels, and changes the tree. It leaves correct trees alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from .tree import Word
from .word_set import word_set

_BE = word_set("am is are was were 's")
_GERUND_TAKERS = word_set(
    "enjoy like love hate prefer dislike enjoyed liked loved hated preferred enjoys likes loves hates"
)
_SAID_OF_ONE = word_set("sings swims reads writes sleeps laughs cries paints dances barks")
_BESIDE = word_set("next close near far")


def repaired(words: list[Word]) -> list[Word]:
    """Return `words` with a corrected tree."""
    tree = _Draft(words)
    for word in words:
        for repair in (
            _gerund,
            _called,
            _passive_question,
            _noun_for_verb,
            _noun_for_infinitive,
            _names,
            _beside,
            _adjective_for_noun,
            _noun_after_do,
            _verb_of_noun,
            _fronted,
            _name_question,
            _place_for_infinitive,
            _noun_after_relative,
        ):
            repair(tree, tree.words[word.index])
    return tree.words


class _Draft:
    """A tree under correction."""

    def __init__(self, words: list[Word]) -> None:
        self.words = list(words)

    def children(self, head: Word, *deps: str) -> Iterator[Word]:
        for word in self.words:
            if word.head == head.index and word.index != head.index and (not deps or word.dep in deps):
                yield word

    def change(
        self, word: Word, *, dep: str = "", head: int = -1, pos: str = "", tag: str = "", lemma: str = ""
    ) -> None:
        now = self.words[word.index]
        self.words[word.index] = replace(
            now,
            dep=dep or now.dep,
            head=head if head >= 0 else now.head,
            pos=pos or now.pos,
            tag=tag or now.tag,
            lemma=lemma or now.lemma,
        )

    def promote(self, word: Word, over: Word, dep: str) -> None:
        """Swap `word` with its head `over`: `over` becomes its dependent by `dep`, without dependents of its own."""
        self.change(word, dep=over.dep, head=word.index if over.head == over.index else over.head)
        for child in list(self.children(over)):
            self.change(child, head=word.index)
        self.change(over, dep=dep, head=word.index)


def _gerund(tree: _Draft, word: Word) -> None:
    """Correct *enjoy* in *I enjoy cooking*: not an auxiliary of *cooking*."""
    if word.dep == "aux" and word.low in _GERUND_TAKERS and tree.words[word.head].tag == "VBG":
        gerund = tree.words[word.head]
        own = [child for child in tree.children(gerund) if child.index > gerund.index and child.pos != "PUNCT"]
        tree.change(word, pos="VERB")
        tree.promote(word, gerund, "xcomp")
        for child in own:
            tree.change(child, head=gerund.index)


def _called(tree: _Draft, word: Word) -> None:
    """Correct *what is* in *what is your dog called*: not the subject."""
    if word.low in _BE and word.dep in ("csubjpass", "csubj"):
        verb = tree.words[word.head]
        for child in list(tree.children(word)):
            tree.change(child, head=verb.index, dep="oprd" if child.tag in ("WP", "WDT", "WRB") else child.dep)
        for child in tree.children(verb, "nsubj"):
            tree.change(child, dep="nsubjpass")
        tree.change(word, dep="auxpass", pos="AUX")


def _passive_question(tree: _Draft, word: Word) -> None:
    """Correct *eaten* in *was the cake eaten by the dog*: not a modifier of *cake*."""
    if word.low not in _BE or word.dep != "ROOT":
        return
    for subject in tree.children(word, "nsubj", "attr"):
        if subject.index < word.index or any(
            w.pos in ("NOUN", "ADJ", "PRON") and w.dep in ("attr", "acomp") and w.tag not in ("WP", "WRB")
            for w in tree.children(word)
            if w.index != subject.index
        ):
            continue
        for verb in tree.children(subject, "acl"):
            if verb.tag == "VBN":
                tree.change(subject, dep="nsubjpass")
                tree.change(verb, dep="ROOT", head=verb.index)
                for child in list(tree.children(word)):
                    tree.change(child, head=verb.index)
                tree.change(word, dep="auxpass", head=verb.index)
                for by in tree.children(verb, "agent"):
                    for asked in tree.children(verb, "attr"):  # who was it written by
                        tree.change(asked, dep="pobj", head=by.index)
                return


def _noun_for_verb(tree: _Draft, word: Word) -> None:
    """Correct the second verb of *she plays the piano and sings*: not a noun."""
    if (
        word.dep != "conj"
        or word.pos not in ("NOUN", "PROPN")
        or any(tree.children(word, "det", "amod", "poss", "compound"))
    ):
        return
    before = tree.words[word.index - 1]
    head = tree.words[word.head]
    if before.low == "nor" and head.pos == "VERB":
        tree.change(word, pos="VERB", tag=head.tag)
    elif before.low == "and" and word.low in _SAID_OF_ONE and head.dep == "dobj":
        verb = tree.words[head.head]
        if verb.tag == "VBZ":
            tree.change(word, pos="VERB", tag="VBZ", head=verb.index)


def _noun_for_infinitive(tree: _Draft, word: Word) -> None:
    """Correct *work* in *I drive to work*: not an infinitive."""
    if word.dep == "xcomp" and word.pos == "NOUN":
        for to in tree.children(word, "aux"):
            if to.low == "to":
                tree.change(to, dep="prep", head=word.head, pos="ADP")
                tree.change(word, dep="pobj", head=to.index)
                return


def _names(tree: _Draft, word: Word) -> None:
    """Correct *my name's* in *my name's Ada*: not a possessive."""
    after = tree.words[word.index + 1] if word.index + 1 < len(tree.words) else None
    if word.low == "name" and word.dep == "poss" and after is not None and after.low == "'s":
        owner = tree.words[word.head]
        tree.promote(after, owner, "attr")
        tree.change(after, pos="AUX", tag="VBZ", lemma="be")
        tree.change(word, dep="nsubj", head=after.index)


def _beside(tree: _Draft, word: Word) -> None:
    """Correct *next to* in *I live next to the station*: one preposition."""
    if word.low in _BESIDE and word.dep == "advmod" and tree.words[word.head].pos in ("VERB", "AUX"):
        for preposition in tree.children(word, "prep"):
            tree.change(preposition, head=word.head)


def _adjective_for_noun(tree: _Draft, word: Word) -> None:
    """Correct *dangerous* in *are robots dangerous*: not a modifier of *robots*."""
    if word.pos != "ADJ" or word.dep not in ("amod", "advmod"):
        return
    noun = tree.words[word.head]
    verb = tree.words[noun.head]
    if noun.index == word.index - 1 and noun.dep in ("nsubj", "attr") and verb.low in _BE and verb.index < noun.index:
        tree.change(word, dep="acomp", head=verb.index)
        tree.change(noun, dep="nsubj")


def _noun_after_do(tree: _Draft, word: Word) -> None:
    """Correct *war end* in *when did the war end*: not a compound noun."""
    if word.pos != "NOUN" or not any(aux.low in ("do", "does", "did") for aux in tree.children(word, "aux")):
        return
    for subject in tree.children(word, "compound", "nmod"):
        if subject.index == word.index - 1:
            for child in list(tree.children(word, "det", "poss", "amod")):
                tree.change(child, head=subject.index)
            tree.change(subject, dep="nsubj")
            tree.change(word, pos="VERB", tag="VB")
            return


def _verb_of_noun(tree: _Draft, word: Word) -> None:
    """Correct *is* in *what is love* and *why is the sky blue*: not an auxiliary of the last word."""
    last = tree.words[word.head]
    if word.dep == "aux" and word.low in _BE and last.pos in ("NOUN", "PROPN", "ADJ") and last.index > word.index:
        own = [
            child
            for child in tree.children(last)
            if child.index > word.index and child.pos != "PUNCT" and child.dep != "nsubj"
        ]
        tree.promote(word, last, "acomp" if last.pos == "ADJ" else "nsubj")
        for child in own:
            tree.change(child, head=last.index)


def _fronted(tree: _Draft, word: Word) -> None:
    """Correct *which country* in *in which country were you born*: not a second subject."""
    if word.dep != "prep" or any(tree.children(word)):
        return
    for noun in tree.children(tree.words[word.head], "nsubj", "nsubjpass", "dobj"):
        asked = (
            noun
            if noun.tag in ("WP", "WDT")
            else next((w for w in tree.children(noun) if w.tag in ("WP", "WDT")), None)
        )
        if asked is not None and asked.index == word.index + 1:
            tree.change(noun, dep="pobj", head=word.index)


def _name_question(tree: _Draft, word: Word) -> None:
    """Separate the two noun phrases of *is your name tom* and *is berlin the capital*."""
    be = tree.words[word.head]
    if word.dep not in ("nsubj", "attr") or be.low not in _BE or be.index > word.index:
        return
    if any(w.dep in ("nsubj", "attr", "acomp") and w.index != word.index for w in tree.children(be)):
        return
    for name in tree.children(word, "compound"):
        if name.low == "name" and name.index == word.index - 1:
            for child in list(tree.children(word, "poss")):
                tree.change(child, head=name.index)
            tree.change(name, dep="nsubj", head=be.index)
            tree.change(word, dep="attr")
            return
    for other in tree.children(word, "appos"):
        tree.change(other, dep="attr", head=be.index)
        tree.change(word, dep="nsubj")
        return


def _place_for_infinitive(tree: _Draft, word: Word) -> None:
    """Correct *to rome* in *have you ever been to rome*: not an infinitive."""
    if (
        word.dep == "xcomp"
        and tree.words[word.head].low == "been"
        and not any(tree.children(word, "dobj", "prep", "advmod"))
    ):
        for to in tree.children(word, "aux"):
            if to.low == "to" and to.index == word.index - 1:
                tree.change(to, dep="prep", head=word.head, pos="ADP")
                tree.change(word, dep="pobj", head=to.index, pos="PROPN")
                return


def _noun_after_relative(tree: _Draft, word: Word) -> None:
    """Correct *lives* in *the woman that I love lives in Rome*: not the object of *love*."""
    relative = tree.words[word.head]
    noun = tree.words[relative.head]
    if word.tag != "NNS" or word.dep != "dobj" or relative.dep != "relcl" or noun.dep != "ROOT":
        return
    if word.index == relative.index + 1 and not any(tree.children(word, "det", "amod", "poss", "nummod")):
        tree.change(word, dep="ROOT", head=word.index, pos="VERB", tag="VBZ", lemma=word.low.removesuffix("s"))
        tree.change(noun, dep="nsubj", head=word.index)
