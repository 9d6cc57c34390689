"""The built-in bus, which replaces ROS for an agent and a simulated robot on a machine without ROS.

The bus is a server on a local TCP port. It exchanges frames with its nodes, as a bridge process does
(``children/pipe.py``). A frame has a head and a body. The bus passes messages and calls from one node to the others.
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import json
import socket
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from ravestate.errors import PlatformError

from .children.pipe import Outlet
from .frames import Frames, Handle, Kind
from .node import MakeLink

AGAIN = 0.5
"""The time between two attempts to reach the bus (seconds)."""


def host_and_port(address: str) -> tuple[str, int]:
    """Return the host and the port in the address of a bus, such as ``127.0.0.1:7411``.

    Raises:
        PlatformError: The text is not an address.
    """
    host, _, port = address.rpartition(":")
    if not port.isdecimal() or int(port) > 65535:
        raise PlatformError(f"bus={address!r} is not an address: write HOST:PORT, such as 127.0.0.1:7411")
    return host or "127.0.0.1", int(port)


class Bus:
    """The server of the bus. ``async with Bus(port) as bus`` runs it on the current event loop.

    Args:
        port: The TCP port; 0 takes a free one.
        host: The address to listen on.

    Raises:
        PlatformError: The server cannot listen on the address, for example because the port is in use.
    """

    def __init__(self, port: int = 7411, host: str = "127.0.0.1") -> None:
        self.address = f"{host}:{port}"
        """The address to which nodes connect."""
        self._host, self._port = host, port
        self._nodes: set[_BusNode] = set()
        self.calls: dict[int, _Call] = {}
        """Number of a call on the bus → the call, for all calls that wait for an answer."""
        self._numbers = itertools.count(1)

    async def __aenter__(self) -> Bus:
        sock = socket.socket()
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            sock.bind((self._host, self._port))
        except OSError as error:
            sock.close()
            raise PlatformError(
                f"the bus cannot listen on {self.address} ({error.strerror}): does another stand-in robot run? "
                "To use another port: --bus 127.0.0.1:7412"
            ) from error
        sock.listen()
        sock.setblocking(False)
        self.address = f"{self._host}:{sock.getsockname()[1]}"
        self._sock = sock
        asyncio.get_running_loop().add_reader(sock, self._accept)
        return self

    async def __aexit__(self, *_: object) -> None:
        asyncio.get_running_loop().remove_reader(self._sock)
        self._sock.close()
        for node in list(self._nodes):
            node.frames.close()

    def _accept(self) -> None:
        with contextlib.suppress(BlockingIOError):
            connection, _ = self._sock.accept()
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self._nodes.add(_BusNode(self, connection))

    def leave(self, node: _BusNode) -> None:
        """Forget a node, and send a fault to the nodes that wait for its answers."""
        self._nodes.discard(node)
        for own, call in list(self.calls.items()):
            if call.caller is node:
                del self.calls[own]
            elif call.server is node:
                del self.calls[own]
                call.caller.frames.tell(Kind.FAULT, "the node of the service is gone", call.channel, call.number)

    def find(self, kind: str, name: str) -> list[tuple[_BusNode, int, dict[str, Any]]]:
        """Return each channel that has this kind and name: its node, its number, and its binding (its description)."""
        return [
            (node, channel, binding)
            for node in self._nodes
            for channel, binding in node.bindings.items()
            if binding["kind"] == kind and binding["name"] == name
        ]

    def publish(self, binding: Mapping[str, Any], body: memoryview) -> None:
        """Pass on a message to all subscribers of its topic. A subscriber with another type gets a warning instead."""
        for node, channel, _ in self.find("subscriber", binding["name"]):
            node.get(channel, binding, body)

    def call(self, caller: _BusNode, channel: int, number: int, body: memoryview) -> None:
        """Pass on a call to the server of its service. If there is none, or it has another type, answer with a fault."""
        binding = caller.bindings[channel]
        found = self.find("server", binding["name"])
        if not found:
            caller.frames.tell(Kind.FAULT, f"nobody offers {binding['name']}", channel, number)
            return
        server, place, other = found[0]
        if other["type"] != binding["type"]:
            caller.frames.tell(
                Kind.FAULT, f"{binding['name']} is a {other['type']}, not {binding['type']}", channel, number
            )
            return
        own = next(self._numbers)
        self.calls[own] = _Call(caller, channel, number, server)
        server.frames.send(Kind.CALL, place, own, body)

    def answer(self, kind: Kind, own: int, body: memoryview) -> None:
        """Pass on an answer to the caller. `own` is the number that the bus has given to the call."""
        call = self.calls.pop(own, None)
        if call is not None and kind is Kind.FAULT:
            call.caller.frames.tell(Kind.FAULT, bytes(body).decode(), call.channel, call.number)
        elif call is not None:
            call.caller.frames.send(kind, call.channel, call.number, body)

    def cancel(self, caller: _BusNode, channel: int, number: int) -> None:
        """Forget a call whose caller no longer waits."""
        self.calls = {
            own: call
            for own, call in self.calls.items()
            if (call.caller, call.channel, call.number) != (caller, channel, number)
        }

    def graph(self, asker: _BusNode) -> dict[str, Any]:
        """Return all topics and services. Their counts of publishers, subscribers and servers leave out `asker`."""
        topics: dict[str, dict[str, Any]] = {}
        services: dict[str, dict[str, Any]] = {}
        for node in self._nodes:
            for binding in node.bindings.values():
                name, kind = binding["name"], binding["kind"]
                other = int(node is not asker)
                if kind in ("publisher", "subscriber"):
                    row = topics.setdefault(name, {"name": name, "types": [], "publishers": 0, "subscribers": 0})
                    row[f"{kind}s"] += other
                elif kind == "server":
                    row = services.setdefault(name, {"name": name, "types": [], "servers": 0})
                    row["servers"] += other
                else:
                    continue
                if binding["type"] not in row["types"]:
                    row["types"].append(binding["type"])
        return {"topics": list(topics.values()), "services": list(services.values()), "actions": []}


@dataclass(frozen=True, slots=True)
class _Call:
    """An open call: the node that calls, its channel and its number for the call, and the node that must answer."""

    caller: _BusNode
    channel: int
    number: int
    server: _BusNode


class _BusNode:
    """The bus's side of the connection to one node."""

    def __init__(self, bus: Bus, connection: socket.socket) -> None:
        self.bindings: dict[int, dict[str, Any]] = {}
        self.outlets: dict[int, Outlet] = {}
        self._bus = bus
        self._latched: dict[int, memoryview] = {}
        self.frames = Frames(connection, self._handle, lambda: bus.leave(self))

    def get(self, channel: int, publisher: Mapping[str, Any], body: memoryview) -> None:
        """Send a message of a publisher to a subscriber of this node. If their types differ, send a warning instead."""
        own = self.bindings[channel]
        if own["type"] == publisher["type"]:
            self.outlets[channel].put(body)
            return
        text = f"{own['name']} carries {publisher['type']}, not {own['type']}"
        self.frames.tell(Kind.NOTE, {"text": text, "level": "warning"}, channel)

    def _handle(self, kind: Kind, channel: int, number: int, body: memoryview) -> None:
        bus = self._bus
        if kind is Kind.OPEN:
            self.frames.send(Kind.READY)
        elif kind is Kind.BIND:
            binding = self.bindings[channel] = json.loads(bytes(body))
            if binding["kind"] == "subscriber":
                self.outlets[channel] = Outlet(self.frames, channel, binding["latest"])
                for node, other, publisher in bus.find("publisher", binding["name"]):
                    if other in node._latched:
                        self.get(channel, publisher, node._latched[other])
        elif kind is Kind.UNBIND:
            self.bindings.pop(channel, None)
            self.outlets.pop(channel, None)
            self._latched.pop(channel, None)
        elif kind is Kind.ACK and channel in self.outlets:
            self.outlets[channel].acknowledge()
        elif kind is Kind.MESSAGE and channel in self.bindings:
            if self.bindings[channel]["latch"]:
                self._latched[channel] = body
            bus.publish(self.bindings[channel], body)
        elif kind is Kind.CALL and channel in self.bindings:
            bus.call(self, channel, number, body)
        elif kind is Kind.CANCEL:
            bus.cancel(self, channel, number)
        elif kind in (Kind.ANSWER, Kind.FAULT):
            bus.answer(kind, number, body)
        elif kind is Kind.ASK:
            self.frames.tell(Kind.TOLD, bus.graph(self), 0, number)
        elif kind is Kind.CLOSE:
            self.frames.close()
            bus.leave(self)


