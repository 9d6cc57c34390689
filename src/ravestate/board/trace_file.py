"""Recorded traces: a JSON file with the policy and what happened, to be looked at without the agent."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

from ravestate.board.description import Description, describe
from ravestate.board.recorder import Gap
from ravestate.board.shown import well_formed
from ravestate.board.wire import VERSION, data_of, description_of, record_of, whole_data
from ravestate.engine.trace import Record
from ravestate.errors import PlatformError
from ravestate.policy.policy import Policy

__all__ = ["FORMAT", "Recording", "open_trace", "read_trace", "save_trace"]

FORMAT = "ravestate-trace"

SURROGATE = re.compile(r"\\u[dD][89a-fA-F]")
"""Half of a pair, as JSON spells it."""


@dataclass(frozen=True, slots=True)
class Recording:
    """A trace that was recorded, and the policy that it is of.

    Attributes:
        title: What the agent was called.
        whole: Whether it begins with the context.
    """

    title: str
    description: Description
    records: tuple[Record | Gap, ...]
    whole: bool


def save_trace(
    path: Path,
    policy: Policy,
    records: Iterable[Record | Gap],
    *,
    title: str = "Ravestate",
    whole: bool = True,
) -> None:
    """Write a trace to a file that the board opens; ``context.trace`` of a context with ``trace=True`` is one.

    Raises:
        OSError: The file cannot be written.
    """
    data = {
        "format": FORMAT,
        "v": VERSION,
        "title": title,
        "whole": whole,
        "policy": whole_data(describe(policy)),
        "records": [data_of(record) for record in records],
    }
    path.write_text(well_formed(json.dumps(data, ensure_ascii=False)), encoding="utf-8")


def open_trace(path: Path) -> Recording:
    """Read a trace from a file.

    Raises:
        PlatformError: It cannot be read, or is no trace.
    """
    try:
        return read_trace(path.read_bytes())
    except OSError as error:
        raise PlatformError(f"cannot read {path}: {error.strerror}") from None
    except ValueError as error:
        raise PlatformError(f"{path} is no trace: {error}") from None


def read_trace(text: str | bytes) -> Recording:
    """Read a trace. Texts in it that no encoding carries, as they have lone surrogates, are mended.

    Raises:
        ValueError: It is none; the message says where it is wrong.
    """
    try:
        found = _parsed(text)
    except (ValueError, RecursionError):
        raise ValueError("it is not JSON") from None
    if not isinstance(found, dict) or cast("dict[str, Any]", found).get("format") != FORMAT:
        raise ValueError(f'it lacks "format": "{FORMAT}"')
    data = cast("dict[str, Any]", found)
    if data.get("v") != VERSION:
        raise ValueError(f'"v": {str(data.get("v"))[:20]}: this release reads version {VERSION}')
    records: Any = data.get("records")
    if not isinstance(records, list):
        raise ValueError('"records" must be a list')
    read: list[Record | Gap] = []
    for number, record in enumerate(cast("list[Any]", records)):
        try:
            read.append(record_of(record))
        except ValueError as error:
            raise ValueError(f"record {number}: {_first(error)}") from None
    try:
        description = description_of(data.get("policy"))
    except ValueError as error:
        raise ValueError(f'"policy": {_first(error)}') from None
    return Recording(
        str(data.get("title", "Ravestate"))[:80], description, tuple(read), data.get("whole") is True
    )


def _parsed(text: str | bytes) -> Any:
    """What JSON stands for, its texts well formed."""
    if isinstance(text, bytes):
        text = text.decode("utf-8-sig", "surrogatepass")
    text = well_formed(text)
    found = json.loads(text)
    if SURROGATE.search(text) is None:
        return found
    return json.loads(well_formed(json.dumps(found, ensure_ascii=False)))


def _first(error: ValueError) -> str:
    """The first of what pydantic has to say, in one line."""
    errors: Any = getattr(error, "errors", None)
    if errors is None:
        return str(error)
    first = errors()[0]
    place = ".".join(str(part) for part in first["loc"])
    return f"{place}: {first['msg']}" if place else str(first["msg"])
