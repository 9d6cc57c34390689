"""Each repair mends its own case, and leaves a right tree as it is."""

import pytest

from modules.meta.nlp.sentences import words
from ravestate.modules.meta.nlp.repair import repaired

CASES = {
    "gerund": (
        "I/PRON:PRP/nsubj>2 enjoy/AUX:VBP/aux>2 cooking/VERB:VBG/ROOT>2",
        "I/nsubj>1 enjoy/ROOT>1 cooking/xcomp>1",
    ),
    "called": (
        "what/PRON:WP/attr>1 is/AUX:VBZ/csubjpass>4 your/PRON:PRP$/poss>3 dog/NOUN:NN/nsubj>4 called/VERB:VBN/ROOT>4",
        "what/oprd>4 is/auxpass>4 your/poss>3 dog/nsubjpass>4 called/ROOT>4",
    ),
    "passive question": (
        "Was/AUX:VBD/ROOT>0 it/PRON:PRP/nsubj>0 eaten/VERB:VBN/acl>1 by/ADP:IN/agent>2 him/PRON:PRP/pobj>3",
        "Was/auxpass>2 it/nsubjpass>2 eaten/ROOT>2 by/agent>2 him/pobj>3",
    ),
    "noun for verb": (
        "She/PRON/nsubj>1 plays/VERB:VBZ/ROOT>1 piano/NOUN:NN/dobj>1 and/CCONJ/cc>2 sings/NOUN:NNS/conj>2",
        "She/nsubj>1 plays/ROOT>1 piano/dobj>1 and/cc>2 sings/conj>1",
    ),
    "noun for infinitive": (
        "I/PRON/nsubj>1 drive/VERB:VBP/ROOT>1 to/AUX:IN/aux>3 work/NOUN:NN/xcomp>1",
        "I/nsubj>1 drive/ROOT>1 to/prep>1 work/pobj>2",
    ),
    "name": (
        "My/PRON/poss>1 name/NOUN:NN/poss>3 's/PART:POS/case>1 Ada/PROPN:NNP/ROOT>3",
        "My/poss>1 name/nsubj>2 's/ROOT>2 Ada/attr>2",
    ),
    "beside": (
        "I/PRON/nsubj>1 live/VERB:VBP/ROOT>1 next/ADV:RB/advmod>1 to/ADP:IN/prep>2 Bo/PROPN:NNP/pobj>3",
        "I/nsubj>1 live/ROOT>1 next/advmod>1 to/prep>1 Bo/pobj>3",
    ),
    "adjective for noun": (
        "are/AUX:VBP/ROOT>0 robots/NOUN:NNS/nsubj>0 nice/ADJ:JJ/amod>1",
        "are/ROOT>0 robots/nsubj>0 nice/acomp>0",
    ),
    "noun after do": (
        "When/SCONJ:WRB/advmod>4 did/AUX:VBD/aux>4 the/DET:DT/det>4 war/NOUN:NN/compound>4 end/NOUN:NN/ROOT>4",
        "When/advmod>4 did/aux>4 the/det>3 war/nsubj>4 end/ROOT>4",
    ),
    "verb of adjective": (
        "why/SCONJ:WRB/advmod>3 is/AUX:VBZ/aux>3 it/PRON:PRP/nsubj>3 blue/ADJ:JJ/ROOT>3",
        "why/advmod>1 is/ROOT>1 it/nsubj>1 blue/acomp>1",
    ),
    "fronted": (
        "in/ADP:IN/prep>5 which/DET:WDT/det>2 town/NOUN:NN/nsubjpass>5 are/AUX/auxpass>5 you/PRON/nsubj>5 born/VERB/ROOT>5",
        "in/prep>5 which/det>2 town/pobj>0 are/auxpass>5 you/nsubj>5 born/ROOT>5",
    ),
    "name in one phrase": (
        "is/AUX:VBZ/ROOT>0 your/PRON/poss>3 name/NOUN:NN/compound>3 tom/NOUN:NN/nsubj>0",
        "is/ROOT>0 your/poss>2 name/nsubj>0 tom/attr>0",
    ),
    "name in apposition": (
        "is/AUX:VBZ/ROOT>0 rome/PROPN/attr>0 the/DET/det>3 capital/NOUN/appos>1",
        "is/ROOT>0 rome/nsubj>0 the/det>3 capital/attr>0",
    ),
    "place for infinitive": (
        "been/AUX:VBN/ROOT>0 to/PART:TO/aux>2 rome/VERB:VB/xcomp>0",
        "been/ROOT>0 to/prep>0 rome/pobj>1",
    ),
    "noun after relative": (
        "woman/NOUN:NN/ROOT>0 I/PRON:PRP/nsubj>2 love/VERB:VBP/relcl>0 lives/NOUN:NNS/dobj>2 here/ADV/advmod>3",
        "woman/nsubj>3 I/nsubj>2 love/relcl>0 lives/ROOT>3 here/advmod>3",
    ),
    "verb of noun": (
        "what/PRON:WP/attr>1 is/AUX:VBZ/aux>2 love/NOUN:NN/ROOT>2",
        "what/attr>1 is/ROOT>1 love/nsubj>1",
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_repairs(case: str) -> None:
    wrong, right = CASES[case]
    once = repaired(words(wrong))
    assert " ".join(f"{word.text}/{word.dep}>{word.head}" for word in once) == right
    assert repaired(once) == once


@pytest.mark.parametrize(
    "notation",
    [
        "",
        "She/PRON/nsubj>1 sells/VERB:VBZ/ROOT>1 songs/NOUN:NNS/dobj>1 and/CCONJ/cc>2 books/NOUN:NNS/conj>2",
        "My/PRON/poss>1 name/NOUN:NN/nsubj>2 is/AUX:VBZ/ROOT>2 Ada/PROPN:NNP/attr>2",
        "nice/ADJ:JJ/amod>1 robots/NOUN:NNS/nsubj>2 are/AUX:VBP/ROOT>2 here/ADV:RB/advmod>2",
        "It/PRON/nsubj>2 is/AUX:VBZ/aux>2 raining/VERB:VBG/ROOT>2",
    ],
)
def test_what_is_right_stays(notation: str) -> None:
    assert repaired(words(notation)) == words(notation)
