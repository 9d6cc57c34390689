"""ROS 2's client library, as far as the documentation uses it: nodes of one process on a bus of its own."""

from __future__ import annotations

import queue
from collections.abc import Callable
from typing import Any

from rclpy.executors import ExternalShutdownException
from rclpy.signals import SignalHandlerOptions

__all__ = ["create_node", "init", "shutdown", "spin"]

Hear = Callable[[Any], None]
_bus: dict[str, list[tuple[Node, type, Hear]]] = {}
_up = False


def init(*, signal_handler_options: SignalHandlerOptions) -> None:
    """Begin; the signals of the process are left alone."""
    global _up
    assert signal_handler_options is SignalHandlerOptions.NO
    assert not _up, "once a process"
    _up = True


def shutdown() -> None:
    """End all spinning."""
    global _up
    assert _up
    _up = False
    for node in {node for listeners in _bus.values() for node, _, _ in listeners}:
        node.calls.put(None)
    _bus.clear()


class Node:
    """Its callbacks run where it spins."""

    def __init__(self) -> None:
        self.calls: queue.Queue[Callable[[], None] | None] = queue.Queue()

    def create_subscription(self, kind: type, topic: str, hear: Hear, depth: int) -> None:
        _bus.setdefault(topic, []).append((self, kind, hear))

    def create_publisher(self, kind: type, topic: str, depth: int) -> Publisher:
        return Publisher(kind, topic)


class Publisher:
    """Hands messages to all who listen to the topic."""

    def __init__(self, kind: type, topic: str) -> None:
        self._kind, self._topic = kind, topic

    def publish(self, message: Any) -> None:
        assert isinstance(message, self._kind)
        for node, kind, hear in _bus.get(self._topic, ()):
            assert kind is self._kind
            node.calls.put(lambda hear=hear: hear(message))


def create_node(name: str) -> Node:
    assert _up
    return Node()


def spin(node: Node) -> None:
    """Call back until the end."""
    while (call := node.calls.get()) is not None:
        call()
    raise ExternalShutdownException
