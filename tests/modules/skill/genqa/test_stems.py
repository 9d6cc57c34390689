"""Stems equal those of the index's own tokenizer."""

import sqlite3

from ravestate.modules.skill.genqa.lexicon import variants_of
from ravestate.modules.skill.genqa.stems import TOKENIZER, Stems


def test_stems_of_each_text_in_order() -> None:
    stems = Stems()
    assert stems("Bogotá's capitals", "", "capital") == [["bogota", "s", "capit"], [], ["capit"]]
    assert stems("Peru") == [["peru"]], "nothing is left of the texts before"
    stems.close()


def test_stems_are_those_that_the_index_has() -> None:
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


def test_variants_hold_the_word_itself_and_work_both_ways() -> None:
    assert variants_of("Zorbex") == ("Zorbex",)
    assert "written" in variants_of("Wrote")
    assert "wrote" in variants_of("written")
