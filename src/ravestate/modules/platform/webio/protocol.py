"""The web protocol, version 1: JSON frames, and sound, over a WebSocket between an agent and its visitors.

``docs/reference/web-protocol.md`` describes each frame. ``tools/protocol.py`` writes the page's TypeScript from this file.
Nothing here reads or writes a connection: `parse` and `serialise` translate between text and records.

Example:
    >>> parse('{"type": "say", "id": "a1", "text": "hello"}', CLIENT)
    Say(id='a1', text='hello', type='say')
    >>> serialise(Typing(on=True))
    '{"type":"typing","on":true}'
"""

from __future__ import annotations

import functools
import json
from dataclasses import dataclass
from typing import Annotated, Any, Literal, TypeVar, cast

from pydantic import AfterValidator, Field, TypeAdapter, ValidationError

from ravestate.errors import PlatformError, nearest
from ravestate.modules._text import printable

__all__ = [
    "CLIENT", "CLOSING_CODES", "LONGEST_NAME", "LONGEST_TEXT", "SERVER", "VERSION", "Bye", "ClientFrame", "Ended",
    "Caption", "Error", "Flush", "Heard", "Hello", "Hush", "Listening", "Message", "Microphone", "Paused", "Piece", "Ping", "Played",
    "Pong", "ProtocolError", "Renamed", "Say", "ServerFrame", "Taken", "Typing", "Welcome", "Writing", "heard_text",
    "LONGEST_SOUND", "name_of", "parse", "serialise", "sound_of",
]  # fmt: skip

VERSION = 1
"""The version of the protocol. A new frame or field keeps this number; any other change increases it."""

LONGEST_NAME = 80
"""The maximum number of characters in a visitor's name."""

LONGEST_TEXT = 10_000
"""The maximum number of characters in one utterance of a visitor."""

LONGEST_SOUND = 32_000
"""The maximum number of bytes of sound in one frame from a client: 1 s."""

GREATEST = 2**53 - 1
"""The greatest whole number that every JSON reader can hold."""

CLOSING_CODES = {
    "ended": 1000,
    "closing": 1001,
    "too-large": 1009,
    "full": 1013,
    "malformed": 4400,
    "token": 4401,
    "gone": 4404,
    "silent": 4408,
    "behind": 4409,
}
"""Error code → the WebSocket's closing code; any other error closes with the code of ``malformed``."""


class ProtocolError(PlatformError, ValueError):
    """A frame that cannot be understood.

    Attributes:
        code: One word for programs, e.g. ``malformed``; the message is for people.
        id: The refused frame's `id`, if that frame is a `Say`.
    """

    def __init__(self, code: str, message: str, id: str | None = None) -> None:
        super().__init__(message)
        self.code = code
        self.id = id


def heard_text(text: str) -> str:
    """Return the text of a visitor's utterance without control characters.

    Raises:
        ProtocolError: The code is ``too-long`` for too many characters, ``empty`` for a blank text.

    Example:
        >>> heard_text("\\x1b[31mred\\x1b[0m\\x00")
        'red'
    """
    text = printable(text)
    if len(text) > LONGEST_TEXT:
        raise ProtocolError("too-long", f'say: "text" has at most {LONGEST_TEXT:,} characters, not {len(text):,}')
    if not text.strip():
        raise ProtocolError("empty", 'say: "text" has nothing in it')
    return text


def sound_of(data: bytes) -> bytes:
    """Return the sound in a binary frame from a client.

    Raises:
        ProtocolError: The frame does not hold whole samples, or holds too many.
    """
    if not 0 < len(data) <= LONGEST_SOUND or len(data) % 2:
        raise _malformed(
            f"sound is 1 to {LONGEST_SOUND // 2:,} samples of two bytes (16 kHz, mono, little-endian), not {len(data):,} bytes"
        )
    return data


def name_of(text: str) -> str:
    """Return a text as one line, without invisible characters or characters that change the writing direction.

    Example:
        >>> name_of(" Ada\\u202e\\nLovelace ")
        'Ada Lovelace'
    """
    joiners = "\u200c\u200d"  # some languages and emoji need them
    seen = "".join(c for c in printable(text) if c.isspace() or c.isprintable() or c in joiners)
    return " ".join(seen.split())


# ------------------------------------------------------------------------------------ fields


def _name(text: str) -> str:
    if not 1 <= len(name := name_of(text)) <= LONGEST_NAME:
        raise ValueError
    return name


def _spoken(version: int) -> int:
    if version != VERSION:
        raise ProtocolError("version", f'"v": {version}: this side speaks version {VERSION} only')
    return version


