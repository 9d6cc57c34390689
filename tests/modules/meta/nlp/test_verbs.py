"""Verbs by themselves."""

import pytest

from modules.meta.nlp.sentences import words
from ravestate.modules.meta.nlp.tree import Tree
from ravestate.modules.meta.nlp.verbs import (
    following_verb,
    heads_clause,
    is_denied,
    lemma_of,
    makes_future,
    particles,
)


@pytest.mark.parametrize(
    ("notation", "lemma"), [("'s/AUX/x>0", "be"), ("wan/VERB/x>0", "want"), ("Go/VERB/x>0", "go")]
)
def test_lemmas(notation: str, lemma: str) -> None:
    assert lemma_of(words(notation)[0]) == lemma


@pytest.mark.parametrize(
    ("notation", "following"),
    [
        ("want/VERB/ROOT>0 to/PART/aux>2 swim/VERB:VB/xcomp>0", "swim"),
        ("like/VERB/ROOT>0 swimming/NOUN:NN/dobj>0", "swimming"),
        ("like/VERB/ROOT>0 building/VERB:VBG/xcomp>0", "building"),
        ("see/VERB/ROOT>0 buildings/NOUN:NNS/dobj>0", None),
        ("come/VERB/ROOT>0 to/PART/aux>2 swim/VERB:VB/xcomp>0", None),
        ("ask/VERB/ROOT>0 him/PRON/dobj>0 to/PART/aux>3 swim/VERB:VB/xcomp>0", None),
        ("learn/VERB/ROOT>0 how/SCONJ/advmod>3 to/PART/aux>3 swim/VERB:VB/xcomp>0", None),
        ("want/VERB/ROOT>0 you/PRON/nsubj>3 to/PART/aux>3 swim/VERB:VB/xcomp>0", None),
    ],
)
def test_chains(notation: str, following: str | None) -> None:
    tree = Tree("", words(notation))
    found = following_verb(tree, tree.words[0])
    assert (found.text if found else None) == following


def test_going_to_makes_the_future() -> None:
    tree = Tree("", words("am/AUX/aux>1 going/VERB:VBG/ROOT>1 to/PART/aux>3 swim/VERB:VB/xcomp>1"))
    assert makes_future(tree, tree.words[1]) and not makes_future(tree, tree.words[3])


def test_particles_and_denials() -> None:
    tree = Tree("", words("not/PART/neg>1 go/VERB/ROOT>1 back/ADV/advmod>1 up/ADP/prt>1"))
    assert particles(tree, tree.words[1]) == ["back", "up"]
    assert is_denied(tree, tree.words[1])


def test_nouns_and_participles_head_no_clause() -> None:
    tree = Tree("", words("man/NOUN/ROOT>0 sitting/VERB:VBG/acl>0 there/ADV/advmod>1"))
    assert not any(heads_clause(tree, word) for word in tree.words)
