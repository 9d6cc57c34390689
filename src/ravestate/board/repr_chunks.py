"""The ``repr`` of a value in chunks. For a huge value, no more chunks are made than the caller reads."""

from __future__ import annotations

import dataclasses
import sys
from collections import Counter, OrderedDict, defaultdict, deque
from collections.abc import Iterable, Iterator
from itertools import chain
from types import MappingProxyType
from typing import Any, NamedTuple, cast

DEEPEST = 30
"""The maximum depth of nested containers; the content of deeper ones is left out."""

LONGEST = 100_000
"""The maximum number of characters of a text, or of bytes, within a value; the rest is left out."""

TEXTS: dict[Any, Any] = {kind.__repr__: kind for kind in (str, bytes, bytearray)}

_ROWS: tuple[Any, ...] = (list, tuple, set, frozenset, deque)
_TABLES: tuple[Any, ...] = (dict, OrderedDict, defaultdict, Counter, MappingProxyType)
_WALKS: dict[Any, Any] = {
    **{kind: kind.__iter__ for kind in _ROWS},
    **{kind: kind.items for kind in _TABLES},
}
"""Built-in container → its own method of iteration, so that a subclass's method is never called."""

BUILT_IN: dict[Any, Any] = {kind.__repr__: kind for kind in _WALKS}
"""``__repr__`` method → the built-in container that defines it."""


class _Box(NamedTuple):
    """The parts of a container's ``repr``: the text around its items, and the items, each with its prefix.

    `again` is the text for the container within itself; if it is empty, that is three dots within its brackets.
    """

    opening: str
    items: Iterable[tuple[Iterable[str], object]]
    closing: str
    again: str = ""


def repr_chunks(value: object, around: tuple[int, ...] = ()) -> Iterator[str]:
    """Yield a ``repr`` in chunks: built-in containers, records and texts bit by bit, other values at once.

    Joined, the chunks are the ``repr``, with these differences. Long and deep values are cut. A `Counter` keeps its order
    instead of sorting. A mapping proxy reads like its dictionary. A subclass of a built-in container shows its items;
    its own methods are not called. A value within itself is left out.

    Args:
        value: The value.
        around: The `id` of each container around the value.

    Example:
        >>> "".join(repr_chunks(({1: {"Ada"}}, b"x")))
        "({1: {'Ada'}}, b'x')"
        >>> next(repr_chunks(set(range(1_000_000))))
        '{'
    """
    made_by: Any = type(value).__repr__
    if made_by in TEXTS:
        kind = TEXTS[made_by]
        yield made_by(value if kind.__len__(value) <= LONGEST else kind.__getitem__(value, slice(LONGEST)))
        return
    box = _box(value, made_by, (*around, id(value)))
    if box is None:
        yield _whole(value)
        return
    within = id(value) in around
    if within and box.again:
        yield box.again
        return
    yield box.opening
    if within or len(around) > DEEPEST:
        yield "..."
    else:
        for number, (lead, item) in enumerate(box.items):
            if number:
                yield ", "
            yield from lead
            yield from repr_chunks(item, (*around, id(value)))
    yield box.closing


def _box(value: Any, made_by: Any, around: tuple[int, ...]) -> _Box | None:
    """Return the parts of a value's ``repr``, which `made_by` determines; None if the parts are unknown."""
    own = cast("type[Any]", type(value))
    kind = BUILT_IN.get(made_by)
    if kind is not None:
        return _built_in(value, kind, around)
    if hasattr(own, "_fields") and getattr(made_by, "__module__", None) == "collections":  # a named tuple
        items = zip(value._fields, _WALKS[tuple](value), strict=True)
        return _Box(f"{own.__name__}(", _named(items), ")")
    if dataclasses.is_dataclass(own) and hasattr(made_by, "__wrapped__"):  # made by @dataclass
        items = ((field, getattr(value, field)) for field in _fields(own, made_by))
        return _Box(f"{own.__qualname__}(", _named(items), ")", "...")
    return None


def _built_in(value: Any, kind: Any, around: tuple[int, ...]) -> _Box | None:
    """Return the parts of the ``repr`` of a built-in container or a subclass; None if it is empty and short."""
    name = type(value).__name__
    size: int = kind.__len__(value)
    items = _WALKS[kind](value)
    if kind is list:
        return _Box("[", _plain(items), "]")
    if kind is tuple:
        return _Box("(", _plain(items), ",)" if size == 1 else ")", "(...)")
    if kind is dict:
        return _Box("{", _pairs(items, around), "}")
    if kind is deque:
        closing = "])" if value.maxlen is None else f"], maxlen={value.maxlen})"
        return _Box(f"{name}([", _plain(items), closing, "[...]")
    if kind is defaultdict:
        return _Box(f"{name}({_whole(value.default_factory)}, {{", _pairs(items, around), "})")
    if kind is not MappingProxyType and not size:
        return None
    if kind is set and type(value) is set:
        return _Box("{", _plain(items), "}")
    if kind in (set, frozenset):
        return _Box(f"{name}({{", _plain(items), "})")
    if kind is OrderedDict and sys.version_info < (3, 12):
        return _Box(f"{name}([", _plain(items), "])", "...")
    return _Box(f"{name}({{", _pairs(items, around), "})", "..." if kind is OrderedDict else "")


def _plain(items: Iterable[object]) -> Iterator[tuple[Iterable[str], object]]:
    return (((), item) for item in items)


def _pairs(items: Iterable[tuple[object, object]], around: tuple[int, ...]) -> Iterator[tuple[Iterable[str], object]]:
    return ((chain(repr_chunks(key, around), (": ",)), item) for key, item in items)


def _named(items: Iterable[tuple[str, object]]) -> Iterator[tuple[Iterable[str], object]]:
    return (((f"{name}=",), item) for name, item in items)


def _fields(own: type[Any], made_by: Any) -> list[str]:
    """Return the names of the fields in a dataclass's `__repr__`, which it may have from a base class."""
    maker: Any = next(base for base in own.__mro__ if vars(base).get("__repr__") is made_by)
    return [field.name for field in dataclasses.fields(maker) if field.repr]


def _whole(value: object) -> str:
    try:
        return repr(value)
    except Exception as error:  # the user's `__repr__` may raise anything
        return f"<{type(value).__name__} whose repr fails: {type(error).__name__}>"
