"""Verbs: their lemmas, the verbs that they govern, and their clauses."""

from __future__ import annotations

from .asking import QUESTION_WORDS
from .tree import Tree, Word
from .word_set import word_set

SUBJECTS = ("nsubj", "nsubjpass", "csubj", "csubjpass")
_HEADS = ("ROOT", "conj", "ccomp", "xcomp", "advcl", "relcl", "parataxis", "pcomp", "csubj", "dep", "acl")
VERBAL = ("VERB", "AUX")

PLACES = word_set("here there home abroad outside inside upstairs downstairs away everywhere nowhere somewhere")
_MOTION = word_set("come go travel fly drive run move stay")
"""Verbs with an infinitive of purpose, which is a separate action."""
_GERUND_TAKERS = word_set("like love hate enjoy prefer dislike start stop begin continue keep practise practice try")
NEGATIONS = frozenset(["not", "n't", "nt", "never"])
_BE = frozenset(["be", "am", "is", "are", "was", "were", "m", "s", "re", "'s", "'m", "'re"])
_MISTAKEN = word_set("like love play work live study dance swim paint cook")
"""Verbs that the tagger often mistakes."""
_SHORT = {"wan": "want", "gon": "go", "got": "get", "ca": "can", "wo": "will"}


def heads_clause(tree: Tree, word: Word) -> bool:
    """Return whether `word` is the verb of a clause."""
    if word.dep not in _HEADS:
        return False
    children = tree.children(word)
    has_subject = any(child.dep in SUBJECTS for child in children)
    if word.pos in VERBAL:
        if word.dep in ("acl", "pcomp", "csubj"):
            return has_subject
        if word.dep == "conj" and not has_subject and tree.head(word).pos not in (*VERBAL, "ADP", "SCONJ"):
            return False
        return bool(children) or word.dep in ("ROOT", "conj", "relcl", "xcomp")
    return has_subject and (any(child.dep == "aux" for child in children) or word.low in _MISTAKEN)


def lemma_of(verb: Word) -> str:
    """Return the verb's lemma, also for short forms: *'s*, *wanna*."""
    if verb.low in _BE:
        return "be"
    return _SHORT.get(verb.low, verb.lemma.lower())


def following_verb(tree: Tree, verb: Word) -> Word | None:
    """Return the verb that `verb` governs (*become* in *want to become*), or None."""
    if lemma_of(verb) == "be":
        return None
    for child in tree.children(verb, "xcomp"):
        if child.pos not in VERBAL or child.index < verb.index or tree.children(child, *SUBJECTS):
            continue
        infinitive = is_infinitive(tree, child)
        if infinitive and lemma_of(verb) in _MOTION and not makes_future(tree, verb):
            continue
        if child.tag not in ("VBG", "VB") and not infinitive:
            continue
        if any(w.low in QUESTION_WORDS and w.index > verb.index for w in tree.children(child)):  # learn how to cook
            continue
        between = [w for w in tree.words[verb.index + 1 : child.index] if w.head in (verb.index, child.index)]
        if not any(w.dep in ("dobj", "dative", "prep") or w.low in PLACES for w in between):
            return child
    if lemma_of(verb) in _GERUND_TAKERS:
        for child in tree.children(verb, "dobj", "pobj"):
            if child.low.endswith("ing") and child.index == verb.index + 1 and child.tag in ("NN", "VBG"):
                return child
    return None


def makes_future(tree: Tree, verb: Word) -> bool:
    """Return whether the verb is the *going* of a future, which counts as an auxiliary."""
    return verb.low in ("going", "gon") and any(
        lemma_of(aux) == "be" or verb.low == "gon" for aux in tree.children(verb, "aux") or [verb]
    )


def is_denied(tree: Tree, verb: Word) -> bool:
    """Return whether the verb itself has *not*."""
    return any(child.low in NEGATIONS for child in tree.children(verb, "neg"))


def is_infinitive(tree: Tree, verb: Word) -> bool:
    """Return whether the verb has *to*."""
    return any(child.low in ("to", "na") for child in tree.children(verb, "aux"))


def particles(tree: Tree, verb: Word) -> list[str]:
    """Return the verb's particles: *up* of *get up*."""
    return [
        child.low
        for child in tree.children(verb, "prt", "advmod")
        if child.dep == "prt" or (child.low == "back" and child.index == verb.index + 1)
    ]
