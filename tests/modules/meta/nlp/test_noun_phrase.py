"""What is kept of a phrase."""

import pytest

from modules.meta.nlp.sentences import words
from ravestate.modules.meta.nlp.noun_phrase import adjective_phrase, gerund_phrase, noun_phrase
from ravestate.modules.meta.nlp.tree import Tree


@pytest.mark.parametrize(
    ("notation", "head", "kept"),
    [
        ("the/DET/det>2 red/ADJ/amod>2 car/NOUN/ROOT>2", 2, "red car"),
        ("this/PRON/ROOT>0", 0, "this"),
        ("my/PRON/poss>1 friend/NOUN/ROOT>1 Anna/PROPN/appos>1", 1, "my friend Anna"),
        ("my/PRON/poss>1 boss/NOUN/ROOT>1 ,/PUNCT/punct>1 Anna/PROPN/appos>1", 1, "my boss"),
        ("a/DET/det>3 very/ADV/advmod>2 big/ADJ/amod>3 house/NOUN/ROOT>3", 3, "big house"),
        (
            "the/DET/det>1 capital/NOUN/ROOT>1 of/ADP/prep>1 the/DET/det>4 land/NOUN/pobj>2",
            1,
            "capital of land",
        ),
        ("the/DET/det>1 book/NOUN/ROOT>1 on/ADP/prep>1 tables/NOUN/pobj>2", 1, "book"),
        ("two/NUM/nummod>1 dogs/NOUN/ROOT>1 I/PRON/nsubj>3 saw/VERB/relcl>1", 1, "two dogs"),
        ("old/ADJ/amod>3 and/CCONJ/cc>0 wise/ADJ/conj>0 man/NOUN/ROOT>3", 3, "old and wise man"),
        ("No/DET/det>1 one/NOUN/nsubj>1", 1, "No one"),
    ],
)
def test_noun_phrases(notation: str, head: int, kept: str) -> None:
    tree = Tree("", words(notation))
    assert tree.phrase(noun_phrase(tree, tree.words[head])) == kept


def test_an_adjective_keeps_what_follows_it_directly_and_its_measure() -> None:
    tree = Tree(
        "",
        words("is/AUX/ROOT>0 good/ADJ/acomp>0 at/ADP/prep>0 chess/NOUN/pobj>2 in/ADP/prep>0 May/NOUN/pobj>4"),
    )
    assert tree.phrase(adjective_phrase(tree, tree.words[1], tree.words[0])) == "good at chess"
    tree = Tree("", words("is/AUX/ROOT>0 20/NUM/nummod>2 years/NOUN/npadvmod>3 old/ADJ/acomp>0"))
    assert tree.phrase(adjective_phrase(tree, tree.words[3], tree.words[0])) == "20 years old"


def test_a_gerund_keeps_all_but_determiners() -> None:
    tree = Tree("", words("playing/VERB/csubj>3 the/DET/det>2 guitar/NOUN/dobj>0 is/AUX/ROOT>3"))
    assert tree.phrase(gerund_phrase(tree, tree.words[0])) == "playing guitar"
