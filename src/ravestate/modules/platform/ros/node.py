"""A node: the topics, services and actions that an agent uses, over one bridge or bus."""

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

from .channel import Channel
from .connections import Connections, Publisher
from .frames import Frames, Handle, Kind
from .goals import GoalTopics
from .naming import resolve
from .types import Types

TOLD = 100
"""The maximum number of different texts that a node logs. Good news or a new link resets the count."""
WAITING = 1000
"""The maximum number of messages that wait while the bridge starts. Then the oldest is dropped."""
LEAVING = 2.0
"""Seconds that the last messages have to leave when a node ends."""

_nodes = itertools.count(1)  # two nodes of one process need two names: ROS 1 ends an older node of the same name


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
"""Makes a link from the node's configuration and the functions `handle`, `ready` and `lost`; see `BridgeProcess`."""


class Node:
    """A node of ROS or of the bus. It connects at its first use; a link that breaks is made again.

    Args:
        title: The name of the node in logs and errors, such as ``ros1``.
        types: The types of its messages.
        make_link: Makes the link.
        name: The node's name.
        namespace: The namespace of relative names.
        remap: Name → the name that takes its place.
        environment: Environment variables for the bridge.
        log: Where warnings go.
        failed: Called with the reason if there can be no link.
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
        """Slot's name → its channel, for the slots that publish or call."""
        self.goals: dict[str, set[asyncio.Future[Any]]] = {}
        """Slot's name → its goals under way."""
        self.ready = asyncio.Event()
        """Set while the link works."""
        number = next(_nodes)
        self._name = f"{name}_{os.getpid()}" + (f"_{number}" if number > 1 else "")
        self._namespace = namespace
        self._remap = remap or {}
        self._log = log or logging.getLogger(f"ravestate.{title}")
        config = {"name": resolve(self._name, "", namespace, {}), "environment": dict(environment or {})}
        self._make_link = partial(make_link, config, self._handle, self._bind_all, self._lost)
        self._link: Link | None = None
        self._failed = failed
        self._numbers = itertools.count(1)
        self._connections = Connections(partial(self._tell, Kind.HANGUP, 0), self._warn)
        self._latched: dict[str, memoryview] = {}
        """Topic → the last message, if a channel latches it."""
        self._calls: dict[int, tuple[asyncio.Future[Any], Channel, Callable[[Any], None] | None]] = {}
        self._waiting: deque[tuple[Kind, int, int, memoryview | bytes]] = deque(maxlen=WAITING)
        self._told: set[str] = set()
        self._preparing: asyncio.Future[Any] | None = None
        self._tasks: set[asyncio.Task[None]] = set()

    @property
    def pid(self) -> int | None:
        """The number of the bridge's process, if it runs."""
        return None if self._link is None else self._link.pid

    @property
    def restarts(self) -> int:
        """The number of times that the link was made again."""
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
            rate: The maximum number of messages a second; the newest of each interval is taken.
            qos: The quality of service; see `naming.quality`.

        Raises:
            PlatformError: The type is unknown.
        """
        binding = {"latest": latest or rate is not None, "qos": dict(qos)}
        return self._open("subscriber", topic, type, binding, take=take, pause=1 / rate if rate else 0.0)

    def advertise(self, topic: str, type: str, *, latch: bool = False, qos: Mapping[str, Any]) -> Channel:
        """Return a channel to publish on. With `latch`, late subscribers get the last message."""
        return self._open("publisher", topic, type, {"latch": latch, "depth": qos["depth"], "qos": dict(qos)})

    def client(self, service: str, type: str, *, timeout: float) -> Channel:
        """Return a channel to call a service, with a time-out in seconds."""
        return self._open("client", service, type, {"timeout": timeout}, "srv")

    def offer(self, service: str, type: str, serve: Callable[[Any], Awaitable[Any]]) -> Channel:
        """Offer a service: `serve` gets the request, and returns the response."""
        return self._open("server", service, type, {}, "srv", serve=serve)

    def action(self, name: str, type: str, *, timeout: float) -> Channel | GoalTopics:
        """Return a channel to send goals; the server has `timeout` seconds to appear."""
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
        """Return the absolute name that a name stands for, after remapping."""
        return resolve(name, self._name, self._namespace, self._remap)

    def drop(self, channel: Channel) -> None:
        """End a channel."""
        if self.channels.pop(channel.number, None) is not None:
            if channel.take is not None:
                self._connections.drop(channel)
            if not any(other.latches and other.name == channel.name for other in self.channels.values()):
                self._latched.pop(channel.name, None)
            self._tell(Kind.UNBIND, channel.number)

    # ------------------------------------------------------------------------------- acting

    def start(self) -> None:
        """Start to connect, unless the node has already started.

        Raises:
            PlatformError: There is no ROS here, or it does not start.
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
            PlatformError: The library of types is missing.
        """
        if not self.types.loaded:
            if self._preparing is None:  # all callers await one future, so they go on in their order
                self._preparing = asyncio.ensure_future(asyncio.to_thread(lambda: self.types.store))
            await asyncio.shield(self._preparing)

    def send(self, kind: Kind, channel: int, number: int, body: memoryview | bytes = b"") -> None:
        """Send a frame, or keep it until the link works."""
        if frames := self._frames:
            frames.send(kind, channel, number, body)
        else:
            self._waiting.append((kind, channel, number, body))

    def publish(self, channel: Channel, body: memoryview) -> None:
        """Send a message by the connections that the bridge has passed on; if there are none, by the bridge."""
        if channel.latches:
            self._latched[channel.name] = body
        if not self._connections.send(channel.name, body):
            self.send(Kind.MESSAGE, channel.number, 0, body)

    def _tell(self, kind: Kind, channel: int, number: int = 0) -> None:
        """Send a frame that is of use to the present link alone."""
        if frames := self._frames:
            frames.send(kind, channel, number)

    async def call(self, channel: Channel, value: Any, feedback: Callable[[Any], None] | None = None) -> Any:
        """See `Channel.call`."""
        if channel.fault:
            raise PlatformError(channel.fault)
        acts = channel.binding["kind"] == "action"
        body = self.types.encode(value, f"{channel.type}_{'Goal' if acts else 'Request'}")
        number = next(self._numbers)
        future: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
        self._calls[number] = future, channel, feedback
        self.send(Kind.CALL, channel.number, number, body)
        timeout = channel.binding["timeout"]
        try:
            if acts:  # the bridge watches whether there is a server; a goal may take any time
                return await future
            async with asyncio.timeout(timeout):
                return await future
        except TimeoutError:
            self.send(Kind.CANCEL, channel.number, number)
            raise PlatformError(
                f"{self.title}: the service {channel.name} did not answer within {timeout:g} s: is its node alive? "
                "A longer time: timeout=..."
            ) from None
        except asyncio.CancelledError:
            self.send(Kind.CANCEL, channel.number, number)
            raise
        finally:
            del self._calls[number]

    async def graph(self, timeout: float = 10.0) -> dict[str, list[dict[str, Any]]]:  # noqa: ASYNC109  # a public name
        """Return the network's ``topics``, ``services`` and ``actions``, each with name, types and numbers of nodes.

        Raises:
            PlatformError: The bridge does not work.
        """
        self.start()
        try:
            async with asyncio.timeout(timeout):
                await self.ready.wait()
                self.start()  # it may have failed
                number = next(self._numbers)
                future: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
                self._calls[number] = future, Channel(self, 0, {}, ""), None
                try:
                    self.send(Kind.ASK, 0, number)
                    return await future
                finally:
                    self._calls.pop(number, None)
        except TimeoutError:
            reason = "; ".join(sorted(self._told)) or "the bridge does not answer"
            raise PlatformError(f"{self.title}: {reason}") from None

    async def close(self) -> None:
        """End all channels and the link, in order."""
        for task in self._tasks:
            task.cancel()
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(LEAVING):
                await self._connections.flush()
        if self._link is not None:
            await self._link.close()
        self._connections.close()
        self._fail_calls("the node is closed")

    # ------------------------------------------------------------------------------- frames from the link

    def _bind_all(self) -> None:
        frames = self._frames
        assert frames is not None  # the link has just become ready
        self._told.clear()  # a fault that comes back is logged again
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
        self._fail_calls(why)
        if self._link is not None and self._link.failed is not None:
            if self._failed is not None:
                self._failed(self._link.failed)
            self.ready.set()  # a failed link never gets ready: let the callers that wait see the failure

    def _fail_calls(self, why: str) -> None:
        for future, channel, _ in list(self._calls.values()):
            if not future.done():
                future.set_exception(PlatformError(f"{self.title}: {channel.binding.get('name', 'the graph')}: {why}"))

    def _handle(self, kind: Kind, channel: int, number: int, body: memoryview) -> None:
        known = self.channels.get(channel)
        if kind is Kind.MESSAGE and known is not None:
            known.offer(body, owed=True)
        elif kind in (Kind.SUBSCRIBER, Kind.PUBLISHER):
            self._connect(kind, number, json.loads(bytes(body)))
        elif kind is Kind.CALL and known is not None:
            task = asyncio.create_task(self._serve(known, number, body))
            self._tasks.add(task)
            task.add_done_callback(self._tasks.discard)
        elif kind is Kind.NOTE:
            self._note(known, json.loads(bytes(body)))
        elif number in self._calls:
            self._answer(kind, number, body)

    def _connect(self, kind: Kind, number: int, what: dict[str, Any]) -> None:
        """Take over a connection that the bridge passes on."""
        frames = self._frames
        assert frames is not None  # it is from there
        sock = frames.passed()
        if kind is Kind.PUBLISHER:
            first: str = what.pop("first")
            self._connections.from_publisher(number, sock, Publisher(**what), first.encode("latin-1"))
            return
        connection = self._connections.to_subscriber(number, sock, **what)
        if (body := self._latched.get(what["topic"])) is not None:
            connection.send(body)

    def take(self, channel: Channel, body: memoryview) -> None:
        """Take a message for a channel that subscribes."""
        assert channel.take is not None  # it subscribes
        try:
            channel.take(self.types.decode(body, channel.type))
        except PlatformError as error:
            self._warn(f"{channel.name}: {error}")

    def acknowledge(self, channel: Channel) -> None:
        """Let the bridge send the next message."""
        self._tell(Kind.ACK, channel.number)

    async def _serve(self, channel: Channel, number: int, body: memoryview) -> None:
        assert channel.serve is not None  # it is a server
        try:
            request = self.types.decode(body, f"{channel.type}_Request")
            answer = await channel.serve(request)
            self.send(Kind.ANSWER, channel.number, number, self.types.encode(answer, f"{channel.type}_Response"))
        except Exception as error:  # the caller gets the reason of any failure
            self._warn(f"{channel.name}: {error}")
            self.send(Kind.FAULT, channel.number, number, str(error).encode())

    def _note(self, channel: Channel | None, note: dict[str, Any]) -> None:
        text: str = note["text"]
        if note.get("failed") and channel is not None:
            channel.fault = f"{self.title}: {channel.name}: {text}"
            for future, of, _ in self._calls.values():
                if of is channel and not future.done():
                    future.set_exception(PlatformError(channel.fault))
        self._warn(text, note["level"])

    def _warn(self, text: str, level: Literal["info", "warning", "error"] = "warning") -> None:
        """Log a text once. After a text of level `info`, or with a new link, the same text may be logged again."""
        if level == "info":
            self._told.clear()
        if text not in self._told and len(self._told) < TOLD:
            self._told.add(text)
            self._log.log(logging.getLevelNamesMapping()[level.upper()], "%s: %s", self.title, text)

    def _answer(self, kind: Kind, number: int, body: memoryview) -> None:
        future, channel, feedback = self._calls[number]
        if future.done():
            return
        if kind is Kind.FAULT:
            future.set_exception(PlatformError(f"{self.title}: {channel.name}: {json.loads(bytes(body))}"))
            return
        if kind is Kind.TOLD:
            told = json.loads(bytes(body))
            if "error" in told:
                future.set_exception(PlatformError(f"{self.title}: {told['error']}"))
            else:
                future.set_result(told)
            return
        acts = channel.binding["kind"] == "action"
        part = "Feedback" if kind is Kind.FEEDBACK else "Result" if acts else "Response"
        try:
            value = self.types.decode(body, f"{channel.type}_{part}")
        except PlatformError as error:
            future.set_exception(error)
            return
        if kind is Kind.FEEDBACK:
            if feedback is not None:
                feedback(value)
        else:
            future.set_result(value)
