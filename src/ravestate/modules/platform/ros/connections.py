"""The connections of a node of ROS 1 with the publishers and subscribers of its topics.

The bridge (the process that runs rospy for the agent) makes the connections and passes them to the agent.
"""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

from .channel import Channel
from .connection import FromPublisher, ToSubscriber


@dataclass(eq=False, slots=True)
class Publisher:
    """Another node's publisher of a topic.

    If the publisher latches (keeps its last message for late subscribers), `last` is this message. The list `late`
    holds the agent's channels that subscribed after this message and have not received it yet.
    """

    topic: str
    type: str
    md5: str
    latching: bool
    last: memoryview | None = None
    late: list[Channel] = field(default_factory=list[Channel])

    def suits(self, channel: Channel) -> bool:
        """Return whether the publisher sends the type that a channel reads. If it does not, the bridge reports this."""
        binding = channel.binding
        return binding["type"] == self.type and self.md5 in (binding["md5"], "*")


class Connections:
    """The connections that the bridge has made and then passed to the agent.

    Args:
        hang_up: A function that tells the bridge the number of each connection that has ended.
        warn: A function to call with a sentence for the log.
    """

    def __init__(self, hang_up: Callable[[int], None], warn: Callable[[str], None]) -> None:
        self._hang_up = hang_up
        self._warn = warn
        self._all: dict[int, FromPublisher | ToSubscriber] = {}
        self._publishers: dict[int, Publisher] = {}
        self._subscribers: dict[str, dict[int, ToSubscriber]] = {}
        """The connections with the subscribers of each topic."""
        self._readers: dict[str, list[Channel]] = {}
        """The channels that subscribe to each topic."""

    def add(self, channel: Channel) -> None:
        """Let a channel get the messages of its topic, beginning with the messages that publishers have latched."""
        self._readers.setdefault(channel.name, []).append(channel)
        for publisher in self._publishers.values():
            if publisher.last is not None and publisher.topic == channel.name and publisher.suits(channel):
                publisher.late.append(channel)
                asyncio.get_running_loop().call_soon(self._catch_up, publisher)

    def drop(self, channel: Channel) -> None:
        """Stop passing messages to a channel. If the topic has no channel left, disconnect from its publishers."""
        readers = self._readers[channel.name]
        readers.remove(channel)
        if not readers:
            for number, publisher in list(self._publishers.items()):
                if publisher.topic == channel.name:
                    self._all[number].close()
                    self._lost(number)

    def send(self, topic: str, body: memoryview) -> bool:
        """Send a message to the subscribers of a topic; return whether there are any."""
        connections = self._subscribers.get(topic)
        if not connections:
            return False
        for connection in list(connections.values()):
            connection.send(body)
        return True

    def to_subscriber(self, number: int, sock: socket.socket, topic: str, depth: int) -> ToSubscriber:
        """Take over a subscriber's connection from the bridge. At most `depth` messages wait for the subscriber."""
        connection = ToSubscriber(sock, partial(self._lost, number), depth)
        self._all[number] = self._subscribers.setdefault(topic, {})[number] = connection
        return connection

    def from_publisher(self, number: int, sock: socket.socket, publisher: Publisher, first: bytes) -> None:
        """Take over a publisher's connection from the bridge, which has already read the bytes `first` from it."""
        self._publishers[number] = publisher
        take, lost = partial(self._take, publisher), partial(self._lost, number)
        warn = partial(self._warn_of, publisher)
        connection = self._all[number] = FromPublisher(sock, take, lost, warn, first)
        connection.read()

    async def flush(self) -> None:
        """Wait until all messages have left."""
        for connections in list(self._subscribers.values()):
            for connection in list(connections.values()):
                await connection.flush()

    def close(self) -> None:
        """Close all connections."""
        for connection in self._all.values():
            connection.close()
        self._all.clear()
        self._publishers.clear()
        self._subscribers.clear()

    def _take(self, publisher: Publisher, body: memoryview, newest: bool) -> None:  # a callback
        if publisher.latching:
            publisher.last = body
            publisher.late.clear()  # the late channels get this newer message below
        for channel in list(self._readers.get(publisher.topic, ())):
            if publisher.suits(channel):
                self._offer(channel, body, newest)

    def _catch_up(self, publisher: Publisher) -> None:  # a callback
        late, publisher.late = publisher.late, []
        for channel in late:
            assert publisher.last is not None  # only a publisher with a last message has late channels
            self._offer(channel, publisher.last, True)

    def _offer(self, channel: Channel, body: memoryview, newest: bool) -> None:  # a callback
        if channel in self._readers[channel.name]:  # the channel has not been closed meanwhile
            try:
                channel.offer(body, newest=newest)
            except Exception as error:  # the other channels must still get this message
                text = f"{channel.name}: a message failed"
                asyncio.get_running_loop().call_exception_handler({"message": text, "exception": error})

    def _warn_of(self, publisher: Publisher, text: str) -> None:  # a callback
        self._warn(f"{publisher.topic}: {text}")

    def _lost(self, number: int) -> None:
        del self._all[number]
        self._publishers.pop(number, None)
        for connections in self._subscribers.values():
            connections.pop(number, None)
        self._hang_up(number)
