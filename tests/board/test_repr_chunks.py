"""A repr in chunks has the same text as Python's `repr`. Chunks that are not read are never made."""

import dataclasses
from collections import Counter, OrderedDict, defaultdict, deque
from collections.abc import Iterator
from itertools import islice
from types import MappingProxyType
from typing import Any, NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.board.repr_chunks import DEEPEST, repr_chunks


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


@dataclasses.dataclass
class Box:
    x: Any


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
def test_the_chunks_together_equal_the_repr_of_python(value: object) -> None:
    assert "".join(repr_chunks(value)) == repr(value)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ((), "()"),
        ((1,), "(1,)"),
        (set[int](), "set()"),
        (frozenset[int](), "frozenset()"),
        (Tags({1}), "Tags({1})"),
        (bytearray(b"x"), "bytearray(b'x')"),
        (deque([1]), "deque([1])"),
        (deque[int](maxlen=0), "deque([], maxlen=0)"),
        (defaultdict[int, int](), "defaultdict(None, {})"),
        (Counter("aab"), "Counter({'a': 2, 'b': 1})"),
        (Counter[str](), "Counter()"),
        (MappingProxyType({1: Own(2)}), "mappingproxy({1: mine})"),
        (Pair(1, [object]), "Pair(left=1, right=[<class 'object'>])"),
    ],
)
def test_containers_have_the_same_text_as_in_python(value: object, text: str) -> None:
    assert "".join(repr_chunks(value)) == repr(value) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (deque([1], maxlen=3), "deque([1])"),
        (defaultdict(int, {1: 2}), "defaultdict({1: 2})"),
        (OrderedDict({1: "a"}), "OrderedDict({1: 'a'})"),
        (Counter("abb"), "Counter({'a': 1, 'b': 2})"),
    ],
)
def test_containers_with_options_show_only_their_name_and_their_items_in_order(value: object, text: str) -> None:
    assert "".join(repr_chunks(value)) == text


class Sly(list[Any]):
    def __iter__(self) -> Iterator[Any]:
        yield 99

    def __len__(self) -> int:
        raise RuntimeError("no")


class SlyText(str):
    __slots__ = ()

    def __getitem__(self, key: Any) -> str:
        raise RuntimeError("no")


class SlyDict(dict[Any, Any]):
    def items(self) -> Any:
        raise RuntimeError("no")


class Bytes(bytearray):
    pass


@dataclasses.dataclass(repr=False, frozen=True)
class Further(Point):
    y: Any = 0


@pytest.mark.parametrize("value", [Sly([1, 2]), SlyText("x"), SlyDict({1: 2}), Bytes(b"x"), Further(1, 2, 3)], ids=repr)
def test_a_subclass_with_odd_methods_has_the_same_text_as_in_python(value: object) -> None:
    assert "".join(repr_chunks([value])) == repr([value])


def test_a_value_that_contains_itself_has_the_same_text_as_in_python() -> None:
    inner: list[Any] = []
    for value in ((1, inner), {1: inner}):
        inner[:] = [value]
        assert "".join(repr_chunks(value)) == repr(value)


def test_a_list_that_contains_itself_shows_an_ellipsis_inside() -> None:
    loop: list[Any] = [1]
    loop += [loop, {2: loop}]
    assert "".join(repr_chunks(loop)) == repr(loop) == "[1, [...], {2: [...]}]"


def test_values_nested_too_deeply_are_left_out() -> None:
    deep: list[Any] = []
    for _ in range(100_000):
        deep = [deep]
    assert "".join(repr_chunks(deep)) == "[" * (DEEPEST + 2) + "..." + "]" * (DEEPEST + 2)


class Loud:
    def __repr__(self) -> str:
        raise RuntimeError("no")


def test_a_value_whose_repr_fails_is_replaced_by_the_name_of_the_error() -> None:
    assert "".join(repr_chunks([1, Loud()])) == "[1, <Loud whose repr fails: RuntimeError>]"


class Watched:
    """A value that counts the calls of its `__repr__`."""

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
def test_no_item_is_rendered_before_its_chunk_is_read(value: object) -> None:
    Watched.asked = 0
    list(islice(repr_chunks(value), 20))
    assert 0 < Watched.asked <= 20


def test_a_huge_text_is_cut_before_its_repr_is_made() -> None:
    assert len("".join(repr_chunks(["x" * 10**7, b"x" * 10**7]))) < 250_000