# An error message about a refused value contains the description of the expected type.
Number = Annotated[int, Field(strict=True, ge=0, le=GREATEST, description="a whole number from 0 on")]
Version = Annotated[Number, AfterValidator(_spoken), Field(description=f"the version, {VERSION}")]
Truth = Annotated[bool, Field(strict=True, description="true or false")]
String = Annotated[str, Field(strict=True, description="a text")]
Text = Annotated[String, AfterValidator(printable)]
Spoken = Annotated[String, AfterValidator(heard_text)]
Name = Annotated[
    str, Field(strict=True, description=f"a text of 1 to {LONGEST_NAME} characters"), AfterValidator(_name)
]
Id = Annotated[str, Field(strict=True, pattern=r"^[A-Za-z0-9_-]{1,64}$", description="1 to 64 letters, digits, - or _")]
Speaker = Annotated[Literal["user", "agent"], Field(alias="from", description='"user" or "agent"')]


# ------------------------------------------------------------------------------------ from a client


@dataclass(frozen=True, slots=True)
class Hello:
    """The first frame: it asks for a conversation.

    Attributes:
        v: The version of the protocol.
        session: The id of the conversation to resume; if it is missing, a new conversation begins.
        last: The number of the last message that the client has; 0 if it has none.
        token: The server's token, if the server asks for one.
        name: The visitor's name, if it is known.
    """

    v: Version
    session: Id | None = None
    last: Number = 0
    token: String | None = None
    name: Name | None = None
    type: Literal["hello"] = "hello"


@dataclass(frozen=True, slots=True)
class Say:
    """The visitor says something. A text that arrives twice under one `id` counts once."""

    id: Id
    text: Spoken
    type: Literal["say"] = "say"


@dataclass(frozen=True, slots=True)
class Writing:
    """The visitor is typing; the client repeats this frame while they type."""

    type: Literal["writing"] = "writing"


@dataclass(frozen=True, slots=True)
class Bye:
    """The visitor leaves for good."""

    type: Literal["bye"] = "bye"


@dataclass(frozen=True, slots=True)
class Ping:
    """A request for a `Pong`. Browsers need it: they cannot send the WebSocket's own pings."""

    type: Literal["ping"] = "ping"


@dataclass(frozen=True, slots=True)
class Microphone:
    """The visitor's microphone goes on or off in this window.

    While it is on, binary frames carry its sound, and this window plays the agent's sound. At most one window of a
    conversation has it: the last one that turned it on.
    """

    on: Truth
    type: Literal["microphone"] = "microphone"


@dataclass(frozen=True, slots=True)
class Played:
    """The loudspeaker's position. While sound plays, the client sends this frame every 100 ms, and at the sound's end.

    Attributes:
        n: The number of the stream, from the last `Flush`.
        samples: The number of samples of this stream that the loudspeaker has played.
    """

    n: Number
    samples: Number
    type: Literal["played"] = "played"


@dataclass(frozen=True, slots=True)
class Hush:
    """The visitor asks the agent to stop speaking."""

    type: Literal["hush"] = "hush"


# ------------------------------------------------------------------------------------ from the server


@dataclass(frozen=True, slots=True)
class Welcome:
    """The answer to `Hello`.

    Attributes:
        v: The version of the protocol.
        session: The conversation's secret id; a client sends it to resume.
        resumed: Whether this resumes the conversation that the client asked for.
        first: The number of the oldest message that the server keeps.
        agent: The agent's name.
        inside: The address of the board for this conversation, relative to the page; None without a board.
        last: The number of the newest message; 0 before the first message.
        writing: Whether the server accepts `Writing` frames. Early server releases did not.
        suggestions: A few things that the visitor could say first.
        note: A line of text that the page shows until the visitor has said something; None for no line.
        voice: Whether the agent can hear and speak: the server accepts `Microphone` and sound.
    """

    v: Version
    session: Id
    resumed: Truth
    first: Number
    agent: Text
    inside: Text | None = None
    last: Number = 0
    writing: Truth = False
    suggestions: tuple[Text, ...] = ()
    note: Text | None = None
    voice: Truth | None = None
    type: Literal["welcome"] = "welcome"


@dataclass(frozen=True, slots=True)
class Renamed:
    """The agent's new name."""

    agent: Text
    type: Literal["renamed"] = "renamed"


@dataclass(frozen=True, slots=True)
class Message:
    """An utterance.

    Attributes:
        n: The message's number: the first message of a conversation has 1, and no number is left out.
        speaker: The side that said the utterance.
        text: Plain text.
        time: The time of the utterance, in milliseconds since 1970 (UTC).
        id: The `id` of the client's `Say`, if the utterance came from a `Say`.
        heard: The part of the utterance that the visitor heard, if the agent's speech was cut.
    """

    n: Number
    speaker: Speaker
    text: Text
    time: Number
    id: Id | None = None
    heard: Text | None = None
    type: Literal["message"] = "message"


