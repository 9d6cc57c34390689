"""The board's protocol, version 1: JSON frames over a WebSocket between a board's page and its server.

A board shows a conversation or a recording (a recorded trace).

``docs/reference/board-protocol.md`` describes each frame. ``tools/protocol.py`` writes the page's TypeScript from this file.
"""

from __future__ import annotations

import dataclasses
import json
from dataclasses import dataclass
from typing import Annotated, Any, Literal, cast

import pydantic
from pydantic import Field, TypeAdapter

from ravestate.board.answer import WhyNot
from ravestate.board.description import Description
from ravestate.board.rendering import Rendered
from ravestate.board.wire import VERSION, TraceRecord
from ravestate.engine.explain import ActivationState
from ravestate.engine.reasons import LossReason, Verdict
from ravestate.modules.platform.webio.fields import CLOSING_CODES

__all__ = [
    "CLIENT", "CLOSING_CODES", "LOSSES", "SERVER", "VERDICTS", "VERSION", "Alive", "Answer", "Changed", "ClientFrame", "Clock",
    "Conversation", "Conversations", "Drawing", "DrawnEdge", "DrawnNode", "Emit", "Ended", "Error", "Explain", "Explained",
    "ExplainedClause", "Hello", "Look", "Ping", "Pong", "Put", "Records", "Renamed", "Say", "ServerFrame", "State", "Unfold",
    "Welcome", "Why", "fields_of", "parse", "serialise",
]  # fmt: skip

LOSSES: dict[str, str] = {reason.value: reason.words for reason in LossReason}
"""Reason for which an activation gave up a spike → a phrase for people."""

VERDICTS: dict[str, dict[str, str]] = {
    verdict.value: {"title": verdict.words, "tone": verdict.tone} for verdict in Verdict
}
"""Verdict → its title and its tone (the colour on the page)."""

Name = Annotated[str, Field(min_length=1, max_length=300)]


# ------------------------------------------------------------------------------------ from the page


class _Frame(pydantic.BaseModel):
    model_config = pydantic.ConfigDict(strict=True, frozen=True)


class Hello(_Frame):
    """The first frame: it names the conversation or the recording to show.

    If `session`, `visitor` and `recording` are missing, the server shows the recording that it was started with, or
    else the newest conversation. If there is no conversation, the server begins one.

    Attributes:
        v: The version of the protocol.
        session: The secret id of the conversation to show; the visitor's chat page has this id.
        visitor: The name of the conversation to show, as in `Conversations`.
        recording: The name of the uploaded recording to show.
        token: The server's token, if the server asks for one.
    """

    type: Literal["hello"]
    v: int
    session: str | None = None
    visitor: str | None = None
    recording: str | None = None
    token: str | None = None


class Clock(_Frame):
    """Stop the context's clock, perform the agent's next step while the clock is stopped, or start the clock again."""

    type: Literal["pause", "step", "resume"]


class Put(_Frame):
    """Write a slot from outside the rules."""

    type: Literal["put"]
    slot: Name
    value: Any = None


class Emit(_Frame):
    """Raise a signal from outside the rules."""

    type: Literal["emit"]
    signal: Name
    payload: Any = None


class Say(_Frame):
    """Say something as the visitor."""

    type: Literal["say"]
    text: Annotated[str, Field(min_length=1)]


class Look(_Frame):
    """A request for a `State`."""

    type: Literal["look"]


class Explain(_Frame):
    """A request for an `Explained`: the spikes that a rule holds and lacks now, and the rules that it waits for."""

    type: Literal["explain"]
    rule: Name


class Why(_Frame):
    """A request for an `Answer`: why a rule did not fire for the cause of a spike."""

    type: Literal["why"]
    rule: Name
    spike: int


class Unfold(_Frame):
    """A request for a `Drawing`: the modules `unfolded` show their rules; each other module is one node."""

    type: Literal["diagram"]
    unfolded: list[Name]


class Ping(_Frame):
    """A request for a `Pong`."""

    type: Literal["ping"]


# ------------------------------------------------------------------------------------ from the server


@dataclass(frozen=True)
class Welcome:
    """The answer to `Hello`.

    Attributes:
        v: The version of the protocol.
        title: The agent's name.
        live: Whether this is a running conversation, not a recording.
        visitor: The name of the conversation; None for a recording.
        whole: Whether the records that follow reach back to the start of the context.
        policy: The policy of the agent.
        now: The seconds since the context began.
        paused: Whether the context's clock is stopped.
    """

    v: int
    title: str
    live: bool
    visitor: str | None
    whole: bool
    policy: Description
    now: float
    paused: bool
    type: Literal["welcome"] = "welcome"


@dataclass(frozen=True, slots=True)
class Alive(ActivationState):
    """A live activation, and the name of its rule."""

    rule: str


@dataclass(frozen=True)
class State:
    """The values of all slots, and the live activations. For a recording: the slots' last values in the trace."""

    slots: dict[str, Rendered]
    activations: list[Alive]
    now: float
    paused: bool
    type: Literal["state"] = "state"


