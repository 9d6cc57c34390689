"""The language between an agent and its visitors: JSON frames over a WebSocket, version 1.

What each frame means stands in ``docs/reference/web-protocol.md``. Nothing here reads or writes a connection: text
becomes a record, a record becomes text, and whatever is wrong with a text is a `ProtocolError`.

Example:
    >>> parse('{"type": "say", "id": "a1", "text": "hello"}', CLIENT)
    Say(id='a1', text='hello')
    >>> serialise(Typing(on=True))
    '{"type":"typing","on":true}'
"""

from __future__ import annotations

import dataclasses
import json
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, cast

from ravestate.errors import PlatformError, nearest
from ravestate.modules._text import printable

__all__ = [
    "CLIENT",
    "LONGEST_NAME",
    "SERVER",
    "VERSION",
    "Bye",
    "Ended",
    "Error",
    "Hello",
    "Message",
    "Piece",
    "Ping",
    "Pong",
    "ProtocolError",
    "Renamed",
    "Say",
    "Typing",
    "Welcome",
    "Writing",
    "heard_text",
    "name_of",
    "parse",
    "serialise",
]

VERSION = 1
"""Of the protocol. A frame or a field that is added does not change it; anything else does."""

LONGEST_NAME = 80
"""Characters of a name."""

LONGEST_TEXT = 10_000
"""Characters that a visitor says at once."""

GREATEST = 2**53 - 1
"""The greatest whole number that every JSON reader has."""


class ProtocolError(PlatformError, ValueError):
    """A frame that cannot be understood.

    Attributes:
        code: One word for programs, e.g. ``malformed``; the message is for people.
        id: Of the `Say` that is not taken, if it is one.
    """

    def __init__(self, code: str, message: str, id: str | None = None) -> None:
        super().__init__(message)
        self.code = code
        self.id = id


# ------------------------------------------------------------------------------------ from a client


@dataclass(frozen=True, slots=True)
class Hello:
    """The first frame: which version is spoken, and which conversation goes on.

    Attributes:
        v: The version.
        session: The conversation to take up; None begins one.
        last: The number of the last message that the client has.
        token: What the server asks for, if it asks for one.
        name: What the visitor is called, if it is known.
    """

    v: int
    session: str | None = None
    last: int = 0
    token: str | None = None
    name: str | None = None


@dataclass(frozen=True, slots=True)
class Say:
    """Something is said. The client chooses the `id`; what is sent twice under one is heard once."""

    id: str
    text: str


@dataclass(frozen=True, slots=True)
class Writing:
    """The visitor is writing something; sent now and then while that goes on."""


@dataclass(frozen=True, slots=True)
class Bye:
    """The visitor leaves for good."""


@dataclass(frozen=True, slots=True)
class Ping:
    """Is anybody there? For clients that cannot send pings of the WebSocket's own, as browsers."""


# ------------------------------------------------------------------------------------ from the server


@dataclass(frozen=True, slots=True)
class Welcome:
    """The answer to `Hello`.

    Attributes:
        v: The version that is spoken.
        session: The conversation: a secret, to be named after a lost connection.
        resumed: Whether it is the one that was asked for.
        first: The number of the oldest message that is kept.
        agent: What the agent is called.
        inside: Where its user may look inside of it, relative to the page; None: nowhere.
        last: The number of the newest message; 0 if nothing was said yet.
        writing: Whether the server takes `Writing`. The first ones did not.
    """

    v: int
    session: str
    resumed: bool
    first: int
    agent: str
    inside: str | None = None
    last: int = 0
    writing: bool = False


@dataclass(frozen=True, slots=True)
class Renamed:
    """What the agent is called from now on."""

    agent: str


@dataclass(frozen=True, slots=True)
class Message:
    """An utterance.

    Attributes:
        n: Its number: 1 for the first of the conversation, and so on, without gap.
        speaker: Who said it.
        text: Plain text.
        time: When (milliseconds since 1970, UTC).
        id: What the client called it, if it came from one.
    """

    n: int
    speaker: Literal["user", "agent"]
    text: str
    time: int
    id: str | None = None


