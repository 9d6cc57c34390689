"""The fields of the web protocol's frames: the types and limits of values, and the error about a refused value."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from ravestate.errors import PlatformError
from ravestate.modules._text import printable

VERSION = 1
"""The version of the protocol. A new type of frame or a new field keeps the version; any other change increases it."""

LONGEST_NAME = 80
"""The maximum number of characters in a visitor's name."""

LONGEST_TEXT = 10_000
"""The maximum number of characters in one utterance of a visitor."""

LONGEST_SOUND = 32_000
"""The maximum number of bytes of sound in one frame from a client (1 s)."""

LONGEST_PICTURE = 100_000
"""The maximum number of bytes of a picture."""

GREATEST = 2**53 - 1
"""The greatest whole number that every JSON reader represents exactly."""

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
"""The WebSocket's closing code for each reason. An error without an entry has the closing code of ``malformed``."""


class ProtocolError(PlatformError, ValueError):
    """A frame that breaks the protocol.

    Attributes:
        code: One word for programs, e.g. ``malformed``. The message is for people.
        id: The refused frame's `id`, if that frame is a `Say`.
    """

    def __init__(self, code: str, message: str, id: str | None = None) -> None:
        super().__init__(message)
        self.code = code
        self.id = id


def heard_text(text: str) -> str:
    """Return the text of a visitor's utterance without control characters.

    Raises:
        ProtocolError: The text has too many characters (code ``too-long``) or is blank (code ``empty``).

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


def name_of(text: str) -> str:
    """Return a text as one line, without invisible characters and without characters that change the writing direction.

    Example:
        >>> name_of(" Ada\\u202e\\nLovelace ")
        'Ada Lovelace'
    """
    joiners = "\u200c\u200d"  # invisible characters that some languages and emoji need
    seen = "".join(c for c in printable(text) if c.isspace() or c.isprintable() or c in joiners)
    return " ".join(seen.split())


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
Share = Annotated[float, Field(ge=0, le=1, description="a number from 0 to 1")]
Speaker = Annotated[Literal["user", "agent"], Field(alias="from", description='"user" or "agent"')]
