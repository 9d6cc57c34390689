"""Cleaning removes control characters from text."""

from hypothesis import given
from hypothesis import strategies as st

from ravestate.modules._text import printable, without_controls


def test_escape_sequences_are_removed_completely() -> None:
    assert printable("a\x1b[1;31mb\x1b]0;title\x07c\x1b(Bd\x9b2Je\x1b") == "abcde"


def test_every_line_end_becomes_a_line_feed() -> None:
    assert printable("a\r\nb\rc\n\td") == "a\nb\nc\n\td"


def test_invalid_bytes_become_visible() -> None:
    assert without_controls(b"caf\xe9".decode("utf-8", "surrogateescape")) == "caf\ufffd"


@given(st.text(st.characters(codec=None, categories=None), max_size=40))
def test_the_result_can_be_printed(text: str) -> None:
    for clean in (printable(text), without_controls(text)):
        clean.encode()
        assert all(c in "\n\t" or not (ord(c) < 32 or 127 <= ord(c) < 160) for c in clean)
        assert printable(clean) == without_controls(clean) == clean


@given(st.lists(st.text(st.characters(codec=None, categories=None), max_size=10)))
def test_cleaning_a_text_piece_by_piece_gives_the_same_result(pieces: list[str]) -> None:
    assert "".join(map(without_controls, pieces)) == without_controls("".join(pieces))
