"""The words for the agent in a message: its name, a mention of it, a command."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable

from .commands import COMMANDS

COMMAND = re.compile(r"[/!](\w+)(?:@(\w+))?\s*$")
"""A command: ``/stop``, in a group also ``/stop@robin_bot``. Some messengers keep ``/`` to themselves, so ``!`` counts."""


def command_in(text: str) -> str | None:
    """Return the name of the command that a message consists of; None if it is no command that the agent knows."""
    found = COMMAND.match(text)
    return found[1].casefold() if found and found[1].casefold() in COMMANDS else None


def for_another(text: str, me: str) -> bool:
    """Return whether a message is a command for another bot: ``/help@other_bot``."""
    found = COMMAND.match(text)
    return bool(found and found[2] and found[2].casefold() != me.casefold())


def mentions(text: str, names: Iterable[str]) -> bool:
    """Return whether one of the names is in a text, as a word of its own."""
    return any(name and re.search(rf"(?<!\w){re.escape(name)}(?!\w)", text, re.IGNORECASE) for name in names)


def without_mention(text: str, mention: str) -> str:
    """Return a text without a mention such as ``@robin_bot``.

    Example:
        >>> without_mention("@robin_bot, how are you?", "@robin_bot")
        'how are you?'
    """
    return re.sub(rf"\s*(?<!\w){re.escape(mention)}(?!\w)[,:]?", "", text, flags=re.IGNORECASE).strip()


def is_emoji(text: str) -> bool:
    """Return whether a text is one emoji.

    Example:
        >>> is_emoji("❤️"), is_emoji("👩‍🚀"), is_emoji("ok"), is_emoji("")
        (True, True, False, False)
    """
    kinds = [unicodedata.category(character) for character in text]
    return 0 < len(text) <= 8 and kinds[0] == "So" and all(kind in ("So", "Sk", "Mn", "Cf", "Me") for kind in kinds)
