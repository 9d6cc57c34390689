"""Long texts are split into several messages."""

from hypothesis import given
from hypothesis import strategies as st

from ravestate.modules.platform.chats.splitting import split


@given(st.text(alphabet="ab .\n", max_size=400), st.integers(1, 60))
def test_no_part_is_too_long_and_only_white_space_is_lost(text: str, longest: int) -> None:
    parts = split(text, longest)
    assert all(0 < len(part) <= longest for part in parts)
    assert "".join("".join(parts).split()) == "".join(text.split())


def test_a_text_is_split_between_paragraphs_or_else_sentences_or_else_words() -> None:
    assert split("One two three.\n\nFour. Five six.", 20) == ["One two three.", "Four. Five six."]
    assert split("One two three. Four five.", 20) == ["One two three.", "Four five."]
    assert split("One two three four five six", 20) == ["One two three four", "five six"]
    assert split("short", 20) == ["short"]


def test_the_first_part_may_have_another_limit() -> None:
    text = " ".join(["word"] * 50)
    first, *rest = split(text, 100, first=20)
    assert len(first) <= 20
    assert [20 < len(part) <= 100 for part in rest] == [True] * 3
    assert " ".join([first, *rest]) == text
    assert split("", 100, first=20) == []
