"""A node: it connects an agent with topics, services and actions, through one bridge or bus.

A bridge is a process that runs a ROS library for the agent. The bus is a server that replaces ROS.
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import json
import logging
import os
from collections import deque
from collections.abc import Awaitable, Callable, Mapping
from functools import partial
from typing import Any, Literal, Protocol

from ravestate.errors import PlatformError

from .calls import Calls
from .channel import Channel
from .connections import Connections, Publisher
from .frames import Frames, Handle, Kind
from .goals import GoalTopics
from .naming import resolve
from .types import Types

TOLD = 100
"""A node logs at most this many different texts. A text of level `info`, or a new link (see `Link`), resets the
count."""
WAITING = 1000
"""At most this many frames (units of data for the bridge) wait while the bridge starts. If there are more, the node drops
the oldest ones."""
LEAVING = 2.0
"""A node that is closed may take this many seconds to send its last messages to directly connected subscribers."""

_nodes = itertools.count(1)  # nodes need different names, because ROS 1 ends an older node of the same name


class Link(Protocol):
    """The carrier of a node's frames: a bridge process, or a connection to the bus."""

    failed: PlatformError | None
    restarts: int

    @property
    def frames(self) -> Frames | None: ...
    @property
    def pid(self) -> int | None: ...
    def start(self) -> None: ...
    async def close(self) -> None: ...
    def kill(self) -> None: ...


MakeLink = Callable[[Mapping[str, Any], Handle, Callable[[], None], Callable[[str], None]], Link]
"""A function that makes a link. Its arguments are a node's configuration and the functions `handle`, `ready` and
`lost`; see `BridgeProcess`."""