@dataclass(frozen=True, slots=True)
class Piece:
    """A piece of an utterance that is still growing: `text` replaces everything from character `at` on.

    Attributes:
        at: The position in the utterance where `text` begins, in UTF-16 units as JavaScript counts.
        text: The utterance from `at` to its new end.
    """

    at: Number
    text: Text
    type: Literal["piece"] = "piece"


@dataclass(frozen=True, slots=True)
class Typing:
    """Whether the agent is working on an answer."""

    on: Truth
    type: Literal["typing"] = "typing"


@dataclass(frozen=True, slots=True)
class Paused:
    """Whether the agent's clock is paused, for example by the board."""

    on: Truth
    type: Literal["paused"] = "paused"


@dataclass(frozen=True, slots=True)
class Caption:
    """The words so far of an utterance that the visitor is still speaking; empty once it has become a `Message`."""

    text: Text
    type: Literal["caption"] = "caption"


@dataclass(frozen=True, slots=True)
class Heard:
    """The part of a message of the agent that the visitor heard: all of it, unless the agent's speech was cut.

    Attributes:
        n: The message's number.
        text: The part that was heard.
    """

    n: Number
    text: Text
    type: Literal["heard"] = "heard"


@dataclass(frozen=True, slots=True)
class Flush:
    """The client drops all sound that it has not played. The sound after this frame is a new stream.

    Attributes:
        n: The number of the new stream.
    """

    n: Number
    type: Literal["flush"] = "flush"


@dataclass(frozen=True, slots=True)
class Listening:
    """The agent takes the sound of this window's microphone. The agent may have had to load its models first."""

    type: Literal["listening"] = "listening"


@dataclass(frozen=True, slots=True)
class Taken:
    """This window no longer has the microphone; `text` says why."""

    text: Text
    type: Literal["taken"] = "taken"


@dataclass(frozen=True, slots=True)
class Ended:
    """The conversation is over; `text` says why. The server then closes the connection."""

    text: Text
    type: Literal["ended"] = "ended"


@dataclass(frozen=True, slots=True)
class Error:
    """A fault in a frame from the client, or in the connection.

    Attributes:
        code: One word for programs.
        text: An explanation for people.
        id: The refused frame's `id`, if that frame is a `Say`.
    """

    code: Text
    text: Text
    id: Id | None = None
    type: Literal["error"] = "error"


@dataclass(frozen=True, slots=True)
class Pong:
    """The answer to `Ping`."""

    type: Literal["pong"] = "pong"


ClientFrame = Hello | Say | Writing | Bye | Ping | Microphone | Played | Hush
ServerFrame = (
    Welcome
    | Renamed
    | Message
    | Piece
    | Typing
    | Paused
    | Caption
    | Heard
    | Flush
    | Listening
    | Taken
    | Ended
    | Error
    | Pong
)

_BY_TYPE = Field(discriminator="type")
CLIENT: TypeAdapter[ClientFrame] = TypeAdapter(Annotated[ClientFrame, _BY_TYPE])
"""The frames that a client sends."""
SERVER: TypeAdapter[ServerFrame] = TypeAdapter(Annotated[ServerFrame, _BY_TYPE])
"""The frames that the server sends."""
_FRAMES: TypeAdapter[ClientFrame | ServerFrame] = TypeAdapter(Annotated[ClientFrame | ServerFrame, _BY_TYPE])


# ------------------------------------------------------------------------------------ text to record, and back

F = TypeVar("F")


def serialise(frame: ClientFrame | ServerFrame) -> str:
    """Return a frame as JSON text, without the fields that are None."""
    fields = _FRAMES.dump_python(frame, by_alias=True, exclude_none=True)
    return json.dumps({"type": frame.type, **fields}, ensure_ascii=False, separators=(",", ":"))


def parse(text: str | bytes, frames: TypeAdapter[F]) -> F:
    """Return the frame that a JSON text describes. Unknown fields are ignored; null counts as a missing field.

    Args:
        text: The message that was received.
        frames: The kinds of frames to accept: `CLIENT` or `SERVER`.

    Raises:
        ProtocolError: The text is not such a frame. The code is ``version`` for another version, ``too-long`` or
            ``empty`` for a `Say` whose text is refused, else ``malformed``.
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
    """Return frame type → field → the description of the field's value, from the JSON schema."""
    schema = frames.json_schema()
    kinds = (schema["$defs"][kind["$ref"].rpartition("/")[2]]["properties"] for kind in schema["oneOf"])
    return {
        kind["type"]["const"]: {
            wire: str(field.get("description") or field.get("anyOf", [{}])[0].get("description"))
            for wire, field in kind.items()
        }
        for kind in kinds
    }


def _malformed(message: str) -> ProtocolError:
    return ProtocolError("malformed", message)


def _short(value: object) -> str:
    text = value if isinstance(value, str) else repr(value)
    return repr(printable(text[:40])) + ("..." if len(text) > 40 else "")
