"""The part that all bridges share: a conversation with an agent, as words in and utterances out."""

from __future__ import annotations

import asyncio
import contextlib
import secrets
from collections.abc import AsyncGenerator, Callable, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import ravestate as rs
from ravestate.declare.module import Module
from ravestate.errors import DeclarationError, RavestateError
from ravestate.loading.modules import load_module
from ravestate.loading.spec import AgentSpec
from ravestate.modules import interloc, rawio
from ravestate.policy.policy import Policy
from ravestate.runtime.agent import Agent
from ravestate.runtime.context import Context
from ravestate.runtime.listeners import Hooks

AnyAgent = Context | Agent | Policy | Module | ModuleType | str | Path | Sequence[Module | ModuleType]
"""An agent, in one of these forms:

- a module, several modules, a policy from ``rs.compile``, or an `Agent`; many conversations may share any of these
- the path of an agent file (``agent.yaml``), or a module's name as on the command line (``hibye``, ``./hello.py``)
- an ``rs.Context`` that has not started, for special settings or a seed; it serves only one conversation
"""

LONGEST = 30.0  # `Conversation.end` waits at most this many seconds for an answer
FAREWELL = 5.0  # rules have this many seconds to react to the user's leaving, and then as many to react to the shutdown


def contexts_of(agent: AnyAgent) -> Callable[[], Context]:
    """Return a function that makes a context for each conversation with an agent.

    Raises:
        DeclarationErrors: The modules or the settings have faults.
        DeclarationError: The agent can neither hear nor speak, because it lacks the module rawio.
        UsageError: There is no such module, or the agent file has mistakes.
    """
    if isinstance(agent, Context):
        policy, make = agent.policy, lambda: agent
    else:
        shared = _loaded(agent)
        policy, make = shared.policy, shared.context
    if rawio.output.name not in policy.slots:
        raise DeclarationError(
            "the agent can neither hear nor speak: it has no module that requires rawio; write requires=[rawio]"
        )
    return make


def _loaded(agent: Agent | Policy | Module | ModuleType | str | Path | Sequence[Module | ModuleType]) -> Agent:
    if isinstance(agent, Agent):
        return agent
    if isinstance(agent, (str, Path)):
        path = Path(agent)
        if path.suffix in (".yaml", ".yml"):
            spec = AgentSpec.from_file(path)
            return Agent(*spec.modules, **spec.options())
        return Agent(load_module(str(agent)))
    return Agent(*agent) if isinstance(agent, Sequence) else Agent(agent)


class Utterance:
    """An utterance of the agent, as an async iterator. It yields each piece as soon as the agent writes it."""

    def __init__(self) -> None:
        self.text = ""
        """The text so far, including pieces from after an interruption."""
        self._pieces: asyncio.Queue[str | None] = asyncio.Queue()
        self.ended = False
        """Whether the iterator ends after the pieces so far."""

    def grow(self, piece: str) -> None:
        """Add a piece. The iterator does not yield pieces that come after `end`."""
        self.text += piece
        if piece and not self.ended:
            self._pieces.put_nowait(piece)

    def end(self) -> None:
        """End the iterator after the pieces so far."""
        self.ended = True
        self._pieces.put_nowait(None)

    def __aiter__(self) -> Utterance:
        return self

    async def __anext__(self) -> str:
        piece = await self._pieces.get()
        if piece is None:
            self.end()  # so that the next call raises StopAsyncIteration, too
            raise StopAsyncIteration
        return piece


