"""Repair common mistakes of the small pipelines in dependency trees: question tags, and nouns that must be verbs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ravestate.language.contractions import word_set

from .question_word import AUXILIARIES, QUESTION_WORDS
from .tree import SUBJECTS, Tree, Word

_NEGATIONS = ("n't", "not", "nt")
_BE = ("is", "are", "was", "were")
_INVERTING = word_set("do does did can could will would should")


def repaired(tree: Tree) -> Tree:
    """Return a tree of the same words, and replace relations that cannot be right."""
    words = list(tree.words)
    for word in tree.words:
        if word.low in AUXILIARIES:
            _mark_tag(tree, words, word)
            _make_verb(tree, words, word)
            _make_passive(tree, words, word)
            _make_copula(tree, words, word)
        _name_relative(tree, words, word)
    return tree if words == list(tree.words) else Tree(tree.text, words)


def is_tag(word: Word) -> bool:
    """Return whether a word of a repaired tree belongs to a question tag."""
    return word.dep == "punct" and word.low in AUXILIARIES


def tag_at(words: Sequence[Word], index: int) -> int:
    """Return the number of words of the question tag at `index`: 3 for *don't you*; 0 if there is none."""
    negated = index + 1 < len(words) and words[index + 1].low in _NEGATIONS
    end = index + 2 + negated
    ended = end <= len(words) and words[end - 1].pos == "PRON" and (end == len(words) or words[end].pos == "PUNCT")
    before = words[index - 1] if index else None
    if not ended or before is None or words[index].low not in AUXILIARIES or words[end - 1].low in QUESTION_WORDS:
        return 0
    apart = before.low == "," or (negated and before.pos not in ("CCONJ", "SCONJ", "PRON") and index > 1)
    return end - index if apart and words[index - 1 - (before.low == ",")].low not in QUESTION_WORDS else 0


def _mark_tag(tree: Tree, words: list[Word], word: Word) -> None:
    """Turn the words of a question tag into punctuation."""
    tag = range(word.index, word.index + tag_at(tree.words, word.index))
    for other in tree.words if tag else ():
        if other.index in tag:
            words[other.index] = replace(other, pos="PUNCT", dep="punct", head=other.index)
        elif other.head in tag:
            words[other.index] = replace(other, dep="ROOT", head=other.index)


def _make_verb(tree: Tree, words: list[Word], auxiliary: Word) -> None:
    """If a noun follows an auxiliary and a subject, make the noun a verb: *end*, in *did the war end*."""
    before = tree.before(auxiliary)
    if auxiliary.low not in _INVERTING or (
        before and before in tree.children(auxiliary, "nsubj") and before.pos in ("PRON", "NOUN", "PROPN")
    ):
        return
    after = tree.words[auxiliary.index + 1 :]
    nominal = ("DET", "PRON", "ADJ", "NOUN", "PROPN")
    place = next((number for number, word in enumerate(after) if word.pos not in nominal), len(after))
    place += after[place : place + 1] != () and after[place].pos == "VERB"
    if place < 2:
        return
    *_, subject, verb = after[:place]
    if subject.dep != "compound" or subject.head != verb.index or verb.pos not in ("NOUN", "VERB"):
        return
    if auxiliary.low == "do" and (place > 2 or subject.tag != "NNS"):
        return  # as in "do your math homework"
    if tree.children(verb, *SUBJECTS) or (verb.dep != "ROOT" and tree.head(verb) != auxiliary):
        return
    words[verb.index] = replace(verb, pos="VERB", tag="VB")
    _reroot(tree, words, auxiliary, verb, subject, "aux")


def _make_passive(tree: Tree, words: list[Word], be: Word) -> None:
    """Turn a participle after its noun into the verb: *eaten*, in *was the cake eaten by the dog*."""
    nouns = [word for word in tree.children(be, "nsubj", "attr") if word.index > be.index]
    for participle in tree.children_of(nouns, "acl"):
        if be.low in _BE and be.dep == "ROOT" and tree.children(participle, "agent"):
            _reroot(tree, words, be, participle, tree.head(participle), "auxpass")


def _make_copula(tree: Tree, words: list[Word], short: Word) -> None:
    """Turn *'s* into a verb if the sentence has no verb: *my name's Ada*, but not *my sister's car*."""
    owner = tree.head(short)
    named = tree.head(owner)
    if short.dep != "case" or owner.dep != "poss" or named.dep != "ROOT" or named.pos != "PROPN" or owner.pos != "NOUN":
        return
    if any(word.pos in ("VERB", "AUX") for word in tree.subtree(named)):
        return
    for word, dep, head in ((short, "ROOT", short), (owner, "nsubj", short), (named, "attr", short)):
        words[word.index] = replace(word, dep=dep, head=head.index, pos="AUX" if word == short else word.pos)


def _name_relative(tree: Tree, words: list[Word], noun: Word) -> None:
    """Join a noun to the name after it: *my mum*, in *my mum Ann sings*."""
    name = tree.after(noun)
    if noun.pos != "NOUN" or name is None or name.pos != "PROPN" or name.dep != "nsubj" or noun.head == name.index:
        return
    if tree.children(noun, "poss") and noun.dep != "nsubj" and name not in tree.children(noun):
        words[noun.index] = replace(noun, dep="compound", head=name.index)


def _reroot(tree: Tree, words: list[Word], auxiliary: Word, verb: Word, subject: Word, dep: str) -> None:
    """Make `verb` the head of its sentence, with an auxiliary and a subject."""
    for word in tree.words:
        if word == verb:
            words[word.index] = replace(words[word.index], dep="ROOT", head=word.index)
        elif word == auxiliary:
            words[word.index] = replace(word, pos="AUX", dep=dep, head=verb.index)
        elif word == subject:
            words[word.index] = replace(word, dep="nsubj" if dep == "aux" else "nsubjpass", head=verb.index)
        elif word.head == verb.index and auxiliary.index < word.index < subject.index:
            words[word.index] = replace(word, head=subject.index)
        elif word.head == auxiliary.index:
            words[word.index] = replace(word, head=verb.index)