@dataclass(frozen=True, slots=True)
class Piece:
    """A part of an utterance that is still being made: `text` replaces whatever stood from character `at` on (counted in
    UTF-16 units, as JavaScript does)."""

    at: int
    text: str


@dataclass(frozen=True, slots=True)
class Typing:
    """Whether the agent is about to say something."""

    on: bool


@dataclass(frozen=True, slots=True)
class Ended:
    """The conversation is over; the server closes the connection."""

    text: str


@dataclass(frozen=True, slots=True)
class Error:
    """What was wrong with a frame or a connection; `id` is that of the `Say` that was not taken, if it was one."""

    code: str
    text: str
    id: str | None = None


@dataclass(frozen=True, slots=True)
class Pong:
    """The answer to `Ping`."""


# ------------------------------------------------------------------------------------ the wire

Frame = (
    Hello | Say | Writing | Bye | Ping | Welcome | Renamed | Message | Piece | Typing | Ended | Error | Pong
)

CLIENT: Mapping[str, type[Any]] = {
    "hello": Hello,
    "say": Say,
    "writing": Writing,
    "bye": Bye,
    "ping": Ping,
}
"""The frames that a client sends, by the name that they have on the wire."""

SERVER: Mapping[str, type[Any]] = {
    "welcome": Welcome,
    "renamed": Renamed,
    "message": Message,
    "piece": Piece,
    "typing": Typing,
    "ended": Ended,
    "error": Error,
    "pong": Pong,
}
"""The frames that the server sends."""

_NAMES = {kind: name for kinds in (CLIENT, SERVER) for name, kind in kinds.items()}
_KEY = re.compile(r"[A-Za-z0-9_-]{1,64}")
_JOINERS = "\u200c\u200d"  # some languages are spelt with them, and emoji
_WIRE = {"speaker": "from"}  # a word of Python's own


def serialise(frame: Frame) -> str:
    """The text of a frame; what is None is left out."""
    fields: dict[str, Any] = {"type": _NAMES[type(frame)]}
    for field in dataclasses.fields(frame):
        value = getattr(frame, field.name)
        if value is not None:
            fields[_WIRE.get(field.name, field.name)] = value
    return json.dumps(fields, ensure_ascii=False, separators=(",", ":"))


def parse(text: str | bytes, frames: Mapping[str, type[Any]]) -> Any:
    """The frame that a text stands for. Fields that are not known are left aside.

    Args:
        text: What was received.
        frames: Which frames may come: `CLIENT` or `SERVER`.

    Raises:
        ProtocolError: It is none of them; the code is ``version`` for another version, that of `heard_text` for what is
            not heard, else ``malformed``.
    """
    if not isinstance(text, str):
        raise _malformed("a frame is a text message, not a binary one")
    try:
        found: object = json.loads(text)
    except (ValueError, RecursionError):
        raise _malformed(f"not JSON: {_short(text)}; a frame is an object: {_example(frames)}") from None
    if not isinstance(found, dict):
        raise _malformed(f"{_short(found)} is no object: write {_example(frames)}")
    given = cast("dict[str, Any]", found)
    name = given.get("type")
    kind = frames.get(name) if isinstance(name, str) else None
    if kind is None:
        hint = nearest(name, frames) if isinstance(name, str) else ""
        raise _malformed(f'"type": {_short(name)} is none of {", ".join(frames)}{hint}')
    values: dict[str, Any] = {}
    for field in dataclasses.fields(kind):
        wire = _WIRE.get(field.name, field.name)
        value = given.get(wire)
        read, wanted = _FIELDS[field.name]
        if value is None:
            if field.default is dataclasses.MISSING:
                raise _malformed(f'{name} lacks "{wire}": {wanted}')
            continue
        try:
            values[field.name] = read(value)
        except (TypeError, ValueError):
            raise _malformed(f'{name}: "{wire}": {_short(value)} is not {wanted}') from None
    if values.get("v", VERSION) != VERSION:
        raise ProtocolError("version", f'"v": {values["v"]}: this side speaks version {VERSION} only')
    if kind is Say:
        try:
            values["text"] = heard_text(values["text"])
        except ProtocolError as error:
            error.id = values["id"]
            raise
    return kind(**values)


