"""The stems of the module equal those that the tokenizer of the index makes."""

import sqlite3

from ravestate.modules.skill.genqa.lexicon import variants_of
from ravestate.modules.skill.genqa.stems import TOKENIZER, Stems


def test_each_text_gets_its_stems_in_order() -> None:
    stems = Stems()
    assert stems("Bogotá's capitals", "", "capital") == [["bogota", "s", "capit"], [], ["capit"]]
    assert stems("Peru") == [["peru"]], "a stem must not come from an earlier text"
    stems.close()


def test_stems_equal_those_in_the_index() -> None:
    text = "Neighbouring countries, running rivers: naïve Łódź 3.14 東京"
    base = sqlite3.connect(":memory:")
    base.execute(f"CREATE VIRTUAL TABLE t USING fts5(x, tokenize='{TOKENIZER}')")
    base.execute("INSERT INTO t VALUES (?)", (text,))
    base.execute("CREATE VIRTUAL TABLE w USING fts5vocab(t, 'row')")
    indexed = {row[0] for row in base.execute("SELECT term FROM w")}
    base.close()
    stems = Stems()
    assert set(stems(text)[0]) == indexed
    stems.close()


def test_the_variants_of_a_word_include_the_word_and_are_symmetric() -> None:
    assert variants_of("Zorbex") == ("Zorbex",)
    assert "written" in variants_of("Wrote")
    assert "wrote" in variants_of("written")
