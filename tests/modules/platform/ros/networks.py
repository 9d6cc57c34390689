"""Real networks of ROS 1 and ROS 2 on the loopback interface, for tests."""

from __future__ import annotations

import abc
import asyncio
import atexit
import contextlib
import functools
import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import AsyncIterator, Callable, Coroutine, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar

from ravestate.modules import ros1, ros2
from ravestate.modules.platform.ros.definitions import Definitions
from ravestate.modules.platform.ros.node import Node
from ravestate.modules.platform.ros.types import Types
from ravestate.runtime.clock import Clock

HERE = Path(__file__).parent
PATIENCE = 20.0
"""The time after which a waiting test fails (seconds)."""
ROS2_PYTHON = Path(sys.prefix).parent / ".venvs" / "ros2" / "bin" / "python"
OWN = HERE / "definitions"
"""A folder with the definitions of a message package that is not installed."""


T = TypeVar("T")


@functools.cache
def the_loop() -> asyncio.Runner:
    """Return the event loop that all shared nodes use."""
    runner = asyncio.Runner()
    atexit.register(runner.close)
    return runner


def free_port() -> int:
    with socket.socket() as sock:
        sock.bind(("127.0.0.1", 0))
        return sock.getsockname()[1]


class Network(abc.ABC):
    """A network with one other node, the peer, in a separate process.

    All nodes of the tests use one event loop, so that tests can share a node and its bridge.
    """

    version: int
    module: ModuleType
    settings: dict[str, Any]

    def __init__(self) -> None:
        self.peer: subprocess.Popen[str] | None = None
        self._nodes: dict[str, Node] = {}

    def run(self, main: Callable[[], Coroutine[Any, Any, T]]) -> T:
        """Run a test on the loop of the shared nodes."""

        async def in_time() -> T:
            async with asyncio.timeout(PATIENCE):
                return await main()

        return the_loop().run(in_time())

    @abc.abstractmethod
    def start_peer(self) -> None:
        """Start the peer."""

    def _run_peer(self, python: str, file: str, *arguments: str) -> None:
        self.peer = subprocess.Popen(
            [python, str(HERE / file), *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL, text=True, env={**os.environ, **self.environment},
        )  # fmt: skip
        assert self.peer.stdout is not None
        line = self.peer.stdout.readline()
        assert line == "ready\n", f"the other node of ROS {self.version} did not start: run `make ros` first"

    @property
    @abc.abstractmethod
    def environment(self) -> dict[str, str]:
        """The environment variables with which a process finds the network."""

    def node(self, **options: Any) -> Node:
        """Return a new node, as an agent makes it. The test must use the node on a loop, and close it."""
        settings = self.module.Settings(**self.settings[f"ros{self.version}"], definitions=(OWN,), **options)
        return self.module.make_node(settings)

    @contextlib.asynccontextmanager
    async def lent(self, **options: Any) -> AsyncIterator[Node]:
        """Yield the node that all tests share, and close its channels at the end of the ``with`` block."""
        key = repr(options)
        if key not in self._nodes:
            self._nodes[key] = self.node(**options)
        node = self._nodes[key]
        try:
            yield node
        finally:
            for channel in list(node.channels.values()):
                channel.close()

    def stop_peer(self) -> None:
        end(self.peer)
        self.peer = None

    def stop(self) -> None:
        for node in self._nodes.values():
            the_loop().run(node.close())
        self.stop_peer()


class Ros1(Network):
    version, module = 1, ros1

    def __init__(self) -> None:
        super().__init__()
        self.port = free_port()
        self.settings = {"ros1": {"master": f"http://127.0.0.1:{self.port}", "ip": "127.0.0.1"}}
        self.master: subprocess.Popen[bytes] | None = None
        self.start_master()

    @property
    def environment(self) -> dict[str, str]:
        return {"ROS_MASTER_URI": self.settings["ros1"]["master"], "ROS_IP": "127.0.0.1"}

    def start_master(self) -> None:
        self.master = subprocess.Popen(
            ["rosmaster", "--core", "-p", str(self.port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            env={**os.environ, **self.environment, "ROS_LOG_DIR": "/tmp/ros-log"},
        )  # fmt: skip

        for _ in range(200):
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", self.port), 1.0):
                return
            threading.Event().wait(0.02)
        raise AssertionError("rosmaster did not start: run `make ros` first")

    def start_peer(self) -> None:
        types = Types(1, Definitions((OWN,)))
        _, md5 = types.ros1_definition(types.require("robot_msgs/Reading"))
        self._run_peer("/usr/bin/python3", "peer1.py", md5)

    def stop(self) -> None:
        super().stop()
        end(self.master)


class Ros2(Network):
    version, module = 2, ros2

    def __init__(self) -> None:
        super().__init__()
        self.domain = 1 + os.getpid() % 100
        self.settings = {"ros2": {"domain": self.domain}}

    @property
    def environment(self) -> dict[str, str]:
        return {"ROS_DOMAIN_ID": str(self.domain)}

    def start_peer(self) -> None:
        self._run_peer(str(ROS2_PYTHON), "peer2.py")


def end(process: subprocess.Popen[Any] | None) -> None:
    """Kill a process, and close its pipes."""
    if process is None:
        return
    process.send_signal(signal.SIGKILL)
    process.wait()
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            with contextlib.suppress(OSError):
                pipe.close()


@contextlib.contextmanager
def network(version: int) -> Iterator[Network]:
    made: Network = Ros1() if version == 1 else Ros2()
    try:
        made.start_peer()
        yield made
    finally:
        made.stop()


@contextlib.asynccontextmanager
async def opened(node: Node) -> AsyncIterator[Node]:
    try:
        async with asyncio.timeout(PATIENCE):
            yield node
    finally:
        await node.close()


async def pause(seconds: float) -> None:
    """Wait for some real time, so that the other processes continue."""
    await Clock(asyncio.get_running_loop()).sleep(seconds)


async def until(reached: Callable[[], object], again: Callable[[], None] = lambda: None, every: float = 0.02) -> None:
    """Repeat the action `again` until a condition is true. Nodes take time to connect, so one attempt is not enough."""
    async with asyncio.timeout(PATIENCE):
        while not reached():
            again()
            await pause(every)
