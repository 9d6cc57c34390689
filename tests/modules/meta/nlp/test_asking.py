"""What a question word asks for."""

import pytest

from modules.meta.nlp.sentences import words
from ravestate.modules.meta.nlp.asking import kind_at


@pytest.mark.parametrize(
    ("notation", "kind"),
    [
        ("who/PRON/x>0", "PERSON"),
        ("Whose/PRON/x>0 book/NOUN/x>0", "PERSON"),
        ("what/PRON/x>0", "OBJECT"),
        ("what/PRON/x>0 time/NOUN/x>0", "TIME"),
        ("which/DET/x>0 other/ADJ/x>0 city/NOUN/x>0", "PLACE"),
        ("what/PRON/x>0 is/AUX/x>0 time/NOUN/x>0", "OBJECT"),
        ("what/PRON/x>0 kind/NOUN/x>0 of/ADP/x>0 people/NOUN/x>0", "OBJECT"),
        ("what/PRON/x>0 for/ADP/x>0", "REASON"),
        ("how/ADV/x>0", "FORM"),
        ("how/ADV/x>0 come/VERB/x>0", "REASON"),
        ("how/ADV/x>0 old/ADJ/x>0", "AMOUNT"),
        ("how/ADV/x>0 nice/ADJ/x>0", "FORM"),
        ("where/ADV/x>0", "PLACE"),
        ("why/ADV/x>0", "REASON"),
        ("when/ADV/x>0", "TIME"),
    ],
)
def test_kinds(notation: str, kind: str) -> None:
    found = kind_at(words(notation), 0)
    assert found is not None and found.name == kind


def test_other_words_ask_for_nothing() -> None:
    assert kind_at(words("whatever/PRON/x>0"), 0) is None
