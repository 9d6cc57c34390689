"""Find out whether a message is for the agent, and extract its words or its command."""

from __future__ import annotations

import re
from collections.abc import Iterable

from .commands import COMMANDS

COMMAND = re.compile(r"[/!](\w+)(?:@(\w+))?\s*$")
"""A command: ``/stop``, in a group also ``/stop@robin_bot``. Some messengers reserve ``/``, so ``!stop`` works, too."""


def command_in(text: str) -> str | None:
    """Return the command's name if the whole message is a command that the agent knows; else return None."""
    found = COMMAND.match(text)
    return found[1].casefold() if found and found[1].casefold() in COMMANDS else None


def addressed(
    text: str, handles: Iterable[str], names: Iterable[str], *, group: bool, called: bool = False
) -> tuple[str | None, str] | None:
    """Return the command in a message (None if it has no command), and the words for the agent.

    If the message is not for the agent, return None instead of this pair.

    Args:
        text: The message.
        handles: The agent's handles on the messenger, for example ``@robin_bot``. The result leaves them out.
        names: The agent's names. In a group, a message is for the agent only if it is a command, contains one of these
            names or handles, or is `called`.
        group: Whether several people may be in the chat.
        called: Whether something else shows that the message is for the agent, e.g. that it replies to the agent.

    Example:
        >>> addressed("@robin_bot, how are you?", ["@robin_bot"], ["Robin"], group=True)
        (None, 'how are you?')
        >>> addressed("/help@other_bot", ["@robin_bot"], ["Robin"], group=True)
    """
    handles = tuple(handles)
    found = COMMAND.match(text)
    if found and found[2] and f"@{found[2]}".casefold() not in [each.casefold() for each in handles]:
        return None
    command = command_in(text)
    if group and not (command or called or mentions(text, (*handles, *names))):
        return None
    for handle in handles:
        text = without_mention(text, handle)
    return command, text


def mentions(text: str, names: Iterable[str]) -> bool:
    """Return whether a text contains one of the names as a separate word, in small or capital letters."""
    return any(name and re.search(rf"(?<!\w){re.escape(name)}(?!\w)", text, re.IGNORECASE) for name in names)


def without_mention(text: str, mention: str) -> str:
    """Return a text without a mention such as ``@robin_bot``, wherever it stands. Drop a comma or colon after it, too.

    Example:
        >>> without_mention("@robin_bot, how are you?", "@robin_bot")
        'how are you?'
    """
    # Without the first lookbehind, the time would grow with the square of the number of spaces in the text.
    return re.sub(rf"(?<!\s)\s*(?<!\w){re.escape(mention)}(?!\w)[,:]?", "", text, flags=re.IGNORECASE).strip()
