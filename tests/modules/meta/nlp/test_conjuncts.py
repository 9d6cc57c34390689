"""Joined phrases."""

from modules.meta.nlp.sentences import words
from ravestate.modules.meta.nlp.conjuncts import conjuncts, denies_conjunct, is_contrasted
from ravestate.modules.meta.nlp.tree import Tree

# I like tea but not coffee and sing
TREE = Tree(
    "",
    words(
        "I/PRON/nsubj>1 like/VERB/ROOT>1 tea/NOUN/dobj>1 but/CCONJ/cc>2 not/PART/neg>5 coffee/NOUN/conj>2 "
        "and/CCONJ/cc>1 sing/VERB/conj>1"
    ),
)
CLAUSES = {1, 7}


def test_conjuncts_are_followed_but_for_clauses() -> None:
    assert [word.text for word in conjuncts(TREE, TREE.words[2], CLAUSES)] == ["tea", "coffee"]
    assert [word.text for word in conjuncts(TREE, TREE.words[1], CLAUSES)] == ["like"]


def test_not_may_deny_one_alone() -> None:
    assert denies_conjunct(TREE, TREE.words[4], CLAUSES)
    assert is_contrasted(TREE, TREE.words[5], CLAUSES)
    assert not is_contrasted(TREE, TREE.words[2], CLAUSES)


def test_not_at_the_verb_denies_all() -> None:
    tree = Tree("", words("do/AUX/aux>2 not/PART/neg>2 like/VERB/ROOT>2 tea/NOUN/dobj>2"))
    assert not denies_conjunct(tree, tree.words[1], {2})
