"""Laws of the repair of parse trees. The sets of nlp in `tests/quality` measure how many clauses are read right."""

from itertools import islice

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from ravestate.modules.meta.nlp import QuestionWord
from ravestate.modules.meta.nlp.contrast import contrasts_of
from ravestate.modules.meta.nlp.inquiry import question_of
from ravestate.modules.meta.nlp.pipeline import Pipeline, pipeline
from ravestate.modules.meta.nlp.repair import repaired, tag_at
from ravestate.modules.meta.nlp.statements import statements_of, triples_of
from ravestate.modules.meta.nlp.tree import Tree, Word

WORDS = [
    "not", "but", ",", ".", "no", "and", "I", "my", "sister", "Tom", "Leeds", "live", "in", "is", "isn't", "a", "dog", "tall", "that", "of",
]  # fmt: skip


def triples(reader: Pipeline, text: str) -> str:
    return " ".join(map(str, triples_of(reader.read(text)[0])))


def test_homework_after_do_is_read_as_a_noun(reader: Pipeline) -> None:
    assert triples(reader, "do your math homework").startswith("(you, do,")


@given(
    st.sampled_from(["You like tea", "It is late", "She can sing", "They live in Rome"]),
    st.sampled_from([", isn't it?", " cant you", ", don't they?"]),
)
@settings(max_examples=16)
def test_a_question_tag_turns_a_statement_into_a_question_and_adds_no_triple(text: str, tag: str) -> None:
    tree, _ = pipeline("").read(text + tag)
    (plain,), (tagged,) = statements_of(pipeline("").read(text)[0]), statements_of(tree)
    assert question_of(tree.text) is QuestionWord.YES_NO
    assert tagged.triple == plain.triple
    assert tagged.question and not tagged.negated


def test_a_correct_tree_stays_as_it_is(reader: Pipeline) -> None:
    tree, _ = reader.read("My sister lives in Rome.")
    assert repaired(tree) is tree
    assert not any(tag_at(tree.words, word.index) for word in tree.words)


def test_a_noun_with_a_capital_inside_a_sentence_is_a_name(reader: Pipeline) -> None:
    (statement,) = statements_of(reader.read("my girlfriend Chiara bakes wonderful cakes")[0])
    assert statement.subject.names == ("Chiara",) and statement.subject.head == "girlfriend"


@pytest.mark.parametrize(
    "frame",
    [
        "I live in {}, not in {}",
        "I don't live in {1} but in {0}",
        "I live not in {1} but in {0}",
        "i live in {} not {}",
    ],
)
@pytest.mark.parametrize(("right", "wrong"), [("Turin", "Bern"), ("Leeds", "New York"), ("Rome", "Leeds")])
def test_a_contrast_asserts_one_phrase_and_denies_only_the_other(frame: str, right: str, wrong: str) -> None:
    held, denied = statements_of(pipeline("").read(frame.format(right, wrong))[0])
    assert (held.triple.object, denied.triple.object) == (right, wrong)
    assert held.holds and denied.negated


def test_a_statement_has_no_phrase_that_its_contrast_excludes(reader: Pipeline) -> None:
    turin, bern = statements_of(reader.read("I live in Turin, not in Bern")[0])
    assert [phrase.text for phrase in turin.phrases] == ["Turin"]
    assert [phrase.text for phrase in bern.phrases] == ["Bern"]
    assert turin.holds and bern.negated


@pytest.mark.parametrize(
    "frame", ["{}, not {}", "{} not {}", "not {1}, {0}", "not {1} but {0}", "i said {} not {}", "it's {}, not {}"]
)
@pytest.mark.parametrize(("right", "wrong"), [("Turin", "Bern"), ("turin", "leeds"), ("Ada", "Ida")])
def test_contrasts_are_found_in_texts_without_a_verb_as_well(
    frame: str, right: str, wrong: str, reader: Pipeline
) -> None:
    (found,) = contrasts_of(repaired(reader.read(frame.format(right, wrong))[0]))
    assert (found.right.text, found.wrong.text) == (right, wrong)


@given(st.lists(st.sampled_from(WORDS)))
@example(["dog", ","]).via("a comma with nothing after it")
@example(["that", "'s", "misty", "outside", ",", "not", "sunny"]).via("once a tree with a circle")
@example(["My", "late", "husband", "Walter", "always", "swore", "by", "cabbage", "leaves", "."]).via(
    "once a tree with a circle"
)
@settings(max_examples=200, deadline=None)
def test_every_word_of_a_repaired_tree_leads_to_a_root(words: list[str]) -> None:
    tree = repaired(pipeline("").read(" ".join(words))[0])
    for word in tree.words:
        above = [word, *islice(tree.ancestors(word), len(tree.words))]
        assert above[-1].head == above[-1].index
    contrasts_of(tree)


DEPS = [
    "nsubj",
    "dobj",
    "relcl",
    "ccomp",
    "poss",
    "compound",
    "acl",
    "attr",
    "advmod",
    "appos",
    "conj",
    "pobj",
    "aux",
    "acomp",
    "xcomp",
    "mark",
]
TAGS = [
    "NOUN NN",
    "PROPN NNP",
    "VERB VBD",
    "VERB VB",
    "AUX VBZ",
    "ADJ JJ",
    "PRON PRP",
    "PRON WP",
    "DET WDT",
    "CCONJ CC",
]


@st.composite
def trees(draw: st.DrawFn) -> Tree:
    """Draw a tree of random words with random labels and heads."""
    texts = draw(
        st.lists(
            st.sampled_from([*WORDS, "Ann", "husband", "work", "who", "me", "did", "were"]), min_size=1, max_size=9
        )
    )
    order = draw(st.permutations(range(len(texts))))
    words: list[Word] = []
    for place, text in zip(order, texts, strict=True):  # a head comes earlier in the order, so there is no circle
        above = [index for index, other in enumerate(order) if other < place]
        head = draw(st.sampled_from(above)) if above else len(words)
        dep = draw(st.sampled_from(DEPS)) if above else "ROOT"
        pos, tag = draw(st.sampled_from(TAGS)).split()
        words.append(Word(len(words), text, text.lower(), pos, tag, dep, head, 8 * len(words)))
    return Tree(" ".join(f"{text:7}" for text in texts), words)


@given(trees())
@settings(max_examples=500, deadline=None)
def test_no_repair_makes_a_circle_whatever_the_labels(tree: Tree) -> None:
    mended = repaired(tree)
    for word in mended.words:
        above = [word, *islice(mended.ancestors(word), len(mended.words))]
        assert above[-1].head == above[-1].index


@pytest.mark.parametrize("text", ["my name not tom", "why not pizza", "not now", "I live in Rome, not all the time"])
def test_a_negation_that_names_no_alternative_is_not_a_contrast(text: str, reader: Pipeline) -> None:
    assert contrasts_of(repaired(reader.read(text)[0])) == ()