@dataclass(frozen=True)
class Records:
    """The next records of the trace, in order.

    Attributes:
        records: The records.
        missed: How many records the server left out just before these.
        behind: How many records the server has not sent yet.
    """

    records: list[TraceRecord]
    missed: int
    behind: int
    now: float
    paused: bool
    type: Literal["records"] = "records"


@dataclass(frozen=True)
class Renamed:
    """The agent's new name."""

    title: str
    type: Literal["renamed"] = "renamed"


@dataclass(frozen=True)
class Changed:
    """The new policy, after a rule was added."""

    policy: Description
    type: Literal["policy"] = "policy"


@dataclass(frozen=True)
class Conversation:
    """A conversation in a list.

    Attributes:
        visitor: The conversation's name.
        name: The name of the person; None if it is unknown.
        began: The time of its start, in milliseconds since 1970 (UTC).
        said: The start of the visitor's last words; None if they have said nothing.
    """

    visitor: str
    name: str | None
    began: int
    said: str | None


@dataclass(frozen=True)
class Conversations:
    """The newest conversations, oldest first; `more` is the number of conversations that the list leaves out."""

    conversations: list[Conversation]
    more: int
    type: Literal["conversations"] = "conversations"


@dataclass(frozen=True)
class ExplainedClause:
    """A clause: its effective utility (nats), and its slot predicates.

    Each predicate is a pair: the predicate as text, and whether it is true now.
    """

    effective: float
    gates: tuple[tuple[str, bool], ...]


@dataclass(frozen=True)
class Explained:
    """The current state of a rule: the spikes that it holds and lacks, and the rules that it waits for."""

    rule: str
    now: float
    retired: bool
    clauses: list[ExplainedClause]
    activations: list[ActivationState]
    type: Literal["explained"] = "explained"


@dataclass(frozen=True, slots=True)
class Answer(WhyNot):
    """The answer to `Why`: why a rule did not fire."""

    type: Literal["why"] = "why"


Box = tuple[float, float, float, float]


@dataclass(frozen=True)
class DrawnNode:
    """A node of the diagram; `box` is its left, top, width and height (pixels)."""

    id: str
    kind: Literal["slot", "signal", "rule", "and", "or", "module"]
    label: str
    module: str
    note: str
    box: Box


@dataclass(frozen=True)
class DrawnEdge:
    """An edge of the diagram: the points of its line, and the box of its label (pixels)."""

    source: str
    target: str
    kind: str
    label: str
    points: list[tuple[float, float]]
    box: Box | None


@dataclass(frozen=True)
class Drawing:
    """The diagram: the modules `unfolded` show their rules; each other module is one node. Lengths are in pixels."""

    unfolded: list[str]
    width: float
    height: float
    nodes: list[DrawnNode]
    edges: list[DrawnEdge]
    type: Literal["diagram"] = "diagram"


@dataclass(frozen=True)
class Ended:
    """The conversation is over; `text` says why. The server then closes the connection."""

    text: str
    type: Literal["ended"] = "ended"


@dataclass(frozen=True)
class Error:
    """A fault in a frame from the page, or in the connection.

    Attributes:
        code: One word for programs.
        text: An explanation for people.
        of: The type of the refused frame; empty if the fault is not in a frame that the server could read.
    """

    code: str
    text: str
    of: str = ""
    type: Literal["error"] = "error"


@dataclass(frozen=True)
class Pong:
    """The answer to `Ping`."""

    type: Literal["pong"] = "pong"


ClientFrame = Hello | Clock | Put | Emit | Say | Look | Explain | Why | Unfold | Ping
ServerFrame = (
    Welcome | State | Records | Renamed | Changed | Conversations | Explained | Answer | Drawing | Ended | Error | Pong
)  # fmt: skip

_BY_TYPE = Field(discriminator="type")
CLIENT: TypeAdapter[ClientFrame] = TypeAdapter(Annotated[ClientFrame, _BY_TYPE])
"""The frames that a page sends."""
SERVER: TypeAdapter[ServerFrame] = TypeAdapter(Annotated[ServerFrame, _BY_TYPE])
"""The frames that the server sends."""


def parse(text: str | bytes) -> ClientFrame:
    """Return the frame that a JSON text describes.

    Raises:
        ValueError: The text is not a frame; the message says why.
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
        return CLIENT.validate_python(data)
    except pydantic.ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        place = ".".join(str(part) for part in first["loc"][1:])
        kind = str(cast("dict[str, Any]", data).get("type"))[:40]
        raise ValueError(f"{kind}: {place + ': ' if place else ''}{first['msg']}") from None


def serialise(frame: ServerFrame) -> str:
    """Return a frame as JSON text. Leave out fields that have their default values, except ``type``.

    The text is ASCII, because values may hold lone surrogates, which UTF-8 cannot encode.
    """
    return json.dumps(frame, separators=(",", ":"), default=_changed)


def fields_of(record: Any) -> dict[str, Any]:
    """Return a map from a dataclass instance's field names to its values. The values are not copied."""
    return {field.name: getattr(record, field.name) for field in dataclasses.fields(record)}


def _changed(record: Any) -> dict[str, Any]:
    defaults = {field.name: field.default for field in dataclasses.fields(record) if field.name != "type"}
    return {name: value for name, value in fields_of(record).items() if value is not defaults.get(name, _NONE)}


_NONE = object()
