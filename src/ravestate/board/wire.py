"""The board's language: records, policies and answers as plain data for JSON, and back. Version 1.

What each frame means stands in ``docs/reference/board-protocol.md``. Records bear the names and fields of
``ravestate.engine.trace``; a value is a `Shown`: text, JSON or not, cut or not.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from operator import attrgetter
from typing import Any, cast

import pydantic

from ravestate.board.description import Description
from ravestate.board.recorder import Gap
from ravestate.board.shown import Shown, show
from ravestate.engine import trace
from ravestate.engine.trace import Record

__all__ = ["VERSION", "data_of", "description_of", "record_of", "shown_data", "whole_data"]

VERSION = 1
"""Of the protocol and of trace files. A frame, a kind of record or a field that is added does not change it."""

PAYLOAD = 400
"""Characters that are shown of a payload."""

VALUE = 2000
"""Characters that are shown of a slot's value."""

KINDS: dict[str, type[Any]] = {
    kind.__name__.lower(): kind
    for kind in (
        trace.Born,
        trace.Dropped,
        trace.GaveUp,
        trace.Held,
        trace.Merged,
        trace.Passed,
        trace.Pressed,
        trace.Set,
        trace.Settled,
        trace.Started,
        trace.Told,
        trace.Waits,
        Gap,
    )
}
"""The kinds of records by the word that stands for them."""

SHOWN = {"payload": PAYLOAD, "value": VALUE}
TIMES = ("time", "until")


def data_of(record: Record | Gap) -> dict[str, Any]:
    """A record as data.

    Example:
        >>> data_of(trace.Merged(1.5, 3, 2))
        {'kind': 'merged', 'time': 1.5, 'group': 3, 'into': 2}
    """
    return _WRITERS[type(record)](record)


def shown_data(shown: Shown) -> dict[str, Any]:
    """A shown value as data: what is as usual is left out."""
    data: dict[str, Any] = {"text": shown.text}
    if not shown.json:
        data["json"] = False
    if shown.cut:
        data["cut"] = True
    return data


_PLAIN: dict[Any, dict[str, Any]] = {None: {"text": "null"}, True: {"text": "true"}, False: {"text": "false"}}


def _quickly(value: Any) -> dict[str, Any] | None:
    """The most frequent of values, which need no care: as `show` would have them."""
    if value is None or value is True or value is False:
        return _PLAIN[value]
    if type(value) is str and len(value) < 60 and value.isascii():
        return {"text": json.dumps(value)}
    return None


def _writer(name: str, kind: type[Any]) -> Callable[[Any], dict[str, Any]]:
    fields = [field.name for field in dataclasses.fields(kind)]
    keys = ("kind", *(field.rstrip("_") for field in fields))
    get = attrgetter(*fields)
    most = next(((field, SHOWN[field]) for field in fields if field in SHOWN), None)
    bounded = "until" in fields

    def write(record: Any) -> dict[str, Any]:
        data = dict(zip(keys, (name, *get(record)), strict=True))
        data["time"] = round(cast("float", data["time"]), 6)
        if bounded and data["until"] is not None:
            data["until"] = round(cast("float", data["until"]), 6)
        if most is not None:
            value = data[most[0]]
            data[most[0]] = _quickly(value) or shown_data(
                value if type(value) is Shown else show(value, most[1])
            )
        return data

    return write


_WRITERS = {kind: _writer(name, kind) for name, kind in KINDS.items()}
_READERS: dict[str, pydantic.TypeAdapter[Any]] = {}


def record_of(data: Any) -> Record | Gap:
    """The record that data stands for. Values stay as they were shown.

    Raises:
        ValueError: It stands for none.
    """
    if not isinstance(data, dict):
        raise ValueError(f"a record is an object, not {str(data)[:60]!r}")
    fields = dict(cast("dict[str, Any]", data))
    name = fields.pop("kind", None)
    if not isinstance(name, str) or name not in KINDS:
        raise ValueError(f'"kind": {str(name)[:60]!r} is none of {", ".join(KINDS)}')
    if name not in _READERS:
        _READERS[name] = pydantic.TypeAdapter(KINDS[name])
    if "for" in fields:
        fields["for_"] = fields.pop("for")
    for field in SHOWN:
        if field in fields:
            fields[field] = _SHOWN.validate_python(fields[field])
    return _READERS[name].validate_python(fields)


_SHOWN = pydantic.TypeAdapter(Shown)
_DESCRIPTION = pydantic.TypeAdapter(Description)


def whole_data(value: Any) -> dict[str, Any]:
    """A description, an explanation or an answer, which are dataclasses of plain fields, as data."""
    return dataclasses.asdict(value)


def description_of(data: Any) -> Description:
    """The description that data stands for.

    Raises:
        ValueError: It stands for none.
    """
    return _DESCRIPTION.validate_python(data)
