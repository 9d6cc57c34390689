"""Values are rendered as text, which is cut if it is too long. Rendering never fails."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.board.rendering import Rendered, not_json, render, well_formed
from ravestate.declare.slot import Entry

JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=12,
)


@given(JSON, st.integers(1, 60))
def test_a_text_has_a_maximum_length_and_uncut_json_can_be_parsed(value: object, most: int) -> None:
    shown = render(value, most)
    assert len(shown.text) <= max(most, 40)
    shown.text.encode()
    if shown.json:
        assert not shown.cut
        json.loads(shown.text)


def test_an_entry_of_a_collection_is_shown_by_its_key() -> None:
    assert render(Entry("ada", None)) == Rendered('"ada"', False)
    assert render(Entry("ada", {"age": 36})).text == '"ada": {"age": 36}'
    assert len(render(Entry("k" * 900, "v" * 900), 50).text) == 50


class Loud:
    def __repr__(self) -> str:
        raise RuntimeError("no")


class Liar(dict[str, int]):
    def items(self) -> object:  # type: ignore[override]
        raise RuntimeError("no")


def endless() -> list[object]:
    loop: list[object] = []
    loop.append(loop)
    return loop


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        ("hello", Rendered('"hello"')),
        (True, Rendered("true")),
        (None, Rendered("null")),
        ((1, 2), Rendered("(1, 2)", json=False)),  # JSON would turn the tuple into a list
        ({1: 2}, Rendered("{1: 2}", json=False)),
        (float("inf"), Rendered("inf", json=False)),
        ({1, 2}, Rendered("{1, 2}", json=False)),
        (Loud(), Rendered("<Loud whose repr fails: RuntimeError>", json=False)),
        (Liar(a=1), Rendered("<Liar that cannot be read: RuntimeError>", json=False)),
        ("<b>", Rendered('"<b>"')),
    ],
)
def test_each_value_has_a_readable_text(value: object, shown: Rendered) -> None:
    assert render(value) == shown


def test_a_list_that_contains_itself_has_a_text() -> None:
    assert render(endless()).text == "[[...]]"


class Counted:
    asked = 0

    def __repr__(self) -> str:
        Counted.asked += 1
        return "counted"


def test_only_the_items_that_fit_into_the_text_are_rendered() -> None:
    for value in (
        {Counted() for _ in range(1000)},
        {n: Counted() for n in range(1000)},
        [{Counted()}] * 1000,
    ):
        Counted.asked = 0
        shown = render(value, 100)
        assert (len(shown.text), shown.json, shown.cut) == (100, False, True)
        assert Counted.asked <= 20


def test_lone_surrogates_are_replaced() -> None:
    assert render({1: "\ud800"}).text == "{1: '\\ud800'}"
    assert well_formed("\ud800x") == "?x"
    assert well_formed("café 👋🏽") == "café 👋🏽"


def test_the_function_not_json_returns_true_for_values_that_json_cannot_express() -> None:
    assert (
        not_json(Loud())
        and not_json({"a": [Loud()]})
        and not_json(Liar(a=1))
        and not_json(endless())
        and not_json((1, 2))
        and not_json({"a": [()]})
    )
    assert not any(map(not_json, (None, True, 10**5000, float("nan"), "x" * 10**7, [1] * 10**6)))


@pytest.mark.parametrize(
    "value",
    ["x" * 10**7, list(range(10**6)), 10**5000, {"k" * 10**6: 1}, set(range(10**5)), {1: "x" * 10**7}],
    ids=["text", "list", "number", "key", "set", "odd keys"],
)
def test_a_huge_value_is_cut(value: object) -> None:
    shown = render(value, 100)
    assert len(shown.text) <= 100
    assert not shown.json
