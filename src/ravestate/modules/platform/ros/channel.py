"""One topic, service or action of a node.

A node reaches ROS through a bridge, which is a process that runs a ROS library, or through the built-in bus.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any, Protocol

from ravestate.errors import PlatformError

from .types import Types


class Carrier(Protocol):
    """The part of a `Node` that its channels use."""

    types: Types

    def publish(self, channel: Channel, body: memoryview) -> None: ...
    async def call(self, channel: Channel, value: Any, feedback: Callable[[Any], None] | None = None) -> Any: ...
    def take(self, channel: Channel, body: memoryview) -> None: ...
    def acknowledge(self, channel: Channel) -> None: ...
    def drop(self, channel: Channel) -> None: ...


@dataclass(eq=False, slots=True)
class Channel:
    """A node's access to one topic, service or action. `close` ends the access.

    Attributes:
        number: The channel's number on the link (the bridge process or the bus).
        binding: The description of the channel that the bridge or the bus gets.
        type: The full name of the type.
        take: The function that gets the messages, if the channel subscribes to a topic.
        serve: The function that answers the requests, if the channel offers a service.
        pause: The minimum time between two messages for `take` (seconds).
        fault: The reason why the bridge could not make the channel. The text is empty if there was no fault.
        pending: The newest message that has come during the pause.
        timer: The timer that ends the pause; None if there is no pause.
        owed: Whether the bridge waits for an acknowledgement.
    """

    node: Carrier
    number: int
    binding: dict[str, Any]
    type: str
    take: Callable[[Any], None] | None = None
    serve: Callable[[Any], Awaitable[Any]] | None = None
    pause: float = 0.0
    fault: str = ""
    pending: memoryview | None = None
    timer: asyncio.TimerHandle | None = None
    owed: bool = False

    @property
    def name(self) -> str:
        """The absolute name of the topic, service or action."""
        return self.binding["name"]

    @property
    def latches(self) -> bool:
        """Whether a late subscriber gets the last message."""
        return self.binding.get("latch", False)

    def publish(self, value: Any) -> None:
        """Publish a value: a message, a mapping of its fields, or the value of its only field.

        Raises:
            PlatformError: The value does not fit the type, or the bridge could not make the channel.
        """
        if self.fault:
            raise PlatformError(self.fault)
        self.node.publish(self, self.node.types.encode(value, self.type))

    async def call(self, value: Any, feedback: Callable[[Any], None] | None = None) -> Any:
        """Call a service, or send a goal; return the response or the result.

        If the task that waits for the answer is cancelled, the call or the goal is cancelled too.

        Raises:
            PlatformError: The value does not fit the type, the bridge or the server fails, no answer comes in time, or
                the goal does not succeed.
        """
        return await self.node.call(self, value, feedback)

    def close(self) -> None:
        """End the channel."""
        self.stop()
        self.node.drop(self)

    def offer(self, body: memoryview, *, newest: bool = True, owed: bool = False) -> None:
        """Pass a message of the topic to `take`, now or after the pause, unless a newer message replaces it.

        Args:
            body: The message.
            newest: Whether the message is the newest one that has come over its connection.
            owed: Whether the bridge waits for an acknowledgement before it sends the next message.
        """
        if not self.binding["latest"]:
            self.node.take(self, body)
            return
        self.owed |= owed
        if self.timer is not None:
            self.pending = body
        elif newest:
            try:
                self.node.take(self, body)
            finally:
                if self.pause:
                    self.timer = asyncio.get_running_loop().call_later(self.pause, self._rested)
                else:
                    self._rested()

    def stop(self) -> None:
        """Forget a message that waits for the end of the pause."""
        self.pending = None
        if self.timer is not None:
            self.timer.cancel()
            self.timer = None

    def _rested(self) -> None:
        body, self.pending, self.timer = self.pending, None, None
        if self.owed:
            self.owed = False
            self.node.acknowledge(self)
        if body is not None:
            self.offer(body)
