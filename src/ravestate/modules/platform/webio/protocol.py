"""The web protocol, version 1: JSON frames, sound and pictures over a WebSocket between an agent and its visitors.

``docs/reference/web-protocol.md`` describes each frame. The records are in `frames`, the types of their fields in `fields`.
This file reads and writes no connection: `parse` and `serialise` translate between text and records.

Example:
    >>> from ravestate.modules.platform.webio.frames import Typing
    >>> parse('{"type": "say", "id": "a1", "text": "hello"}', CLIENT)
    Say(id='a1', text='hello', type='say')
    >>> serialise(Typing(on=True))
    '{"type":"typing","on":true}'
"""

from __future__ import annotations

import functools
import json
from typing import Any, TypeVar, cast

from pydantic import TypeAdapter, ValidationError

from ravestate.errors import nearest
from ravestate.modules._text import printable

from .fields import LONGEST_PICTURE, LONGEST_SOUND, ProtocolError
from .frames import CLIENT, FRAMES, ClientFrame, ServerFrame

F = TypeVar("F")


def serialise(frame: ClientFrame | ServerFrame) -> str:
    """Return a frame as JSON text, without the fields that are None."""
    fields = FRAMES.dump_python(frame, by_alias=True, exclude_none=True)
    return json.dumps({"type": frame.type, **fields}, ensure_ascii=False, separators=(",", ":"))


def parse(text: str | bytes, frames: TypeAdapter[F]) -> F:
    """Return the frame that a JSON text describes. Unknown fields are ignored; null counts as a missing field.

    Args:
        text: The message that was received.
        frames: The kinds of frames to accept: `CLIENT` or `SERVER`.

    Raises:
        ProtocolError: The text is not such a frame. The code is ``version`` for another version of the protocol,
            ``too-long`` or ``empty`` for a `Say` whose text is refused, else ``malformed``.
    """
    if not isinstance(text, str):
        raise _malformed("a frame is a text message, not a binary one")
    example = '{"type": "hello", "v": 1}' if frames is CLIENT else '{"type": "pong"}'
    try:
        found: object = json.loads(text)
    except (ValueError, RecursionError):
        raise _malformed(f"not JSON: {_short(text)}; a frame is an object: {example}") from None
    if not isinstance(found, dict):
        raise _malformed(f"{_short(found)} is not an object: write {example}")
    fields = {key: value for key, value in cast("dict[str, Any]", found).items() if value is not None}
    try:
        return frames.validate_python(fields)
    except ValidationError as error:
        raise _explained(error, fields, frames) from None


def _explained(error: ValidationError, fields: dict[str, Any], frames: TypeAdapter[Any]) -> ProtocolError:
    """Return an error that explains the first fault in pydantic's list."""
    fault = error.errors(include_url=False)[0]
    refused = fault.get("ctx", {}).get("error")
    if isinstance(refused, ProtocolError):
        refused.id = fields["id"] if fields["type"] == "say" else None
        return refused
    expected = _expected(frames)
    if not fault["loc"]:
        name = fields.get("type")
        hint = nearest(name, expected) if isinstance(name, str) else ""
        return _malformed(f'"type": {_short(name)} is none of {", ".join(expected)}{hint}')
    name, wire = str(fault["loc"][0]), str(fault["loc"][1])
    if fault["type"] == "missing":
        return _malformed(f'{name} lacks "{wire}": {expected[name][wire]}')
    return _malformed(f'{name}: "{wire}": {_short(fields[wire])} is not {expected[name][wire]}')


@functools.cache
def _expected(frames: TypeAdapter[Any]) -> dict[str, dict[str, str]]:
    """Return what each field of each frame type expects, in words from the JSON schema."""
    schema = frames.json_schema()
    kinds = (schema["$defs"][kind["$ref"].rpartition("/")[2]]["properties"] for kind in schema["oneOf"])
    return {
        kind["type"]["const"]: {
            wire: str(field.get("description") or field.get("anyOf", [{}])[0].get("description"))
            for wire, field in kind.items()
        }
        for kind in kinds
    }


def sound_of(data: bytes) -> bytes:
    """Return the sound in a binary frame from a client.

    Raises:
        ProtocolError: The frame is empty or too long, or ends in the middle of a sample.
    """
    if not 0 < len(data) <= LONGEST_SOUND or len(data) % 2:
        raise _malformed(
            f"sound is 1 to {LONGEST_SOUND // 2:,} samples of two bytes (16 kHz, mono, little-endian), not {len(data):,} bytes"
        )
    return data


def picture_of(data: bytes) -> bytes:
    """Return the picture in a binary frame from a client.

    Raises:
        ProtocolError: The frame is not a JPEG, or is too large.
    """
    if len(data) > LONGEST_PICTURE or not data.startswith(b"\xff\xd8\xff"):
        raise _malformed(
            f"a picture is a JPEG of at most {LONGEST_PICTURE:,} bytes, not {len(data):,} bytes: {data[:4]!r}"
        )
    return data


def _malformed(message: str) -> ProtocolError:
    return ProtocolError("malformed", message)


def _short(value: object) -> str:
    text = value if isinstance(value, str) else repr(value)
    return repr(printable(text[:40])) + ("..." if len(text) > 40 else "")
