"""The names of `webio`: its settings, its module, and the slot with the visitor's conversation."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Annotated

import pydantic

import ravestate as rs
from ravestate.modules import interloc, rawio

if TYPE_CHECKING:
    from .session import Session

ORIGIN = re.compile(r"https?://[^\s/?#@'\";,*]+")  # the pattern of a web site's origin: scheme, host and port


def _origin(text: str) -> str:
    if ORIGIN.fullmatch(text) is None:
        raise ValueError("write an origin, e.g. https://museum.example")
    return text.lower()


class Settings(rs.Settings):
    """The settings of webio: where the server listens, who may connect, and the limits."""

    host: str = "127.0.0.1"
    """The address to listen on. Any address that other machines can reach needs a token."""
    port: int = pydantic.Field(8420, ge=0, le=65535)
    """The port to listen on; 0 takes any free port."""
    token: pydantic.SecretStr | None = None
    """The secret that each visitor's link needs at its end: ``#token=...``. Set it as ``RAVESTATE_WEBIO_TOKEN``."""
    origins: tuple[Annotated[str, pydantic.AfterValidator(_origin)], ...] = ()
    """The sites that may embed the page and connect to it, e.g. ``https://museum.example``. Behind a proxy, add the page's
    own site."""
    title: str | None = None
    """The agent's name on the page; by default, the value of ``interloc.agent``."""
    suggestions: tuple[Annotated[str, pydantic.Field(min_length=1, max_length=80)], ...] = pydantic.Field(
        ("Hello!", "Who are you?", "What can you do?"), max_length=6
    )
    """Utterances that the page suggests until the visitor has said something."""
    note: Annotated[str, pydantic.Field(min_length=1, max_length=300)] | None = None
    """A line that the page shows once in each browser, until the visitor has said something."""
    privacy: Annotated[str, pydantic.Field(min_length=1, max_length=600)] = (
        "The pictures go to the computer on which this agent runs, and it keeps none of them. It remembers your face only "
        "after you say yes: as numbers, in its memory on that computer. To delete them, say “forget my face”; to delete "
        "all that it knows about you, say “forget me”."
    )
    """The notice that the page shows before the camera goes on. It says which data are kept, where, and how to delete
    them."""
    keep: float = pydantic.Field(600.0, ge=0, allow_inf_nan=False)
    """How many seconds the server keeps a conversation after its visitor has disconnected."""
    sessions: int = pydantic.Field(1000, ge=1)
    """The maximum number of conversations at a time."""
    per_address: int = pydantic.Field(100, ge=1)
    """The maximum number of connections at a time from one address."""

    @pydantic.field_validator("token")
    @classmethod
    def _long_enough(cls, token: pydantic.SecretStr | None) -> pydantic.SecretStr | None:
        if token is None:
            return None
        secret = token.get_secret_value()
        if len(secret) < 12:
            raise ValueError("write at least 12 characters, such as secrets.token_urlsafe() makes")
        if not (secret.isascii() and secret.isprintable()) or secret != secret.strip():  # a header must carry it
            raise ValueError("write only ASCII characters, without control characters and without spaces at the ends")
        return token


module = rs.Module("webio", requires=(rawio, interloc), settings=Settings)

page: rs.Slot[Session | None] = module.slot("page", None)
"""This context's conversation with a visitor of the page; None for a context without a page."""
