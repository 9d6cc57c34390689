"""Values as text: JSON if JSON can express the value, or else the ``repr``. Long texts are cut.

Values come from users' code. They may be huge, endlessly deep, or raise errors when they are read. None of this makes
rendering fail.
"""

from __future__ import annotations

import json
import math
import traceback
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import cast

from ravestate.board.repr_chunks import repr_chunks
from ravestate.declare.slot import Entry

DEEPEST = 6  # the maximum depth of a container in JSON (the outermost has depth 0); deeper values appear as a ``repr``
TRACEBACK = 8000  # the maximum number of characters of a traceback; a longer traceback keeps only its end


@dataclass(frozen=True, slots=True)
class Rendered:
    """A value as text.

    Attributes:
        text: The value as JSON, or its ``repr``; for an `Entry`, its key and item.
        json: Whether the text is the whole value as JSON. A user may then edit the text and write it back.
        cut: Whether the text is only the beginning of a longer text.
    """

    text: str
    json: bool = True
    cut: bool = False


class _Foreign(Exception):
    """JSON cannot express a value."""


def render(value: object, most: int = 2000) -> Rendered:
    """Return a value as text of at most `most` characters.

    Example:
        >>> render({"name": "Ada", "seen": [1, 2]})
        Rendered(text='{"name": "Ada", "seen": [1, 2]}', json=True, cut=False)
        >>> render("x" * 5000, most=8)
        Rendered(text='"xxxxxxx', json=False, cut=True)
        >>> render(object).text
        "<class 'object'>"
    """
    kind = type(value)
    # An int of 2 × `most` bits has fewer than `most` digits.
    if value is None or kind is bool or (kind is int and abs(cast("int", value)) < 1 << 2 * most):
        return Rendered(json.dumps(value))
    if kind is str:
        text = cast("str", value)
        if len(text) < most - 2:
            whole = json.dumps(well_formed(text), ensure_ascii=False)
            if len(whole) <= most:
                return Rendered(whole)
        return Rendered(json.dumps(well_formed(text[:most]), ensure_ascii=False)[:most], False, True)
    if kind is Entry:  # an item of a collection: the key comes first, because it matters most
        key, item = cast("Entry", value)
        name = render(str(key), most).text
        return Rendered((name if item is None else f"{name}: {render(item, most).text}")[:most], False)
    try:
        whole = _start(_json(value, 0), most)
        return Rendered(whole) if len(whole) <= most else Rendered(whole[:most], False, True)
    except _Foreign:
        return _repr(value, most)
    except Exception as error:  # a user's container that fails during iteration
        return Rendered(f"<{kind.__name__} that cannot be read: {type(error).__name__}>", False)


def not_json(value: object, most: int = 2000) -> bool:
    """Return whether JSON cannot express a value. This checks only the first `most` characters of its JSON."""
    if isinstance(value, (int, float)):  # even infinity: a user may write another number, which JSON can express
        return False
    try:
        _start(_json(value, 0), most)
    except Exception:  # JSON cannot express the value, or the value's own code fails
        return True
    return False


def _start(chunks: Iterator[str], most: int) -> str:
    """Return the chunks joined, up to the first chunk that makes the text longer than `most` characters."""
    text = ""
    for chunk in chunks:
        text += chunk
        if len(text) > most:
            break
    return text


def _json(value: object, depth: int) -> Iterator[str]:
    """Yield a value's JSON in chunks, so that a huge value is never converted as a whole."""
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
    elif type(value) is list:  # only lists: JSON would turn a tuple into a list
        yield "["
        for number, item in enumerate(cast("list[object]", value)):
            if number:
                yield ", "
            yield from _json(item, depth + 1)
        yield "]"
    else:
        raise _Foreign


def _repr(value: object, most: int) -> Rendered:
    try:
        text = well_formed(_start(repr_chunks(value), most)[: most + 1])
    except Exception as error:  # a container changed while it was read, or a field raised an error
        return Rendered(f"<{type(value).__name__} whose repr fails: {type(error).__name__}>", False)
    return Rendered(text[:most], False, len(text) > most)


def well_formed(text: str) -> str:
    """Return a text with a question mark for each lone surrogate, which UTF-8 cannot encode."""
    return text if text.isascii() else text.encode("utf-8", "replace").decode("utf-8")


def traceback_of(error: BaseException) -> str:
    """Return the end of an exception's traceback as text."""
    return well_formed("".join(traceback.format_exception(error)))[-TRACEBACK:]
