"""The ``repr`` of a value, piece by piece: of a huge one no more is made than somebody looks at."""

from __future__ import annotations

import dataclasses
from collections import Counter, OrderedDict, defaultdict, deque
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from types import MappingProxyType
from typing import Any, NamedTuple, cast

__all__ = ["pieces"]

DEEPEST = 30
"""Containers within containers that are looked into."""

LONGEST = 100_000
"""Characters, or bytes, of one text that are looked at."""

TEXTS: tuple[Any, ...] = (str.__repr__, bytes.__repr__, bytearray.__repr__)

_KINDS: tuple[Any, ...] = (
    list, tuple, dict, set, frozenset, deque, OrderedDict, defaultdict, Counter, MappingProxyType,
)  # fmt: skip
BUILT_IN: dict[Any, Any] = {kind.__repr__: kind for kind in _KINDS}
"""Python's own containers by what makes their ``repr``."""


class _Box(NamedTuple):
    """A container: what stands before and behind its items, and the items, each with what leads to it."""

    opening: str
    items: Iterable[tuple[Iterable[str], object]]
    closing: str


def pieces(value: object, around: tuple[int, ...] = ()) -> Iterator[str]:
    """The pieces of a ``repr``: containers of Python's own, records and texts bit by bit, all else at once.

    Args:
        value: Any.
        around: The `id` of each container that it is within.

    Example:
        >>> "".join(pieces(({1: {"Ada"}}, b"x")))
        "({1: {'Ada'}}, b'x')"
        >>> next(pieces(set(range(1_000_000))))
        '{'
    """
    made_by: Any = type(value).__repr__
    if made_by in TEXTS:
        yield made_by(cast("str", value)[:LONGEST])
        return
    box = _box(value, made_by, (*around, id(value)))
    if box is None:
        yield _whole(value)
        return
    yield box.opening
    if id(value) in around or len(around) > DEEPEST:
        yield "..."
    else:
        for number, (lead, item) in enumerate(box.items):
            if number:
                yield ", "
            yield from lead
            yield from pieces(item, (*around, id(value)))
    yield box.closing


def _box(value: Any, made_by: Any, around: tuple[int, ...]) -> _Box | None:
    """How a value's ``repr`` is made up, which its type's `__repr__` tells; None: it has no parts that are known."""
    own = cast("Any", type(value))
    name = own.__name__
    kind = BUILT_IN.get(made_by)
    if kind is list:
        return _Box("[", _plain(value), "]")
    if kind is tuple:
        return _Box("(", _plain(value), ",)" if len(value) == 1 else ")")
    if kind is dict:
        return _Box("{", _pairs(value, around), "}")
    if kind is set and own is set and value:
        return _Box("{", _plain(value), "}")
    if kind in (set, frozenset):
        return _Box(f"{name}({{", _plain(value), "})") if value else None
    if kind is deque:
        return _Box(f"{name}([", _plain(value), "])")
    if kind is not None:
        return _Box(f"{name}({{", _pairs(value, around), "})")
    if hasattr(own, "_fields") and getattr(made_by, "__module__", None) == "collections":  # a named tuple
        return _Box(f"{name}(", _fields(value, value._fields), ")")
    if dataclasses.is_dataclass(own) and hasattr(made_by, "__wrapped__"):  # by @dataclass
        names = [field.name for field in dataclasses.fields(value) if field.repr]
        return _Box(f"{own.__qualname__}(", _fields(value, names), ")")
    return None


def _plain(items: Iterable[object]) -> Iterator[tuple[Iterable[str], object]]:
    return (((), item) for item in items)


def _pairs(
    mapping: Mapping[object, object], around: tuple[int, ...]
) -> Iterator[tuple[Iterable[str], object]]:
    return ((chain(pieces(key, around), (": ",)), item) for key, item in mapping.items())


def _fields(value: object, names: Iterable[str]) -> Iterator[tuple[Iterable[str], object]]:
    return (((f"{name}=",), getattr(value, name)) for name in names)


def _whole(value: object) -> str:
    try:
        return repr(value)
    except Exception as error:  # its repr is foreign code
        return f"<{type(value).__name__} whose repr fails: {type(error).__name__}>"
