"""All conversations with one agent, by their secret ids."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from typing import TYPE_CHECKING

from .camera import sees
from .fields import ProtocolError
from .line import hears
from .session import Ending, Onlooker, Session

if TYPE_CHECKING:
    from ravestate.runtime.agent import Agent

ONLOOKERS = 8  # the maximum number of windows that may show one conversation at a time


class Sessions:
    """All conversations with one agent. The agent makes a context for each of them.

    A conversation without a browser window is kept for `keep` seconds. If there are `limit` conversations already, one
    without a window ends to make room for a new one. If all have windows, the new conversation is refused.
    """

    def __init__(self, agent: Agent, *, limit: int, keep: float) -> None:
        self._agent = agent
        self.hears = hears(agent.policy)
        """Whether the agent can hear and speak."""
        self.sees = sees(agent.policy)
        """Whether the agent can see."""
        self._limit = limit
        self._keep = keep
        self._sessions: dict[str, Session] = {}
        self._tasks: dict[Session, asyncio.Task[None]] = {}
        self._timers: dict[Session, asyncio.TimerHandle] = {}  # the timers that end conversations without a window
        self._closed = False

    def __len__(self) -> int:
        return len(self._tasks)

    def __iter__(self) -> Iterator[Session]:
        """Yield the conversations, including those that are about to end, the oldest first."""
        return iter(tuple(self._tasks))

    def get(self, id: str) -> Session | None:
        """Return the conversation with this secret id; None if there is none, or if it is about to end."""
        return self._sessions.get(id)

    async def open(self, name: str | None = None) -> Session:
        """Begin a conversation with a visitor.

        Raises:
            ProtocolError: There are too many conversations, or the agent is being switched off.
        """
        if len(self._tasks) >= self._limit:
            await self._make_room()
        if self._closed:
            raise ProtocolError("closing", Ending.OFF)
        if len(self._tasks) >= self._limit:
            raise ProtocolError("full", f"{self._limit} visitors are here already: try again later")
        session = Session(self._agent.context(), name, hears=self.hears, sees=self.sees)
        self._sessions[session.id] = session
        self._tasks[session] = asyncio.create_task(self._live(session))
        self._abandon(session)  # the conversation ends if no window opens in time
        return session

    def enter(self, session: Session, onlooker: Onlooker) -> None:
        """Add an onlooker, for example a window, to a conversation.

        Raises:
            ProtocolError: The conversation has `ONLOOKERS` onlookers already.
        """
        if len(session.onlookers) >= ONLOOKERS:
            raise ProtocolError("full", f"{ONLOOKERS} windows show this conversation already: close one of them")
        session.onlookers.add(onlooker)
        timer = self._timers.pop(session, None)
        if timer is not None:
            timer.cancel()

    def exit(self, session: Session, onlooker: Onlooker) -> None:
        """Remove an onlooker from a conversation. If none is left, it ends in `keep` seconds, unless one comes back."""
        session.onlookers.discard(onlooker)
        if not session.onlookers and session in self._tasks:
            self._abandon(session)

    def leave(self, session: Session, reason: Ending) -> None:
        """End a conversation for good."""
        self._sessions.pop(session.id, None)
        timer = self._timers.pop(session, None)
        if timer is not None:
            timer.cancel()
        session.leave(reason)

    async def close(self) -> None:
        """End all conversations, and refuse new ones: the agent is being switched off."""
        self._closed = True
        for session in list(self._tasks):
            self.leave(session, Ending.OFF)
        if self._tasks:
            await asyncio.wait(list(self._tasks.values()))

    def _abandon(self, session: Session) -> None:
        self._timers[session] = asyncio.get_running_loop().call_later(self._keep, self.leave, session, Ending.ABANDONED)

    async def _make_room(self) -> None:
        """End one conversation without a window, if there is one.

        Conversations whose visitors never spoke end first. If several conversations are equal in this, the one
        that has had no window for the longest time ends first.
        """
        abandoned = min(self._timers, key=lambda session: session.spoken, default=None)
        if abandoned is not None:
            task = self._tasks[abandoned]
            self.leave(abandoned, Ending.CROWDED)
            await asyncio.wait((task,))

    async def _live(self, session: Session) -> None:
        try:
            await session.live()
        finally:
            self.leave(session, Ending.CANCELLED)  # no effect if another call of `leave` came first
            self._tasks.pop(session, None)
