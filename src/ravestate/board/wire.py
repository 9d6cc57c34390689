"""Trace records and values as plain data for JSON, and back.

A record has the name and fields of its class in ``ravestate.engine.trace``. A value is a `Rendered`.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from operator import attrgetter
from typing import TYPE_CHECKING, Annotated, Any, Literal, NotRequired, Union, cast, get_args, get_type_hints

import pydantic
import typing_extensions

from ravestate.board.recorder import Gap
from ravestate.board.rendering import Rendered, render, traceback_of
from ravestate.engine.trace import Record

VERSION = 1
"""The version of the protocol and of trace files. A new field or a new kind of record does not change this number; any
other change increases it."""

PAYLOAD = 400  # the maximum number of characters of a payload in a record
VALUE = 2000  # the maximum number of characters of a slot's value

KINDS: dict[str, type[Any]] = {kind.__name__.lower(): kind for kind in (*get_args(Record), Gap)}
"""Name of a kind of record → its class."""

RENDERED = {"payload": PAYLOAD, "value": VALUE}
"""Name of a field that is rendered as text → the maximum number of characters."""


def _shape(name: str, kind: type[Any]) -> Any:
    """Return a `TypedDict`: the type that records of the class `kind` have as plain data."""
    hints = get_type_hints(kind)
    fields: dict[str, Any] = {"kind": Literal[name]}
    for field in dataclasses.fields(kind):
        sort = Rendered if field.name in RENDERED else str if field.name == "error" else hints[field.name]
        required = field.default is dataclasses.MISSING
        fields[field.name.rstrip("_")] = sort if required else NotRequired[sort]
    make: Any = typing_extensions.TypedDict
    made = make(kind.__name__, fields)
    made.__doc__ = kind.__doc__
    return made


if TYPE_CHECKING:
    TraceRecord = dict[str, Any]
else:
    TraceRecord = typing_extensions.TypeAliasType(
        "TraceRecord",
        Annotated[
            Union[tuple(_shape(name, kind) for name, kind in KINDS.items())],  # noqa: UP007  # known only at run time
            pydantic.Field(discriminator="kind"),
        ],
    )


def data_of(record: Record | Gap) -> TraceRecord:
    """Return a record as plain data for JSON."""
    return _WRITERS[type(record)](record)


def checked_record(data: TraceRecord) -> Record | Gap:
    """Return the record that `data` describes. The data must be valid."""
    fields = {f"{name}_" if name == "for" else name: value for name, value in data.items()}
    return KINDS[fields.pop("kind")](**fields)


def rendered_data(rendered: Rendered) -> dict[str, Any]:
    """Return a rendered value as plain data, without the fields that have their default values."""
    return (
        {"text": rendered.text} | ({} if rendered.json else {"json": False}) | ({"cut": True} if rendered.cut else {})
    )


def _quickly(value: Any) -> dict[str, Any] | None:
    """Return the data that `render` would make of a frequent kind of value; None for any other value."""
    frequent = value is None or value is True or value is False
    if frequent or (type(value) is str and len(value) < 60 and value.isascii()):
        return {"text": json.dumps(value)}
    return None


def _writer(name: str, kind: type[Any]) -> Callable[[Any], dict[str, Any]]:
    fields = [field.name for field in dataclasses.fields(kind)]
    keys = ("kind", *(field.rstrip("_") for field in fields))
    get = attrgetter(*fields)
    rendered = next((field for field in fields if field in RENDERED), None)
    bounded, fails = "until" in fields, "error" in fields

    def write(record: Any) -> dict[str, Any]:
        data = dict(zip(keys, (name, *get(record)), strict=True))
        data["time"] = round(cast("float", data["time"]), 6)
        if bounded and data["until"] is not None:
            data["until"] = round(cast("float", data["until"]), 6)
        if fails and (error := data.pop("error")) is not None:
            data["error"] = error if isinstance(error, str) else traceback_of(error)
        if rendered is not None:
            value = data[rendered]
            data[rendered] = _quickly(value) or rendered_data(
                value if type(value) is Rendered else render(value, RENDERED[rendered])
            )
        return data

    return write


_WRITERS = {kind: _writer(name, kind) for name, kind in KINDS.items()}