class BusLink:
    """A node's connection to the bus. If the bus stops and starts again, the link connects again."""

    pid = None

    def __init__(
        self,
        address: str,
        config: Mapping[str, Any],
        handle: Handle,
        ready: Callable[[], None],
        lost: Callable[[str], None],
    ) -> None:
        self.failed: PlatformError | None = None
        self.restarts = 0
        self._address = address
        self._config = config
        self._handle, self._ready, self._lost = handle, ready, lost
        self._frames: Frames | None = None
        self._works = False
        self._task: asyncio.Task[None] | None = None

    @property
    def frames(self) -> Frames | None:
        """The pipe to the bus; None while there is no working connection."""
        return self._frames if self._works else None

    def start(self) -> None:
        """Connect as soon as the bus runs."""
        try:
            host, port = host_and_port(self._address)
        except PlatformError as error:
            self.failed = error
            return
        self._task = asyncio.ensure_future(self._connect(host, port))

    async def _connect(self, host: str, port: int) -> None:
        loop, told = asyncio.get_running_loop(), False
        while True:
            sock = socket.socket()
            sock.setblocking(False)
            try:
                await loop.sock_connect(sock, (host, port))
                break
            except (OSError, UnicodeError):  # UnicodeError: no host can have this name
                sock.close()
                if not told:
                    told = True
                    note = {
                        "text": f"waits for the bus at {self._address}: start `ravestate robot`",
                        "level": "warning",
                    }
                    self._handle(Kind.NOTE, 0, 0, memoryview(json.dumps(note).encode()))
                await asyncio.sleep(AGAIN)
            except asyncio.CancelledError:
                sock.close()
                raise
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._frames = Frames(sock, self._take, self._broken)
        self._frames.tell(Kind.OPEN, self._config)

    def _take(self, kind: Kind, channel: int, number: int, body: memoryview) -> None:
        if kind is Kind.READY:
            self._works = True
            self._ready()
        else:
            self._handle(kind, channel, number, body)

    def _broken(self) -> None:
        self._works = False
        self.restarts += 1
        self._lost(f"the bus at {self._address} is gone; the node waits until it is back")
        self.start()

    async def close(self) -> None:
        """Tell the bus that the node leaves, and close the connection."""
        if self._task is not None:
            self._task.cancel()
        if self._frames is not None:
            self._frames.send(Kind.CLOSE)
            await self._frames.flush()
            self._frames.close()

    def kill(self) -> None:
        """Close the connection immediately."""
        if self._task is not None:
            self._task.cancel()
        if self._frames is not None:
            self._frames.close()


def bus_link(address: str) -> MakeLink:
    """Return a function that connects a node to the bus at an address."""
    return lambda config, handle, ready, lost: BusLink(address, config, handle, ready, lost)
