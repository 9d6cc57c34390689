"""The commands that users of a messenger may give, besides talking to the agent."""

from __future__ import annotations

from dataclasses import dataclass

COMMANDS = {
    "start": "begin a conversation",
    "help": "what I can do",
    "stop": "end the conversation",
    "forget": "delete everything that I know about you",
}
"""The commands by name, with their descriptions in the messenger's menu."""

FORGOTTEN = "I have forgotten you, and everything that you told me."
NOT_FORGOTTEN = "I could not delete what I know about you. Please try again later."
UNHEARD = "I can't listen to voice messages. Please write to me."
UNCLEAR = "I couldn't hear any words in that."
UNSEEN = "I couldn't open that."


@dataclass(frozen=True, slots=True)
class Command:
    """A command of a user: its name without a slash, and a text that explains the commands."""

    name: str
    explanation: str = ""


def explanation(agent: str) -> str:
    """Return the text that explains the commands except ``start`` to a user."""
    lines = "\n".join(f"/{name}: {what}" for name, what in COMMANDS.items() if name != "start")
    return f"I am {agent}. Write to me as you would to a friend.\n{lines}"
