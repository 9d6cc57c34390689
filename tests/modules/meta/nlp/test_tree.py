"""A parsed text is a tree of plain records."""

from typing import Any

from ravestate.modules.meta.nlp.tree import Tree, Word, is_tree


def words(notation: str) -> list[Word]:
    """Return words made without a pipeline, for example from ``my/PRON/poss>1 name/NOUN/nsubj>2``."""
    found: list[Word] = []
    start = 0
    for index, item in enumerate(notation.split()):
        text, pos, relation = item.rsplit("/", 2)
        dep, _, head = relation.partition(">")
        found.append(Word(index, text, text.lower(), pos, "", dep, int(head), start))
        start += len(text) + 1
    return found


# my old dog sleeps here
TREE = Tree(
    "my old dog sleeps here",
    words("my/PRON/poss>2 old/ADJ/amod>2 dog/NOUN/nsubj>3 sleeps/VERB/ROOT>3 here/ADV/advmod>3"),
)
MY, OLD, DOG, SLEEPS, HERE = TREE.words


def test_each_word_has_its_children_and_its_head() -> None:
    assert TREE.children(SLEEPS) == [DOG, HERE]
    assert TREE.children(SLEEPS, "advmod", "dobj") == [HERE]
    assert TREE.head(OLD) is DOG and TREE.head(SLEEPS) is SLEEPS
    assert list(TREE.ancestors(MY)) == [DOG, SLEEPS]


def test_subtrees_are_in_order() -> None:
    assert TREE.subtree(DOG) == [MY, OLD, DOG]
    assert TREE.subtree(SLEEPS) == list(TREE.words)


def test_each_word_has_its_neighbours() -> None:
    assert TREE.before(MY) is None and TREE.after(HERE) is None
    assert TREE.before(DOG) is OLD and TREE.after(DOG) is SLEEPS


def test_phrases_are_written_as_in_the_text() -> None:
    glued = Tree("Anna's  dog", words("Anna/PROPN/poss>2 's/PART/case>0 dog/NOUN/ROOT>2"))
    anna, s, dog = (
        type(word)(word.index, word.text, word.lemma, word.pos, word.tag, word.dep, word.head, start)
        for word, start in zip(glued.words, (0, 4, 8), strict=True)
    )
    assert glued.phrase([dog, s, anna]) == "Anna's dog"
    assert glued.phrase([dog, anna]) == "Anna dog"
    assert TREE.phrase([]) == ""


def test_a_word_has_its_position_and_a_lower_case_form() -> None:
    assert (HERE.start, HERE.end) == (18, 22)
    (word,) = words("Don’T/AUX/ROOT>0")
    assert word.low == "don't"


def test_a_chain_of_heads_can_have_any_length() -> None:
    long = Tree("", words(" ".join(f"w/NOUN/conj>{max(index - 1, 0)}" for index in range(5000))))
    assert len(long.subtree(long.words[0])) == 5000


class Counted(list[Word]):
    """Words that count how often one of them is looked up."""

    lookups = 0

    def __getitem__(self, place: Any) -> Any:
        self.lookups += 1
        return super().__getitem__(place)


def test_the_check_for_loops_takes_linear_time() -> None:
    chain = words(" ".join(f"w/NOUN/conj>{min(index + 1, 1999)}" for index in range(2000)))
    counted = Counted(chain)
    assert is_tree(counted)
    assert counted.lookups <= len(counted)


def test_words_whose_heads_form_a_loop_are_no_tree() -> None:
    assert is_tree(TREE.words)
    assert not is_tree(words("a/NOUN/conj>1 b/NOUN/conj>2 c/NOUN/conj>1 d/NOUN/ROOT>3"))
