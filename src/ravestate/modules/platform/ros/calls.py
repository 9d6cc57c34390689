"""The open calls of a node, which wait for answers: calls of services, goals of actions, questions about the network."""

from __future__ import annotations

import asyncio
import itertools
import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ravestate.errors import PlatformError

from .channel import Channel
from .frames import Kind
from .types import Types


@dataclass(frozen=True, slots=True)
class Call:
    """A call that waits for its answer."""

    number: int
    future: asyncio.Future[Any]
    channel: Channel
    feedback: Callable[[Any], None] | None


class Calls:
    """The open calls of a node, by number.

    Args:
        title: The name of the node in errors, for example ``ros1``.
        types: The node's message types, which decode the answers.
    """

    def __init__(self, title: str, types: Types) -> None:
        self._title = title
        self._types = types
        self._numbers = itertools.count(1)
        self._open: dict[int, Call] = {}

    def open(self, channel: Channel, feedback: Callable[[Any], None] | None = None) -> Call:
        """Return a new call. At the end, pass the call to `close`, even if it has failed."""
        call = Call(next(self._numbers), asyncio.get_running_loop().create_future(), channel, feedback)
        self._open[call.number] = call
        return call

    def close(self, call: Call) -> None:
        """Forget a call. A later answer to it has no effect."""
        del self._open[call.number]

    def fail_all(self, why: str) -> None:
        """End all open calls with an error."""
        for call in self._open.values():
            self._fail(call, f"{self._title}: {call.channel.binding.get('name', 'the network')}: {why}")

    def fail(self, channel: Channel, fault: str) -> None:
        """End the calls of a channel with an error."""
        for call in self._open.values():
            if call.channel is channel:
                self._fail(call, fault)

    def answer(self, kind: Kind, number: int, body: memoryview) -> None:
        """Handle a frame from the bridge or the bus that answers a call.

        The frame brings a result, feedback, a fault, or the description of the network.
        """
        call = self._open.get(number)
        if call is None or call.future.done():
            return
        if kind is Kind.FAULT:
            self._fail(call, f"{self._title}: {call.channel.name}: {json.loads(bytes(body))}")
        elif kind is Kind.TOLD:
            told = json.loads(bytes(body))
            if "error" in told:
                self._fail(call, f"{self._title}: {told['error']}")
            else:
                call.future.set_result(told)
        else:
            self._take_value(kind, call, body)

    def _take_value(self, kind: Kind, call: Call, body: memoryview) -> None:
        acts = call.channel.binding["kind"] == "action"
        part = "Feedback" if kind is Kind.FEEDBACK else "Result" if acts else "Response"
        try:
            value = self._types.decode(body, f"{call.channel.type}_{part}")
        except PlatformError as error:
            call.future.set_exception(error)
            return
        if kind is not Kind.FEEDBACK:
            call.future.set_result(value)
        elif call.feedback is not None:
            call.feedback(value)

    @staticmethod
    def _fail(call: Call, text: str) -> None:
        if not call.future.done():
            call.future.set_exception(PlatformError(text))
