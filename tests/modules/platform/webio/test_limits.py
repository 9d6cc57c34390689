"""The server's time limits for requests and answers."""

import asyncio
from typing import Any
from unittest.mock import Mock

import pytest
import uvicorn
from starlette.types import Receive, Scope, Send
from uvicorn.server import ServerState
from websockets.protocol import State
from websockets.server import ServerProtocol

from modules.platform.webio.visit import in_virtual_time, past
from ravestate.modules.platform.webio.limits import LOWEST_RATE, TIMEOUT, LimitedHTTP, LimitedWebSocket


class Reader:
    """An application that reads a request, and answers with the size of its body in bytes.

    Args:
        before: The time before it begins to read (seconds).
        after: The time after reading and before the answer (seconds).
    """

    def __init__(self, before: float = 0.0, after: float = 0.0) -> None:
        self._before = before
        self._after = after

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        await past(self._before)
        size, more = 0, True
        while more:
            message = await receive()
            if message["type"] == "http.disconnect":
                return
            size += len(message["body"])
            more = message["more_body"]
        await past(self._after)
        body = f"{size} bytes".encode()
        headers = [(b"content-length", b"%d" % len(body))]
        await send({"type": "http.response.start", "status": 200, "headers": headers})
        await send({"type": "http.response.body", "body": body})


class Refuser:
    """An application that answers without reading the request."""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        await send({"type": "http.response.start", "status": 401, "headers": [(b"content-length", b"0")]})
        await send({"type": "http.response.body", "body": b""})


class Caller(asyncio.Transport):
    """A stand-in for a client: the transport that the server uses."""

    def __init__(self, app: Any) -> None:
        super().__init__({"peername": ("127.0.0.1", 50000), "sockname": ("127.0.0.1", 8420)})
        config = uvicorn.Config(app, log_config=None, access_log=False, lifespan="off", timeout_keep_alive=15)
        state = ServerState()
        self.limits = LimitedHTTP(config=config, server_state=state, app_state={}, per_address=9, most=9)
        self.answer = b""
        self.reads = True
        """Whether the server reads the client's data."""
        self.hung_up: float | None = None
        """The time at which the server closed the connection (seconds)."""
        self.limits.connection_made(self)

    def send(self, data: bytes) -> None:
        """Send data to the server."""
        assert self.reads
        self.limits.data_received(data)

    async def send_slowly(self, data: bytes, rate: float) -> None:
        """Send data at a rate (bytes per second), as far as the server reads it."""
        while data and self.hung_up is None:
            await past(1.0)
            if self.reads and self.hung_up is None:
                self.send(data[: int(rate)])
                data = data[int(rate) :]

    def get_protocol(self) -> asyncio.BaseProtocol:
        return self.limits

    def write(self, data: Any) -> None:
        self.answer += data

    def is_closing(self) -> bool:
        return self.hung_up is not None

    def pause_reading(self) -> None:
        self.reads = False

    def resume_reading(self) -> None:
        self.reads = True

    def abort(self) -> None:
        if self.hung_up is None:
            loop = asyncio.get_running_loop()
            self.hung_up = loop.time()
            loop.call_soon(self.limits.connection_lost, None)

    close = abort


def request(size: int) -> bytes:
    return b"POST / HTTP/1.1\r\nhost: 127.0.0.1\r\ncontent-length: %d\r\n\r\n" % size


@in_virtual_time
async def test_a_long_request_is_accepted_if_its_rate_is_high_enough() -> None:
    size = int(2 * LOWEST_RATE * 20 * TIMEOUT)
    caller = Caller(Reader())
    caller.send(request(size))
    await caller.send_slowly(b"x" * size, rate=2 * LOWEST_RATE)
    await past(0.1)
    assert asyncio.get_running_loop().time() > 20 * TIMEOUT
    assert caller.answer.endswith(b"%d bytes" % size)


