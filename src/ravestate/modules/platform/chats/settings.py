"""The settings that all messengers have."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import pydantic

import ravestate as rs

_URL = pydantic.TypeAdapter(pydantic.HttpUrl)


def _address(text: str) -> str:
    try:
        _URL.validate_python(text)
    except pydantic.ValidationError:
        raise ValueError("write a whole address, e.g. https://museum.example") from None
    return text


Address = Annotated[str, pydantic.AfterValidator(_address)]
"""The address of a server, with ``http://`` or ``https://``. Any other text is refused as a setting."""


class ChatSettings(rs.Settings):
    """The settings of a platform with many chats: which people the agent answers, and when a chat rests."""

    allow: tuple[int | str, ...] = ()
    """The people whom the agent answers: their ids or user names, or ids of groups. If empty, it answers everybody."""
    rest: float = pydantic.Field(600.0, gt=0, allow_inf_nan=False)
    """A chat rests after this many seconds of silence."""
    chats: int = pydantic.Field(1000, ge=1)
    """The maximum number of chats that are awake (not at rest). Only chats with unanswered messages may exceed it."""
    path: Path | None = None
    """The file with unanswered and undelivered messages. By default, a file for each account in the user's data folder."""

    def allows(self, *names: object) -> bool:
        """Return whether `allow` is empty, or has one of these ids and names of a sender and a chat."""
        known = {_plain(name) for name in self.allow}
        return not known or any(_plain(name) in known for name in names if name)


def _plain(name: object) -> str:
    return str(name).removeprefix("@").casefold()