class Conversation:
    """A conversation with an agent. Call all its methods on one event loop.

    Args:
        context: The agent's context for this conversation.
        speak: A function that receives each utterance as it begins. While `answer` runs, `answer` yields
            the utterances instead.
        platform: The platform's name, for the user's key in ``interloc.users``.
    """

    def __init__(self, context: Context, speak: Callable[[Utterance], object], platform: str) -> None:
        self.context = context
        self._speak = speak
        self._user = f"{platform}-{secrets.token_hex(4)}"
        self._growing: Utterance | None = None
        self._followers: set[asyncio.Task[None]] = set()
        self._turn = asyncio.Lock()
        self._begun = self._over = False

    async def begin(self) -> None:
        """Start the agent, unless it runs already, and tell it that the user is present."""
        if self._begun:
            return
        self._begun = True
        listeners = {
            rawio.piece.name: self._grow,
            rawio.output.changed.name: self._utter,
            rawio.speaking.false.name: self._fall_silent,
        }
        await self.context.start(Hooks(listeners=listeners))
        self._change_users(lambda users: {**users, self._user: None})

    async def end(self, *, at_once: bool = False) -> None:
        """Stop the agent after its last answer and a farewell. With `at_once`, do not wait for them."""
        if not self._begun or self._over:
            return
        self._over = True
        grace = 0.0
        try:
            if not at_once:
                await self._quiet(LONGEST, rawio.output)
                self._change_users(lambda users: {key: name for key, name in users.items() if key != self._user})
                await self._quiet(FAREWELL)
                grace = FAREWELL
        finally:
            await self.context.stop(grace)
            self._fall_silent()

    async def until_agent_leaves(self) -> None:
        """Wait until the agent ends the conversation (``ctx.stop()``). If `end` ends the conversation, never return.

        Raises:
            RavestateError: The agent has failed.
        """
        await self.context.until_stopped()
        if self._over:
            await asyncio.Event().wait()

    def hear(self, text: str) -> None:
        """Tell the agent what the user has said."""
        if text.strip():
            if self._growing is not None and self._growing.ended:  # it was interrupted, and its rule cancelled
                self._growing = None
            self.context.put(rawio.input, text)

    def notice_speech(self, text: str = "") -> None:
        """Tell the agent that the user is speaking, with the words so far if the framework knows them."""
        self.context.emit(rawio.typing)
        if text:
            self.context.emit(rawio.hearing, text)

    def interrupt(self) -> None:
        """End the utterance and the answer in progress: the user has interrupted them.

        Async rules that answer the user's words are cancelled. A plain function continues, but the user does not hear
        its words after the interruption.
        """
        if self._growing is not None:
            self._growing.end()
        self.context.wipe(rawio.input.changed)

    def heard(self, text: str) -> None:
        """Tell the agent which part of its last utterance the user has heard."""
        self.context.put(rawio.heard, text)

    async def answer(self, text: str) -> AsyncGenerator[Utterance, None]:
        """Tell the agent what the user has said, and yield all utterances until the answer is complete.

        Closing the generator before its end interrupts the answer. An answer begins only after the previous answer has
        ended.
        """
        async with self._turn:
            utterances: asyncio.Queue[Utterance | None] = asyncio.Queue()
            speak, self._speak = self._speak, utterances.put_nowait
            self.hear(text)
            quiet = asyncio.create_task(self.context.quiet(rawio.output))
            quiet.add_done_callback(lambda _: utterances.put_nowait(None))
            try:
                while (utterance := await utterances.get()) is not None:
                    yield utterance
                quiet.result()
            except (asyncio.CancelledError, GeneratorExit):
                self.interrupt()
                raise
            finally:
                quiet.cancel()
                self._speak = speak

    def _change_users(self, change: Callable[[Mapping[str, Any]], Mapping[str, Any]]) -> None:
        if interloc.users.name in self.context.policy.slots:
            self.context.put(interloc.users, change(self.context.read(interloc.users)))

    def _grow(self, piece: str) -> None:
        if self._growing is None:
            self._growing = Utterance()
            self._speak(self._growing)
            follower = asyncio.create_task(self._follow(self._growing))
            self._followers.add(follower)
            follower.add_done_callback(self._followers.discard)
        self._growing.grow(piece)

    def _utter(self, text: str) -> None:
        growing = self._growing
        if growing is not None and (rest := rawio.rest(text, growing.text)) is not None:
            growing.grow(rest)
            self._fall_silent()
        elif text.strip():
            utterance = Utterance()
            self._speak(utterance)
            utterance.grow(text)
            utterance.end()

    def _fall_silent(self, _: object = None) -> None:
        if self._growing is not None:
            self._growing.end()
            self._growing = None

    async def _follow(self, utterance: Utterance) -> None:
        """End a growing utterance as soon as no rule can add to it, even if a rule has failed in the middle of it."""
        with contextlib.suppress(RavestateError):  # if the engine has failed, `until_agent_leaves` raises the error
            await self.context.quiet(rawio.output)
        if self._growing is utterance:
            self._fall_silent()

    async def _quiet(self, seconds: float, slot: rs.Slot[str] | None = None) -> None:
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(seconds):
                await self.context.quiet(slot)
