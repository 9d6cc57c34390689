"""Sets of words."""

from ravestate.modules.meta.nlp.word_set import word_set


def test_white_space_parts_the_words() -> None:
    assert word_set("a b", "c\n a") == {"a", "b", "c"}
    assert word_set() == word_set("  ") == frozenset()
