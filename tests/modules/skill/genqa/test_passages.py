"""Running text is divided into passages that can serve as answers."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.modules.skill.genqa.passages import LONGEST, SHORTEST, passages_of


def texts(text: str) -> list[str]:
    return [passage.text for passage in passages_of(text)]


def test_each_sentence_becomes_a_passage() -> None:
    assert texts("Tram 7 goes to the beach. Tram 9 goes to the woods!\nAre you coming along?") == [
        "Tram 7 goes to the beach.",
        "Tram 9 goes to the woods!",
        "Are you coming along?",
    ]


def test_a_sentence_that_refers_to_the_previous_one_is_joined_to_it() -> None:
    assert texts("The shed is green. It has a key. The key is old enough.") == [
        "The shed is green.",
        "The shed is green. It has a key.",
        "The key is old enough.",
    ]
    assert texts("The shed is green.\n\nIt stands in the garden.") == [
        "The shed is green.",
        "It stands in the garden.",
    ], "a sentence must not be joined to another paragraph"


@pytest.mark.parametrize(
    "sentence",
    [
        "Dr. Kolm met Mrs. A. Smith in St. Ives.",
        "It weighs 3.5 kilograms, i.e. 7.7 pounds.",
        "On 3. May the U.S. Navy came, with approx. 40 ships.",
        "See www.example.com for more of this kind.",
        "The plan is by É. Blanc and Ł. Kowal.",
        "Das sind Häuser bzw. älterer Bestand.",
    ],
)
def test_a_full_stop_in_an_abbreviation_or_a_number_does_not_end_a_sentence(sentence: str) -> None:
    assert texts(sentence) == [sentence]


def test_broken_lines_are_joined() -> None:
    assert texts("The main-\ntenance of the pump\nis due in May.") == ["The maintenance of the pump is due in May."]


def test_a_word_that_is_broken_at_a_letter_with_an_accent_is_joined() -> None:
    assert texts("The fianc-\née and the Grö-\nße of Baden-\nÖs.") == ["The fiancée and the Größe of Baden- Ös."]


def test_a_sentence_may_end_with_a_single_small_letter_and_begin_with_any_capital_letter() -> None:
    assert texts("Der Buchstabe heißt ä. Überall steht er.") == ["Der Buchstabe heißt ä.", "Überall steht er."]
    assert texts("Это сказал я. Она молчала.") == ["Это сказал я.", "Она молчала."]


def test_numbers_lines_and_captions_without_a_sentence_are_left_out() -> None:
    assert texts("7\n\nFig. 3\n\n--- --- --- --- ---\n\n1234567890 1234567890") == []


def test_control_characters_and_escape_sequences_are_removed() -> None:
    assert texts("The \x1b[31mred\x1b[0m line\x00 is short\udce9 now.") == ["The red line is short\ufffd now."]


def test_an_overlong_sentence_is_cut_at_commas() -> None:
    parts = texts("rain, snow, hail, " * 200)
    assert all(len(part) <= LONGEST + SHORTEST and part.endswith(",") for part in parts[:-1])
    assert sum(part.count("snow") for part in parts) == 200


@given(st.text(max_size=2000))
def test_any_text_gives_short_passages_that_can_be_encoded(text: str) -> None:
    for passage in passages_of(text):
        assert 0 < len(passage.text) <= LONGEST + SHORTEST
        assert passage.text.encode("utf-8")
