"""What an inspector may say: JSON frames, read strictly."""

from __future__ import annotations

import json
from typing import Annotated, Any, Literal, cast

import pydantic

__all__ = [
    "Command", "Diagram", "Emit", "Explain", "Hello", "Look", "Pause", "Ping", "Put", "Resume", "Say", "Step", "Why", "parse",
]  # fmt: skip

Name = Annotated[str, pydantic.Field(min_length=1, max_length=300)]


class _Frame(pydantic.BaseModel):
    model_config = pydantic.ConfigDict(strict=True, frozen=True)


class Hello(_Frame):
    """The first frame: which version is spoken, and what is looked at.

    Attributes:
        session: The secret of a conversation; its visitor's own page has it.
        visitor: The name of a conversation, as `Conversations` lists it.
        recording: The number of a recording that was sent to be looked at.
        token: What the server asks for, if it asks for one.

    Without any of the first three it is the recording that the server was started with, else the newest conversation; a
    new one is begun if there is none.
    """

    type: Literal["hello"]
    v: int
    session: str | None = None
    visitor: str | None = None
    recording: str | None = None
    token: str | None = None


class Pause(_Frame):
    """Halt the context's clock."""

    type: Literal["pause"]


class Step(_Frame):
    """Do one thing more."""

    type: Literal["step"]


class Resume(_Frame):
    """Let the context's clock go on."""

    type: Literal["resume"]


class Put(_Frame):
    """Write a slot."""

    type: Literal["put"]
    slot: Name
    value: Any = None


class Emit(_Frame):
    """Raise a signal."""

    type: Literal["emit"]
    signal: Name
    payload: Any = None


class Say(_Frame):
    """Say something, as the visitor."""

    type: Literal["say"]
    text: Annotated[str, pydantic.Field(min_length=1)]


class Look(_Frame):
    """Ask for the values of all slots and for what is alive."""

    type: Literal["look"]


class Explain(_Frame):
    """Ask what a rule holds, lacks and waits for, now."""

    type: Literal["explain"]
    rule: Name


class Why(_Frame):
    """Ask why a rule did not fire for the cause of a spike."""

    type: Literal["why"]
    rule: Name
    spike: int


class Diagram(_Frame):
    """Ask for the diagram with some modules unfolded."""

    type: Literal["diagram"]
    unfolded: list[Name]


class Ping(_Frame):
    """Is anybody there?"""

    type: Literal["ping"]


Command = Hello | Pause | Step | Resume | Put | Emit | Say | Look | Explain | Why | Diagram | Ping
_COMMANDS: pydantic.TypeAdapter[Command] = pydantic.TypeAdapter(
    Annotated[Command, pydantic.Field(discriminator="type")]
)


def parse(text: str | bytes) -> Command:
    """The command that a frame stands for.

    Raises:
        ValueError: It stands for none; the message says why.

    Example:
        >>> parse('{"type": "why", "rule": "demo:talk", "spike": 3}')
        Why(type='why', rule='demo:talk', spike=3)
    """
    if not isinstance(text, str):
        raise ValueError("a frame is a text message, not a binary one")
    try:
        data: Any = json.loads(text)
    except (ValueError, RecursionError):
        raise ValueError(f"not JSON: {text[:40]!r}") from None
    if not isinstance(data, dict):
        raise ValueError('a frame is an object: {"type": "hello", "v": 1}')
    try:
        return _COMMANDS.validate_python(data)
    except pydantic.ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        place = ".".join(str(part) for part in first["loc"][1:])
        kind = str(cast("dict[str, Any]", data).get("type"))[:40]
        raise ValueError(f"{kind}: {place + ': ' if place else ''}{first['msg']}") from None
