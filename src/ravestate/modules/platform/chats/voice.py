"""Turn voice notes into words, and words into voice notes, if `voiceio` is installed."""

from __future__ import annotations

import asyncio
import importlib
from dataclasses import replace
from typing import Any

from ravestate.errors import PlatformError

from .messages import Outgoing

VOICE = "ravestate.modules.platform.voiceio"
"""The module that recognises and synthesises speech. It loads with the first voice note."""


async def words_in(note: bytes) -> str:
    """Return the words in a voice note. The note is the content of a sound file, for example Ogg with Opus.

    Raises:
        PlatformError: Speech recognition is not installed or fails, or the note is damaged.
    """
    return await asyncio.to_thread(lambda: str(_voiceio().transcribe(note).text))


async def spoken(text: str) -> bytes | None:
    """Return a text as a voice note (Ogg with Opus), or None if speech synthesis fails or is not installed."""
    try:
        return await asyncio.to_thread(lambda: bytes(_voiceio().synthesise(text)))
    except PlatformError:
        return None


async def voiced(message: Outgoing) -> Outgoing:
    """Return a ``voice`` message with its sound, or as text if `spoken` returns None. Return other messages unchanged."""
    if message.kind != "voice":
        return message
    note = await spoken(message.text)
    return replace(message, kind="text") if note is None else replace(message, data=note)


def _voiceio() -> Any:
    try:
        return importlib.import_module(VOICE)
    except ImportError as error:
        raise PlatformError("voice notes need voiceio: pip install 'ravestate[voice]'") from error
