"""The listening skill as a backend, in place of a language model."""

from __future__ import annotations

import random
from collections.abc import AsyncGenerator, Sequence

from ravestate.language.chat import Message, Progress

from .hearing import Heard
from .listener import Listener
from .state import State


class ListeningBackend:
    """A backend without a language model. If it is chosen, the module answers with the listening skill."""

    async def load(self, progress: Progress | None = None) -> None:
        """Do nothing: there is no model to load."""

    async def stream(
        self,
        messages: Sequence[Message],
        *,
        max_tokens: int = 96,
        temperature: float = 0.7,
        seed: int | None = None,
        stop: Sequence[str] = (),
    ) -> AsyncGenerator[str, None]:
        """Yield the listening skill's answer to the last message. Only `messages` and `seed` matter."""
        said = tuple(message.text for message in messages if message.role == "assistant")
        state = State(recent=said[-24:], said=said[-24:])
        yield Listener().answer(Heard(messages[-1].text), state, random.Random(seed)).text

    async def close(self) -> None:
        """Do nothing: there is no model to close."""