@in_virtual_time
async def test_the_server_drops_a_client_whose_request_is_very_slow() -> None:
    caller = Caller(Reader())
    caller.send(request(10**6))
    await caller.send_slowly(b"x" * 10**6, rate=100)
    assert caller.hung_up == 2 * TIMEOUT


@in_virtual_time
async def test_a_request_in_bursts_is_accepted_if_its_average_rate_is_high_enough() -> None:
    size = int(LOWEST_RATE * 20 * TIMEOUT)
    caller = Caller(Reader())
    caller.send(request(size))
    for _ in range(20):
        caller.send(b"x" * (size // 20))
        await past(TIMEOUT / 2)
        assert caller.hung_up is None
        await past(TIMEOUT / 2)
    assert caller.answer.endswith(b"%d bytes" % size)


@in_virtual_time
async def test_the_server_drops_a_client_whose_bursts_have_too_low_an_average_rate() -> None:
    size, each = 10**7, int(LOWEST_RATE * TIMEOUT)
    caller = Caller(Reader())
    caller.send(request(size))
    while caller.hung_up is None:  # each burst has half of the data that the lowest rate requires
        caller.send(b"x" * each)
        await past(2 * TIMEOUT)
        assert asyncio.get_running_loop().time() < 10 * TIMEOUT


@pytest.mark.parametrize(("share", "looks"), [(0.6, 3), (0.9, 10)])
def test_a_client_slightly_below_the_lowest_rate_is_dropped_later_than_a_slow_one(share: float, looks: int) -> None:
    @in_virtual_time
    async def test() -> None:
        caller = Caller(Reader())
        caller.send(request(10**6))
        await caller.send_slowly(b"x" * 10**6, rate=share * LOWEST_RATE)
        assert caller.hung_up == looks * TIMEOUT

    test()


@in_virtual_time
async def test_the_server_drops_a_client_whose_headers_are_slow() -> None:
    caller = Caller(Reader())
    await caller.send_slowly(b"GET / HTTP/1.1\r\nx: " + b"x" * 1000, rate=1)
    assert caller.hung_up == TIMEOUT


@in_virtual_time
async def test_the_server_keeps_a_client_that_waits_for_an_answer() -> None:
    caller = Caller(Reader(after=10 * TIMEOUT))
    caller.send(request(5) + b"hello")
    await past(10 * TIMEOUT + 1)
    assert caller.answer.endswith(b"5 bytes")


@in_virtual_time
async def test_the_server_keeps_a_client_whose_request_it_reads_late() -> None:
    size = 10**6
    caller = Caller(Reader(before=10 * TIMEOUT + 3))
    caller.send(request(size))
    await caller.send_slowly(b"x" * size, rate=2 * LOWEST_RATE)
    await past(0.1)
    assert caller.answer.endswith(b"%d bytes" % size)


@in_virtual_time
async def test_the_server_drops_a_client_that_keeps_sending_after_the_answer() -> None:
    caller = Caller(Refuser())
    caller.send(request(10**7))
    await caller.send_slowly(b"x" * 10**7, rate=2 * LOWEST_RATE)
    assert caller.hung_up == 2 * TIMEOUT


@in_virtual_time
async def test_the_server_drops_a_client_that_does_not_read_the_answer() -> None:
    caller = Caller(Reader(after=1.0))
    caller.send(request(5) + b"hello")
    caller.limits.pause_writing()  # a real transport calls this if the client reads nothing
    await past(5 * TIMEOUT)
    assert caller.hung_up == 2 * TIMEOUT


def test_a_websocket_that_is_closing_can_be_shut_down() -> None:
    socket = object.__new__(LimitedWebSocket)
    socket.conn = ServerProtocol(state=State.CLOSING)
    socket.transport, socket.queue = Mock(), Mock()
    socket.close_sent, socket.handshake_complete = False, True
    socket.stop_keepalive = lambda: None  # type: ignore[method-assign]
    socket.shutdown()
    socket.transport.close.assert_called_once()
