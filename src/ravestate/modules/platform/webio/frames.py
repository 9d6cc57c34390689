"""The frames of the web protocol, as records. ``docs/reference/web-protocol.md`` describes them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import Field, TypeAdapter

from .fields import Id, Name, Number, Share, Speaker, Spoken, String, Text, Truth, Version

# ------------------------------------------------------------------------------------ from a client


@dataclass(frozen=True, slots=True)
class Hello:
    """The first frame: the client asks for a new conversation, or resumes one.

    Attributes:
        v: The version of the protocol.
        session: The id of the conversation to resume. Without it, or if that conversation is over, a new one begins.
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
    """The visitor says something. The server ignores a second `Say` with the same `id`."""

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
    """A request for a `Pong`. It exists because browsers cannot send the WebSocket's own pings."""

    type: Literal["ping"] = "ping"


@dataclass(frozen=True, slots=True)
class Microphone:
    """The visitor's microphone goes on or off in this window.

    While the microphone is on, binary frames carry its sound, and this window plays the agent's sound. At most one
    window of a conversation has the microphone: the last window that turned it on.
    """

    on: Truth
    type: Literal["microphone"] = "microphone"


@dataclass(frozen=True, slots=True)
class Played:
    """How much the loudspeaker has played. The client sends this frame every 100 ms of sound, and when the sound ends.

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


@dataclass(frozen=True, slots=True)
class Camera:
    """The visitor's camera goes on or off in this window.

    At most one window of a conversation has the camera: the last window that turned it on.
    """

    on: Truth
    type: Literal["camera"] = "camera"


@dataclass(frozen=True, slots=True)
class Picture:
    """The answer to a `Look`: the next binary frame is the camera's newest picture, a JPEG.

    Attributes:
        n: The number of the `Look`.
    """

    n: Number
    type: Literal["picture"] = "picture"


# ------------------------------------------------------------------------------------ from the server


@dataclass(frozen=True, slots=True)
class Welcome:
    """The answer to `Hello`.

    Attributes:
        v: The version of the protocol.
        session: The conversation's secret id. A client sends it to resume the conversation.
        resumed: Whether the server has resumed the conversation that the client asked for.
        first: The number of the oldest message that the server keeps; 1 before the first message.
        agent: The agent's name.
        inside: The address of the board (Raveboard) for this conversation, relative to the page; None if there is none.
        last: The number of the newest message; 0 before the first message.
        writing: Whether the server accepts `Writing` frames. Servers of the first releases did not.
        suggestions: A few things that the visitor could say first.
        note: A line of text that the page shows until the visitor has said something; None if there is none.
        voice: Whether the agent can hear and speak. If so, the server accepts `Microphone` frames and sound.
        sight: The notice to show before the camera goes on, if the agent can see; None if it cannot.
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
    sight: Text | None = None
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
        heard: The part of the utterance that the visitor heard, if the agent's speech was cut off.
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
    """A change to an utterance that is still growing: `text` replaces everything from position `at` on.

    Attributes:
        at: The position in the utterance where `text` begins, in UTF-16 units, as in JavaScript.
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
    """The words so far of an utterance that the visitor is still speaking; empty once the utterance is a `Message`."""

    text: Text
    type: Literal["caption"] = "caption"


@dataclass(frozen=True, slots=True)
class Heard:
    """The part of an agent's message that the visitor heard: all of it, unless the agent's speech was cut off.

    Attributes:
        n: The message's number.
        text: The part that was heard.
    """

    n: Number
    text: Text
    type: Literal["heard"] = "heard"


@dataclass(frozen=True, slots=True)
class Flush:
    """An order to drop all unplayed sound. The sound after this frame belongs to a new stream.

    Attributes:
        n: The number of the new stream.
    """

    n: Number
    type: Literal["flush"] = "flush"


@dataclass(frozen=True, slots=True)
class Listening:
    """The agent has begun to listen to this window's microphone. Before that, the agent may load its models."""

    type: Literal["listening"] = "listening"


@dataclass(frozen=True, slots=True)
class Taken:
    """This window no longer has the microphone; `text` says why."""

    text: Text
    type: Literal["taken"] = "taken"


@dataclass(frozen=True, slots=True)
class Look:
    """The agent wants a picture from this window's camera.

    Attributes:
        n: The number of this request. The server ignores a `Picture` with another number.
    """

    n: Number
    type: Literal["look"] = "look"


@dataclass(frozen=True, slots=True)
class Face:
    """A face that the agent sees.

    Attributes:
        box: x, y, width and height, as shares of the picture's width and height. (0, 0) is the upper left corner.
        name: The person's name; missing if the agent does not know it.
    """

    box: tuple[Share, Share, Share, Share]
    name: Text | None = None


@dataclass(frozen=True, slots=True)
class Faces:
    """All faces that the agent sees in this window's pictures now."""

    faces: tuple[Face, ...]
    type: Literal["faces"] = "faces"


@dataclass(frozen=True, slots=True)
class Unseen:
    """This window no longer has the camera; `text` says why."""

    text: Text
    type: Literal["unseen"] = "unseen"


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


ClientFrame = Hello | Say | Writing | Bye | Ping | Microphone | Played | Hush | Camera | Picture
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
    | Look
    | Faces
    | Unseen
    | Ended
    | Error
    | Pong
)

_BY_TYPE = Field(discriminator="type")
CLIENT: TypeAdapter[ClientFrame] = TypeAdapter(Annotated[ClientFrame, _BY_TYPE])
"""The frames that a client sends."""
SERVER: TypeAdapter[ServerFrame] = TypeAdapter(Annotated[ServerFrame, _BY_TYPE])
"""The frames that the server sends."""
FRAMES: TypeAdapter[ClientFrame | ServerFrame] = TypeAdapter(Annotated[ClientFrame | ServerFrame, _BY_TYPE])
"""The frames of both sides."""
