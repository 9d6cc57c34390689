"""Values as they are shown: JSON where that can carry them, else their ``repr``; cut where they are long.

Values are foreign: they may be huge, endless in depth, or fail when they are looked at. None of that may harm who looks.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import cast

from ravestate.board.repr_chunks import repr_chunks
from ravestate.declare.slot import Entry

__all__ = ["Rendered", "not_json", "render", "well_formed"]

DEEPEST = 6
"""Containers within containers that are looked into."""


@dataclass(frozen=True, slots=True)
class Rendered:
    """A value as text.

    Attributes:
        text: JSON, or a ``repr``.
        json: Whether it is JSON that stands for the whole value, so that it may be edited and written back.
        cut: Whether there is more of it.
    """

    text: str
    json: bool = True
    cut: bool = False


class _Foreign(Exception):
    """JSON has no word for a value."""


def render(value: object, most: int = 2000) -> Rendered:
    """A value as text of at most `most` characters.

    Example:
        >>> render({"name": "Ada", "seen": [1, 2]})
        Rendered(text='{"name": "Ada", "seen": [1, 2]}', json=True, cut=False)
        >>> render("x" * 5000, most=8)
        Rendered(text='"xxxxxxx', json=False, cut=True)
        >>> render(object).text
        "<class 'object'>"
    """
    kind = type(value)
    if value is None or kind is bool or (kind is int and abs(cast("int", value)) < 1 << 2 * most):
        return Rendered(json.dumps(value))
    if kind is str:
        text = cast("str", value)
        if len(text) < most - 2:
            whole = json.dumps(well_formed(text), ensure_ascii=False)
            if len(whole) <= most:
                return Rendered(whole)
        return Rendered(json.dumps(well_formed(text[:most]), ensure_ascii=False)[:most], False, True)
    if kind is Entry:  # of a collection: its key says most
        key, item = cast("Entry", value)
        name = render(str(key), most).text
        return Rendered((name if item is None else f"{name}: {render(item, most).text}")[:most], False)
    pieces: list[str] = []
    size = 0
    try:
        for piece in _json(value, 0):
            pieces.append(piece)
            size += len(piece)
            if size > most:
                return Rendered("".join(pieces)[:most], False, True)
        return Rendered("".join(pieces))
    except _Foreign:
        return _repr(value, most)
    except Exception as error:  # a container of foreign make, that fails when it is looked through
        return Rendered(f"<{kind.__name__} that cannot be shown: {type(error).__name__}>", False)


def not_json(value: object, most: int = 2000) -> bool:
    """Whether JSON has no word for a value, as far as the first `most` characters of it tell.

    Example:
        >>> not_json({"name": "Ada"}), not_json([1, object()])
        (False, True)
    """
    if isinstance(value, (int, float)):
        return False
    size = 0
    try:
        for piece in _json(value, 0):
            size += len(piece)
            if size > most:
                break
    except (
        Exception
    ):  # JSON has no word for it, or its own code failed while it was looked through: foreign either way
        return True
    return False


def _json(value: object, depth: int) -> Iterator[str]:
    """The pieces of a value's JSON, made one by one, so that a huge one need not be made whole."""
    if value is None or isinstance(value, (bool, int)):
        yield json.dumps(value)
    elif isinstance(value, float):
        if not math.isfinite(value):
            raise _Foreign
        yield json.dumps(value)
    elif isinstance(value, str):
        yield json.dumps(well_formed(value[:100_000]), ensure_ascii=False)
    elif depth > DEEPEST:
        raise _Foreign
    elif isinstance(value, Mapping):
        yield "{"
        for number, (key, item) in enumerate(cast("Mapping[object, object]", value).items()):
            if not isinstance(key, str):
                raise _Foreign
            yield (", " if number else "") + json.dumps(well_formed(key[:1000]), ensure_ascii=False) + ": "
            yield from _json(item, depth + 1)
        yield "}"
    elif type(value) is list:  # a tuple would come back as another thing
        yield "["
        for number, item in enumerate(cast("list[object]", value)):
            if number:
                yield ", "
            yield from _json(item, depth + 1)
        yield "]"
    else:
        raise _Foreign


def _repr(value: object, most: int) -> Rendered:
    found: list[str] = []
    size = 0
    try:
        for piece in repr_chunks(value):
            found.append(piece)
            size += len(piece)
            if size > most:
                break
    except Exception as error:  # a container that changes, or a field that fails, while it is looked through
        return Rendered(f"<{type(value).__name__} whose repr fails: {type(error).__name__}>", False)
    text = well_formed("".join(found)[: most + 1])
    return Rendered(text[:most], False, len(text) > most)


def well_formed(text: str) -> str:
    """A text without lone surrogates, which no encoding carries.

    Example:
        >>> well_formed("\\ud800x")
        '?x'
    """
    return text if text.isascii() else text.encode("utf-8", "replace").decode("utf-8")