def heard_text(text: str) -> str:
    """What is heard of a text that a visitor says: all but control characters.

    Raises:
        ProtocolError: It is not heard; the code is ``too-long`` for too much said at once, ``empty`` for a blank text.

    Example:
        >>> heard_text("\\x1b[31mred\\x1b[0m\\x00")
        'red'
    """
    text = printable(text)
    if len(text) > LONGEST_TEXT:
        raise ProtocolError(
            "too-long", f'say: "text" has at most {LONGEST_TEXT:,} characters, not {len(text):,}'
        )
    if not text.strip():
        raise ProtocolError("empty", 'say: "text" has nothing in it')
    return text


def name_of(text: str) -> str:
    """A text as a name that is shown among others: on one line, without characters that cannot be seen or turn others
    round. It may have nothing in it.

    Example:
        >>> name_of(" Ada\\u202e\\nLovelace ")
        'Ada Lovelace'
    """
    seen = "".join(c for c in printable(text) if c.isspace() or c.isprintable() or c in _JOINERS)
    return " ".join(seen.split())


def _malformed(message: str) -> ProtocolError:
    return ProtocolError("malformed", message)


def _example(frames: Mapping[str, type[Any]]) -> str:
    return '{"type": "hello", "v": 1}' if frames is CLIENT else '{"type": "pong"}'


def _short(value: object) -> str:
    text = value if isinstance(value, str) else repr(value)
    return repr(printable(text[:40])) + ("..." if len(text) > 40 else "")


def _whole(value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= GREATEST:
        raise ValueError
    return value


def _key(value: object) -> str:
    if not isinstance(value, str) or _KEY.fullmatch(value) is None:
        raise ValueError
    return value


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise TypeError
    return printable(value)


def _name(value: object) -> str:
    if not isinstance(value, str):
        raise TypeError
    text = name_of(value)
    if not 1 <= len(text) <= LONGEST_NAME:
        raise ValueError
    return text


def _speaker(value: object) -> str:
    if value not in ("user", "agent"):
        raise ValueError
    return cast("str", value)


def _truth(value: object) -> bool:
    if not isinstance(value, bool):
        raise TypeError
    return value


# Fields of one name are read alike in every frame: what reads them, and what they are to be.
_WHOLE_NUMBER = _whole, "a whole number from 0 on"
_ANY_TEXT = _text, "a text"
_NAME_OF = _key, "1 to 64 letters, digits, - or _"
_YES_OR_NO = _truth, "true or false"
_FIELDS: Mapping[str, tuple[Callable[[object], Any], str]] = {
    "agent": _ANY_TEXT,
    "at": _WHOLE_NUMBER,
    "code": _ANY_TEXT,
    "first": _WHOLE_NUMBER,
    "id": _NAME_OF,
    "inside": _ANY_TEXT,
    "last": _WHOLE_NUMBER,
    "n": _WHOLE_NUMBER,
    "name": (_name, f"a text of 1 to {LONGEST_NAME} characters"),
    "on": _YES_OR_NO,
    "resumed": _YES_OR_NO,
    "session": _NAME_OF,
    "speaker": (_speaker, '"user" or "agent"'),
    "text": _ANY_TEXT,
    "time": _WHOLE_NUMBER,
    "token": _ANY_TEXT,
    "v": (_whole, f"the version, {VERSION}"),
    "writing": _YES_OR_NO,
}
