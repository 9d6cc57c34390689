"""Functions about a verb: its lemma, the verbs that it governs, its particles, and whether it heads a clause."""

from __future__ import annotations

from ravestate.language.contractions import word_set

from .question_word import QUESTION_WORDS
from .tree import SUBJECTS, Tree, Word

VERBAL = ("VERB", "AUX")
NEGATIONS = frozenset(["not", "n't", "nt", "never"])
PLACES = word_set("here there home abroad outside inside upstairs downstairs away everywhere nowhere somewhere")
_HEADS = ("ROOT", "conj", "ccomp", "xcomp", "advcl", "relcl", "parataxis", "pcomp", "csubj", "dep", "acl")
CONTACT = word_set("call phone ring text email visit meet contact write use")
"""Verbs whose object is not the subject of a following infinitive: in *I called him to say hello*, the speaker
says hello."""
SETTLING = word_set("sit stand lie get wake come go grow calm hurry slow run walk")
"""Verbs of posture and motion. They share no object with the verb after *and*: *sit down and read a book*."""
FEELINGS = word_set(
    "interested tired bored married divorced scared excited worried surprised pleased disappointed confused retired "
    "annoyed satisfied",
)
"""Participles of feelings and states, which count as adjectives."""
PURSUITS = word_set("hobby job passion dream goal plan interest pastime task habit")
"""Subjects that a gerund may name: *my hobby is reading*."""
STATES = word_set("better worse well fine good bad great ok okay awful hard alone")
"""Adjectives that the tagger mistakes for adverbs."""
OWN_STATES = word_set("live like love hate want need miss hope prefer know understand work study own")
"""Verbs of states. They make no requests: *live in Rome* stands for *I live in Rome*."""
_MOTION = word_set("come go travel fly drive run move stay")
"""Verbs after which an infinitive states a purpose, which is a second action: *come to help*."""
_GERUND_TAKERS = word_set("like love hate enjoy prefer dislike start stop begin continue keep practise practice try")
_PARTICLES = word_set("back out off forward")
_BE = frozenset(["be", "am", "is", "are", "was", "were", "m", "s", "re", "'s", "'m", "'re"])
_SHORT = {
    "wan": "want",
    "gon": "go",
    "got": "get",
    "ca": "can",
    "wo": "will",
    "forgot": "forget",
    "getting": "get",
    "hates": "hate",
}


def heads_clause(tree: Tree, word: Word) -> bool:
    """Return whether `word` heads a clause.

    Most such words are verbs. The others are predicates whose *be* is missing, or is tagged as an auxiliary.
    """
    if word.dep not in _HEADS:
        return False
    if word.pos not in VERBAL:
        return lacks_copula(tree, word) or bool(tree.children(word, *SUBJECTS) and tree.children(word, "aux"))
    if word.dep in ("acl", "pcomp", "csubj"):
        return bool(tree.children(word, *SUBJECTS))
    if word.dep == "conj" and not tree.children(word, *SUBJECTS):
        return tree.head(word).pos in (*VERBAL, "ADP", "SCONJ") or bool(tree.children(word, "dobj"))
    return bool(tree.children(word)) or word.dep in ("ROOT", "conj", "relcl", "xcomp")


def lacks_copula(tree: Tree, word: Word) -> bool:
    """Return whether `word` is a predicate without *be*: *nice* in *she very nice*."""
    if word.dep != "ROOT" or word.pos in VERBAL or tree.children(word, "aux", "cop"):
        return False
    return any(child.index < word.index for child in tree.children(word, "nsubj"))


def lemma_of(verb: Word) -> str:
    """Return the verb's lemma, also for short forms: *'s*, *wanna*."""
    return "be" if verb.low in _BE else _SHORT.get(verb.low, verb.lemma.lower())


def chain_of(tree: Tree, verb: Word) -> list[Word]:
    """Return `verb` with the verbs that it governs: *want to become*."""
    chain = [verb]
    if mistaken := [
        word for word in tree.children(verb, "aux") if lemma_of(word) in _GERUND_TAKERS and verb.tag == "VBG"
    ]:
        return mistaken + chain  # as in "I enjoy cooking"
    if lemma_of(verb) == "be":  # as in "it's raining"
        return next((chain_of(tree, child) for child in tree.children(verb, "xcomp") if child.tag == "VBG"), chain)
    while (following := _following(tree, chain[-1])) is not None:
        chain.append(following)
    return chain[1:] if len(chain) > 1 and makes_future(tree, verb) else chain


def _following(tree: Tree, verb: Word) -> Word | None:
    for child in tree.children(verb, "xcomp"):
        infinitive = is_infinitive(tree, child)
        purpose = infinitive and lemma_of(verb) in _MOTION and not makes_future(tree, verb)
        asked = any(word.low in QUESTION_WORDS and word.index > verb.index for word in tree.children(child))
        if child.pos not in VERBAL or child.index < verb.index or tree.children(child, *SUBJECTS) or purpose or asked:
            continue
        between = [word for word in tree.words[verb.index + 1 : child.index] if word.head in (verb.index, child.index)]
        other = any(word.dep in ("dobj", "dative", "prep") or word.low in PLACES for word in between)
        if (infinitive or child.tag in ("VBG", "VB")) and not other:
            return child
    for child in tree.children(verb, "dobj", "pobj"):
        listed = child.tag == "NN" and not all(word.low.endswith("ing") for word in tree.children(child, "conj"))
        if listed:  # as in "I like swimming and tennis"
            continue
        if lemma_of(verb) in _GERUND_TAKERS and child.low.endswith("ing") and child.index == verb.index + 1:
            return child if child.tag in ("NN", "VBG") else None
    return None


def makes_future(tree: Tree, verb: Word) -> bool:
    """Return whether the verb is the *going* of *going to visit*, which counts as an auxiliary of the future."""
    auxiliaries = tree.children(verb, "aux")
    bare = verb.dep == "ROOT" and not auxiliaries  # as in "what you going to do"
    return verb.low == "gon" or (verb.low == "going" and (bare or any(lemma_of(aux) == "be" for aux in auxiliaries)))


def is_infinitive(tree: Tree, verb: Word) -> bool:
    """Return whether *to* stands before the verb, also in *wanna* and *gonna*."""
    return any(child.low in ("to", "na") for child in tree.children(verb, "aux"))


def with_particles(tree: Tree, verb: Word, written: str) -> str:
    """Return `written` with the verb's particles: *get up*."""
    found = [word for word in tree.children(verb, "prt", "advmod") if word.dep == "prt" or word.index == verb.index + 1]
    return " ".join(
        [written, *(word.low for word in found if word.dep == "prt" or (word.low in _PARTICLES and written != "be"))]
    )