class Node:
    """A node of ROS or of the bus. The node connects at its first use, and replaces a broken link.

    Each method that opens a channel raises a `PlatformError` if the type is unknown, or ROS is not installed here.

    Args:
        title: The name of the node in logs and errors, for example ``ros1``.
        types: The types of the node's messages.
        make_link: A function that makes the link.
        name: The beginning of the node's name. The process id follows.
        namespace: The namespace of relative names.
        remap: The names to replace, with their new names.
        environment: Environment variables for the bridge.
        log: The logger for warnings.
        failed: A function to call with the reason if no link is possible.
    """

    def __init__(
        self,
        title: str,
        types: Types,
        make_link: MakeLink,
        *,
        name: str = "ravestate",
        namespace: str = "",
        remap: Mapping[str, str] | None = None,
        environment: Mapping[str, str] | None = None,
        log: logging.Logger | None = None,
        failed: Callable[[PlatformError], None] | None = None,
    ) -> None:
        self.title = title
        self.types = types
        self.channels: dict[int, Channel] = {}
        self.bound: dict[str, Channel | GoalTopics] = {}
        """The channels of the slots that publish or call, by the slots' names."""
        self.goals: dict[str, set[asyncio.Future[Any]]] = {}
        """The open goals of actions, by the names of the slots that sent them."""
        self.ready = asyncio.Event()
        """An event that is set while the link works, and when the link has failed for good."""
        number = next(_nodes)
        self._name = f"{name}_{os.getpid()}" + (f"_{number}" if number > 1 else "")
        self._namespace = namespace
        self._remap = remap or {}
        self._log = log or logging.getLogger(f"ravestate.{title}")
        config = {"name": resolve(self._name, "", namespace, {}), "environment": dict(environment or {})}
        self._make_link = partial(make_link, config, self._handle, self._bind_all, self._lost)
        self._link: Link | None = None
        self._failed = failed
        self._connections = Connections(partial(self._tell, Kind.HANGUP, 0), self._warn)
        self._latched: dict[str, memoryview] = {}
        """Topic → its last message, if one of the topic's channels latches (keeps this message for late subscribers)."""
        self._numbers = itertools.count(1)
        self._calls = Calls(title, types)
        self._waiting: deque[tuple[Kind, int, int, memoryview | bytes]] = deque(maxlen=WAITING)  # frames for a link
        self._told: set[str] = set()  # the texts that are already in the log
        self._preparing: asyncio.Future[Any] | None = None
        self._tasks: set[asyncio.Task[None]] = set()

    @property
    def pid(self) -> int | None:
        """The process id of the bridge, if it runs."""
        return None if self._link is None else self._link.pid

    @property
    def restarts(self) -> int:
        """The number of links that replaced a broken link."""
        return 0 if self._link is None else self._link.restarts

    @property
    def _frames(self) -> Frames | None:
        return None if self._link is None else self._link.frames

    # ------------------------------------------------------------------------------- making channels

    def subscribe(
        self,
        topic: str,
        type: str,
        take: Callable[[Any], None],
        *,
        latest: bool = True,
        rate: float | None = None,
        qos: Mapping[str, Any],
    ) -> Channel:
        """Call `take` with each message of a topic.

        Args:
            topic: The topic's name.
            type: The type's name.
            take: The function to call on the loop.
            latest: Whether a new message may replace an older one that `take` has not received yet.
            rate: The maximum number of messages per second. `take` gets the newest message of each interval (1 / `rate` seconds).
            qos: The quality of service; see `naming.quality`.

        Raises:
            PlatformError: The type is unknown.
        """
        binding = {"latest": latest or rate is not None, "qos": dict(qos)}
        return self._open("subscriber", topic, type, binding, take=take, pause=1 / rate if rate else 0.0)

    def advertise(self, topic: str, type: str, *, latch: bool = False, qos: Mapping[str, Any]) -> Channel:
        """Return a channel on which to publish.

        With `latch`, late subscribers get the last message. In ROS 2, the durability in `qos` must be
        ``transient_local``, too; this durability alone means the same as `latch`.
        """
        latch = latch or (self.types.version == 2 and qos["durability"] == "transient_local")
        return self._open("publisher", topic, type, {"latch": latch, "depth": qos["depth"], "qos": dict(qos)})

    def client(self, service: str, type: str, *, timeout: float) -> Channel:
        """Return a channel to call a service. A call fails if no answer comes within `timeout` seconds."""
        return self._open("client", service, type, {"timeout": timeout}, "srv")

    def offer(self, service: str, type: str, serve: Callable[[Any], Awaitable[Any]]) -> Channel:
        """Offer a service. `serve` gets a request, and returns the response."""
        return self._open("server", service, type, {}, "srv", serve=serve)

    def action(self, name: str, type: str, *, timeout: float) -> Channel | GoalTopics:
        """Return a channel to send goals. The server must appear within `timeout` seconds."""
        if self.types.version == 1:
            return GoalTopics(self, name, self.types.require(type, "action"), timeout)
        return self._open("action", name, type, {"timeout": timeout}, "action")

    def _open(
        self, kind: str, name: str, type: str, binding: dict[str, Any], group: str = "msg", **options: Any
    ) -> Channel:
        full = self.types.require(type, group)
        wire = full
        if self.types.version == 1:
            wire = full.replace(f"/{group}/", "/")
            binding["text"], binding["md5"] = self.types.ros1_definition(full)
        elif group == "msg":
            binding["fields"] = self.types.fields(full)
        absolute = self.absolute(name)
        number = next(self._numbers)
        binding = {"kind": kind, "name": absolute, "type": wire, **binding}
        channel = self.channels[number] = Channel(self, number, binding, full, **options)
        self.start()
        if frames := self._frames:
            frames.tell(Kind.BIND, channel.binding, number)
        if kind == "subscriber":
            self._connections.add(channel)
        return channel

    def absolute(self, name: str) -> str:
        """Remap a name, and return it as an absolute name."""
        return resolve(name, self._name, self._namespace, self._remap)

    def drop(self, channel: Channel) -> None:
        """End a channel."""
        if self.channels.pop(channel.number, None) is not None:
            if channel.take is not None:
                self._connections.drop(channel)
            if not any(other.latches and other.name == channel.name for other in self.channels.values()):
                self._latched.pop(channel.name, None)
            self._tell(Kind.UNBIND, channel.number)

    # ------------------------------------------------------------------------------- using channels

    def start(self) -> None:
        """Start to connect, unless the node has already started.

        Raises:
            PlatformError: ROS is not installed here, or does not start.
        """
        if self._link is None:
            self._link = self._make_link()
            self._link.start()
        if self._link.failed is not None:
            raise self._link.failed

    async def prepare(self) -> None:
        """Load the types in a thread, unless they are loaded.

        Without this call, the first use of the node loads the types on the loop.

        Raises:
            PlatformError: The library `rosbags` is missing.
        """
        if not self.types.loaded:
            if self._preparing is None:  # all callers await the same future, so they continue in order
                self._preparing = asyncio.ensure_future(asyncio.to_thread(lambda: self.types.store))
            await asyncio.shield(self._preparing)

    def send(self, kind: Kind, channel: int, number: int, body: memoryview | bytes = b"") -> None:
        """Send a frame, or keep it until the link works."""
        if frames := self._frames:
            frames.send(kind, channel, number, body)
        else:
            self._waiting.append((kind, channel, number, body))

    def publish(self, channel: Channel, body: memoryview) -> None:
        """Send a message to the subscribers that are connected directly; if there are none, send it to the bridge."""
        if channel.latches:
            self._latched[channel.name] = body
        if not self._connections.send(channel.name, body):
            self.send(Kind.MESSAGE, channel.number, 0, body)

    def _tell(self, kind: Kind, channel: int, number: int = 0) -> None:
        """Send a frame over the present link, if there is one. Do not keep the frame for a later link."""
        if frames := self._frames:
            frames.send(kind, channel, number)

    async def call(self, channel: Channel, value: Any, feedback: Callable[[Any], None] | None = None) -> Any:
        """See `Channel.call`."""
        if channel.fault:
            raise PlatformError(channel.fault)
        acts = channel.binding["kind"] == "action"
        body = self.types.encode(value, f"{channel.type}_{'Goal' if acts else 'Request'}")
        call = self._calls.open(channel, feedback)
        self.send(Kind.CALL, channel.number, call.number, body)
        timeout = channel.binding["timeout"]
        try:
            if acts:  # no time limit: the bridge limits the wait for a server, and a goal may take arbitrarily long
                return await call.future
            async with asyncio.timeout(timeout):
                return await call.future
        except TimeoutError:
            self.send(Kind.CANCEL, channel.number, call.number)
            raise PlatformError(
                f"{self.title}: the service {channel.name} did not answer within {timeout:g} s: is its node alive? "
                "To wait longer: timeout=..."
            ) from None
        except asyncio.CancelledError:
            self.send(Kind.CANCEL, channel.number, call.number)
            raise
        finally:
            self._calls.close(call)

    async def graph(self, timeout: float = 10.0) -> dict[str, list[dict[str, Any]]]:  # noqa: ASYNC109  # a public name
        """Return the network's ``topics``, ``services`` and ``actions``, each with name, types and numbers of users.

        Raises:
            PlatformError: The bridge fails, or does not answer within `timeout` seconds.
        """
        self.start()
        try:
            async with asyncio.timeout(timeout):
                await self.ready.wait()
                self.start()  # this raises the error of a node that has failed
                call = self._calls.open(Channel(self, 0, {}, ""))
                try:
                    self.send(Kind.ASK, 0, call.number)
                    return await call.future
                finally:
                    self._calls.close(call)
        except TimeoutError:
            reason = "; ".join(sorted(self._told)) or "the bridge does not answer"
            raise PlatformError(f"{self.title}: {reason}") from None

    async def close(self) -> None:
        """Send the last messages. Then close the link and all connections, and end the open calls with an error."""
        for task in self._tasks:
            task.cancel()
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(LEAVING):
                await self._connections.flush()
        if self._link is not None:
            await self._link.close()
        self._connections.close()
        self._calls.fail_all("the node is closed")

    # ------------------------------------------------------------------------------- frames from the link

    def _bind_all(self) -> None:
        """Open all channels on a new link. Then send the latched messages and the frames that waited for the link."""
        frames = self._frames
        assert frames is not None  # the link has just become ready
        self._told.clear()  # log a fault again if it happens again
        latched = dict(self._latched)
        for channel in self.channels.values():
            channel.fault = ""
            frames.tell(Kind.BIND, channel.binding, channel.number)
            if channel.latches and (body := latched.pop(channel.name, None)) is not None:
                frames.send(Kind.MESSAGE, channel.number, 0, body)
        while self._waiting:
            kind, number, call, body = self._waiting.popleft()
            known = self.channels.get(number)
            if number == 0 or (known is not None and (kind is not Kind.MESSAGE or not known.latches)):
                frames.send(kind, number, call, body)
        self.ready.set()

    def _lost(self, why: str) -> None:
        self.ready.clear()
        self._connections.close()
        self._log.warning("%s", why)
        self._calls.fail_all(why)
        if self._link is not None and self._link.failed is not None:
            if self._failed is not None:
                self._failed(self._link.failed)
            self.ready.set()  # the link will never be ready; let the waiting callers see the failure

    def _handle(self, kind: Kind, channel: int, number: int, body: memoryview) -> None:
        known = self.channels.get(channel)
        if kind is Kind.MESSAGE and known is not None:
            known.offer(body, owed=True)
        elif kind in (Kind.SUBSCRIBER, Kind.PUBLISHER):
            self._connect(kind, number, json.loads(bytes(body)))
        elif kind is Kind.CALL:
            if known is not None:
                task = asyncio.create_task(self._serve(known, number, body))
                self._tasks.add(task)
                task.add_done_callback(self._tasks.discard)
        elif kind is Kind.NOTE:
            self._note(known, json.loads(bytes(body)))
        else:
            self._calls.answer(kind, number, body)

    def _connect(self, kind: Kind, number: int, what: dict[str, Any]) -> None:
        """Take over a connection that the bridge passes on."""
        frames = self._frames
        assert frames is not None  # the connection has come through this pipe
        sock = frames.passed()
        if kind is Kind.PUBLISHER:
            first: str = what.pop("first")
            self._connections.from_publisher(number, sock, Publisher(**what), first.encode("latin-1"))
            return
        connection = self._connections.to_subscriber(number, sock, **what)
        if (body := self._latched.get(what["topic"])) is not None:
            connection.send(body)

    def take(self, channel: Channel, body: memoryview) -> None:
        """Decode a message, and pass it to the `take` function of its channel."""
        assert channel.take is not None  # a channel that gets messages is a subscriber
        try:
            channel.take(self.types.decode(body, channel.type))
        except PlatformError as error:
            self._warn(f"{channel.name}: {error}")

    def acknowledge(self, channel: Channel) -> None:
        """Allow the bridge to send the channel's next message."""
        self._tell(Kind.ACK, channel.number)

    async def _serve(self, channel: Channel, number: int, body: memoryview) -> None:
        assert channel.serve is not None  # the channel is a server
        try:
            request = self.types.decode(body, f"{channel.type}_Request")
            answer = await channel.serve(request)
            self.send(Kind.ANSWER, channel.number, number, self.types.encode(answer, f"{channel.type}_Response"))
        except Exception as error:  # the caller gets the reason of each failure
            self._warn(f"{channel.name}: {error}")
            self.send(Kind.FAULT, channel.number, number, str(error).encode())

    def _note(self, channel: Channel | None, note: dict[str, Any]) -> None:
        text: str = note["text"]
        if note.get("failed") and channel is not None:
            channel.fault = f"{self.title}: {channel.name}: {text}"
            self._calls.fail(channel, channel.fault)
        self._warn(text, note["level"])

    def _warn(self, text: str, level: Literal["info", "warning", "error"] = "warning") -> None:
        """Log a text, unless it is already in the log. After a text of level `info`, or a new link, texts may repeat."""
        if level == "info":
            self._told.clear()
        if text not in self._told and len(self._told) < TOLD:
            self._told.add(text)
            self._log.log(logging.getLevelNamesMapping()[level.upper()], "%s: %s", self.title, text)
