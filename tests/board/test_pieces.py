"""A repr in pieces: the same text as Python's own, and no more of it than is asked for."""

import dataclasses
from collections import Counter, OrderedDict, defaultdict, deque
from collections.abc import Iterator
from itertools import islice
from types import MappingProxyType
from typing import Any, NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.board.pieces import DEEPEST, pieces


class Pair(NamedTuple):
    left: Any
    right: Any


class Curt(NamedTuple):
    left: Any

    def __repr__(self) -> str:
        return "curt"


@dataclasses.dataclass(frozen=True)
class Point:
    x: Any
    hidden: Any = dataclasses.field(default=None, repr=False)


@dataclasses.dataclass
class Own:
    x: Any

    def __repr__(self) -> str:
        return "mine"


class Tags(set[Any]):
    pass


class Row(list[Any]):
    pass


HASHABLE = st.recursive(
    st.none() | st.integers() | st.floats(allow_nan=False) | st.text() | st.binary(),
    lambda inner: st.tuples(inner, inner) | st.frozensets(inner, max_size=3) | st.builds(Point, inner),
    max_leaves=5,
)
VALUES = st.recursive(
    HASHABLE,
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(HASHABLE, inner, max_size=3)
        | st.sets(HASHABLE, max_size=3)
        | st.builds(Pair, inner, inner)
        | st.builds(Point, inner)
        | st.builds(Own, inner)
        | st.builds(Curt, inner)
        | st.builds(Row, st.lists(inner, max_size=2))
        | st.lists(inner, max_size=3).map(deque)
    ),
    max_leaves=12,
)


@given(VALUES)
def test_it_is_what_python_says(value: object) -> None:
    assert "".join(pieces(value)) == repr(value)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ((), "()"),
        ((1,), "(1,)"),
        (set[int](), "set()"),
        (frozenset[int](), "frozenset()"),
        (Tags({1}), "Tags({1})"),
        (bytearray(b"x"), "bytearray(b'x')"),
        (OrderedDict({1: "a"}), "OrderedDict({1: 'a'})"),
        (defaultdict(int, {1: 2}), "defaultdict({1: 2})"),
        (Counter("aab"), "Counter({'a': 2, 'b': 1})"),
        (MappingProxyType({1: Own(2)}), "mappingproxy({1: mine})"),
        (Pair(1, [object]), "Pair(left=1, right=[<class 'object'>])"),
    ],
)
def test_what_is_said_of_containers(value: object, text: str) -> None:
    assert "".join(pieces(value)) == text


def test_what_is_within_itself_is_said_once() -> None:
    loop: list[Any] = [1]
    loop += [loop, {2: loop}]
    assert "".join(pieces(loop)) == repr(loop) == "[1, [...], {2: [...]}]"


def test_what_is_too_deep_is_left_out() -> None:
    deep: list[Any] = []
    for _ in range(100_000):
        deep = [deep]
    assert "".join(pieces(deep)) == "[" * (DEEPEST + 2) + "..." + "]" * (DEEPEST + 2)


class Loud:
    def __repr__(self) -> str:
        raise RuntimeError("no")


def test_what_fails_is_told_in_its_place() -> None:
    assert "".join(pieces([1, Loud()])) == "[1, <Loud whose repr fails: RuntimeError>]"


class Watched:
    """Counts how often it is asked for its repr."""

    asked = 0

    def __repr__(self) -> str:
        Watched.asked += 1
        return "w"


def things() -> Iterator[Watched]:
    return (Watched() for _ in range(1000))


@pytest.mark.parametrize(
    "value",
    [
        list(things()), tuple(things()), set(things()), frozenset(things()), deque(things()), Point(set(things())),
        dict(enumerate(things())), dict.fromkeys(things()), [Pair(0, set(things()))],
        MappingProxyType(dict.fromkeys(things())), Counter(things()), {1: tuple(things())}, Tags(things()),
    ],
    ids=lambda value: type(value).__name__,
)  # fmt: skip
def test_no_more_is_made_than_is_taken(value: object) -> None:
    Watched.asked = 0
    list(islice(pieces(value), 20))
    assert 0 < Watched.asked <= 20


def test_a_huge_text_is_cut_before_it_is_spelt() -> None:
    assert len("".join(pieces(["x" * 10**7, b"x" * 10**7]))) < 250_000
