"""The ``repr`` of a value in chunks. A caller that reads only some chunks of a huge value saves work."""

from __future__ import annotations

import dataclasses
from collections import Counter, OrderedDict, defaultdict, deque
from collections.abc import Iterable, Iterator
from itertools import chain
from types import MappingProxyType
from typing import Any, cast

DEEPEST = 30  # the maximum depth of nested containers; the content of deeper containers is left out
LONGEST = 100_000  # the maximum number of characters of a text, or of bytes, within a value; the rest is left out

TEXTS: dict[Any, Any] = {kind.__repr__: kind for kind in (str, bytes, bytearray)}
"""``__repr__`` method → the built-in text type that defines it."""

_ROWS: tuple[Any, ...] = (list, tuple, set, frozenset, deque)
_TABLES: tuple[Any, ...] = (dict, OrderedDict, defaultdict, Counter, MappingProxyType)
_WALKS: dict[Any, Any] = {**{kind: kind.__iter__ for kind in _ROWS}, **{kind: kind.items for kind in _TABLES}}
"""Built-in container → its own method of iteration, so that a subclass's method is never called."""

BUILT_IN: dict[Any, Any] = {kind.__repr__: kind for kind in _WALKS}
"""``__repr__`` method → the built-in container that defines it."""

_BRACKETS: dict[Any, str] = {list: "[]", deque: "[]", tuple: "()"}

_Items = Iterable[tuple[Iterable[str], object]]  # the items of a container, each after a prefix such as a key


def repr_chunks(value: object, around: tuple[int, ...] = ()) -> Iterator[str]:
    """Yield the ``repr`` of a value: in many chunks for containers and dataclasses, in one for other values.

    Long texts and deep values are cut. If a value contains itself, ``...`` stands for the inner value: `around` has the
    `id` of each container around the value. Containers other than lists, tuples, sets and dicts show their class, as in
    ``deque([1, 2])``. A subclass of a built-in container shows its items; the subclass's methods are not called.
    """
    made_by: Any = type(value).__repr__
    if made_by in TEXTS:
        kind = TEXTS[made_by]
        yield made_by(value if kind.__len__(value) <= LONGEST else kind.__getitem__(value, slice(LONGEST)))
        return
    parts = _parts(value, made_by, (*around, id(value)))
    if parts is None:
        yield _whole(value)
        return
    opening, items, closing = parts
    yield opening
    if id(value) in around or len(around) > DEEPEST:
        yield "..."
    else:
        for number, (lead, item) in enumerate(items):
            if number:
                yield ", "
            yield from lead
            yield from repr_chunks(item, (*around, id(value)))
    yield closing


def _parts(value: Any, made_by: Any, around: tuple[int, ...]) -> tuple[str, _Items, str] | None:
    """Return the parts of the ``repr`` that the method `made_by` makes; None without parts, or if they are unknown."""
    own = cast("type[Any]", type(value))
    kind = BUILT_IN.get(made_by)
    if kind is not None:
        size: int = kind.__len__(value)
        opening, closing = _BRACKETS.get(kind, "{}")
        if kind is tuple and size == 1:
            closing = ",)"
        if kind not in (list, tuple, dict) and own is not set:
            opening, closing = f"{own.__name__}({opening}", f"{closing})"
        items: Iterable[Any] = _WALKS[kind](value)
        return (opening, _plain(items) if kind in _ROWS else _pairs(items, around), closing) if size else None
    if hasattr(own, "_fields") and getattr(made_by, "__module__", None) == "collections":  # a named tuple
        return f"{own.__name__}(", _named(zip(value._fields, _WALKS[tuple](value), strict=True)), ")"
    if dataclasses.is_dataclass(own) and hasattr(made_by, "__wrapped__"):  # made by @dataclass
        fields = ((field, getattr(value, field)) for field in _fields(own, made_by))
        return f"{own.__qualname__}(", _named(fields), ")"
    return None


def _plain(items: Iterable[object]) -> _Items:
    return (((), item) for item in items)


def _pairs(items: Iterable[tuple[object, object]], around: tuple[int, ...]) -> _Items:
    return ((chain(repr_chunks(key, around), (": ",)), item) for key, item in items)


def _named(items: Iterable[tuple[str, object]]) -> _Items:
    return (((f"{name}=",), item) for name, item in items)


def _fields(own: type[Any], made_by: Any) -> list[str]:
    """Return the names of the fields that a dataclass's ``__repr__``, `made_by`, shows. A base class may define it."""
    maker: Any = next(base for base in own.__mro__ if vars(base).get("__repr__") is made_by)
    return [field.name for field in dataclasses.fields(maker) if field.repr]


def _whole(value: object) -> str:
    try:
        return repr(value)
    except Exception as error:  # the user's `__repr__` may raise anything
        return f"<{type(value).__name__} whose repr fails: {type(error).__name__}>"
