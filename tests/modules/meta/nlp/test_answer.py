"""Properties that hold for the meaning of any answer. `tests/quality` measures how often the meaning is right."""

import ast
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from quality.measure import labelled
from ravestate.language.network import Network, network
from ravestate.language.normal import normalise
from ravestate.modules import nlp
from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.answer import YesNo, yesno_of
from ravestate.modules.meta.nlp.pipeline import pipeline

MEANINGS = (
    YesNo(2, 0, False),
    YesNo(1, 0, False),
    YesNo(0, 2, False),
    YesNo(0, 1, False),
    YesNo(0, 0, True),
    YesNo(None, None, None),
)


@pytest.mark.parametrize("text", ["yes", "no", "probably not", "of course", "I don't know"])
def test_capitals_spaces_and_punctuation_do_not_change_the_meaning(text: str) -> None:
    for variant in (
        text.upper(),
        f"  {text} ",
        f"{text}!",
        f"{text}.",
        f"Well, {text}...",
        text.replace("'", "’"),
    ):
        assert yesno_of(variant) == yesno_of(text), variant


def test_a_meaning_is_truthy_only_if_the_text_is_an_answer() -> None:
    assert yesno_of("no") and yesno_of("maybe") and not yesno_of("It is cold.")


words = st.sampled_from(
    sorted({word for text, _ in labelled("yesno_rows") for word in text.split()} | {",", ".", "?", "but", "tree"})
)


@given(st.lists(words, max_size=60).map(" ".join) | st.text(max_size=100))
def test_every_text_has_one_of_six_meanings(text: str) -> None:
    assert yesno_of(text) in MEANINGS


def test_a_very_long_answer_has_the_meaning_of_a_short_one() -> None:
    assert yesno_of("yes " * 50_000) == MEANINGS[0]


@pytest.mark.parametrize(
    ("text", "meaning"), [("yes", YesNo(2, 0, False)), ("no, thanks", YesNo(0, 2, False)), ("maybe", YesNo(0, 0, True))]
)
def test_common_answers_need_no_sentence_model(text: str, meaning: YesNo, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Network, "loaded", False)
    assert yesno_of(text) == meaning
    assert not yesno_of("you bet your boots")


def test_all_parts_of_an_answer_decide_its_meaning() -> None:
    network().load()
    assert yesno_of("yes, and you?") == yesno_of("yes")
    assert yesno_of("not really, no").no
    assert yesno_of("yes, but not now").no and yesno_of("no, I guess").no == 1


def test_a_letter_is_no_answer_unless_it_stands_for_one() -> None:
    network().load()
    assert not any(yesno_of(text) for text in ("A.", "b", "o", "?", ""))
    assert not analyse("a" * 300, pipeline("")).yesno
    assert yesno_of("Yes.").yes


def examples_in_the_readme() -> list[tuple[str, YesNo]]:
    """Return the answers in the table of the README, each with its meaning."""
    row = re.compile(r"\| `yes=(\w+), no=(\w+), unsure=(\w+)`[^|]*\| `([^`|]*)` \|")
    readme = (Path(nlp.__file__).parent / "README.md").read_text(encoding="utf-8")
    return [
        (text, YesNo(*map(ast.literal_eval, found.group(1, 2, 3))))
        for found in row.finditer(readme)
        for text in found[4].split(", ")
    ]


def test_the_answers_in_the_readme_have_the_meanings_that_it_promises() -> None:
    network().load()
    examples = examples_in_the_readme()
    wrong = [(text, meaning) for text, meaning in examples if yesno_of(normalise(text).unguessed) != meaning]
    assert len(examples) > 70
    assert wrong == []
