"""Code of the bridge processes whose tests need an exact timing, which a real network does not allow."""

# pyright: basic
import importlib
import sys
import threading
import types
from pathlib import Path
from typing import Any

import pytest

import ravestate.modules.platform.ros

CHILDREN = Path(ravestate.modules.platform.ros.__file__).with_name("children")


def test_a_ros2_call_that_is_cancelled_while_it_waits_for_its_server_is_not_sent(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    raw: Any = types.ModuleType("rclpy.serialization")
    raw.serialize_message = raw.deserialize_message = lambda body, *_: body
    monkeypatch.syspath_prepend(CHILDREN)
    for name in ("pipe", "ros2_node"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.setitem(sys.modules, "rclpy", types.ModuleType("rclpy"))
    monkeypatch.setitem(sys.modules, "rclpy.serialization", raw)
    program: Any = importlib.import_module("ros2_node")
    monkeypatch.setattr(program, "interface", lambda _: types.SimpleNamespace(Request=None))
    sent: list[bytes] = []

    class Future:
        def add_done_callback(self, _: Any) -> None: ...

    class Client:
        cancels = True

        def wait_for_service(self, timeout_sec: float) -> bool:
            if self.cancels:
                node.cancel(1, 7)  # the cancellation comes during the wait
            return True

        def call_async(self, request: bytes) -> Future:
            sent.append(request)
            return Future()

    class Node(program.Ros2Node):
        def __init__(self) -> None:  # no real node is made
            self._bindings = {1: {"kind": "client", "type": "Lamp", "timeout": 5.0, "name": "/lamp"}}
            self._channels = {1: Client()}
            self._calls, self._goals = {}, {}
            self._pipe = types.SimpleNamespace(tell=print)
            self._executor = types.SimpleNamespace(wake=lambda: None)

    node: Any = Node()

    def call(number: int, body: bytes) -> None:
        others = set(threading.enumerate())
        node.call(1, number, body)
        for thread in set(threading.enumerate()) - others:
            thread.join()

    call(7, b"open")
    assert (sent, node._calls) == ([], {})
    Client.cancels = False
    call(8, b"close")
    assert sent == [b"close"] and list(node._calls) == [(1, 8)]
