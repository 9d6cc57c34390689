"""Hostile and broken clients cost the server little, and other visitors do not notice them."""

import asyncio
import contextlib
import itertools
import json
import resource
import select
import socket
from collections.abc import AsyncGenerator, Iterator

import pytest
from websockets.asyncio.client import ClientConnection
from websockets.exceptions import ConnectionClosed, ConnectionClosedError, InvalidMessage, InvalidStatus

from modules.platform.webio.served import Served, hello, talk
from runtime.on_loop import on_loop

MEGABYTE = 1 << 20
ELSEWHERE = ("127.0.0.2", 0)  # another address of this machine


@pytest.fixture(autouse=True)
def _many_files() -> Iterator[None]:
    """Allow this process more open files than usual, because each hostile client needs one."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (max(soft, min(hard, 4096)), hard))
    yield
    resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


@contextlib.asynccontextmanager
async def unharmed(served: Served, megabytes: int) -> AsyncGenerator[None]:
    """Let a visitor talk during the ``with`` block, however fast the block ends. Every utterance must get its answer.

    The server's memory must grow by less than `megabytes`.
    """
    async with served.connect(local_addr=ELSEWHERE) as visit:
        await hello(visit)
        await talk(visit, ["before"])
        before = served.peak()
        over = asyncio.Event()

        async def keep_talking() -> None:
            for number in itertools.count():
                await talk(visit, [f"meanwhile {number}"])
                if over.is_set() and number:
                    return

        talking = asyncio.create_task(keep_talking())
        yield
        over.set()
        await talking
        await talk(visit, ["after"])
        grown = served.peak() - before
        assert grown < megabytes * MEGABYTE, f"{grown / MEGABYTE:.1f} MB"


@on_loop
async def test_messages_of_ten_megabytes_are_refused() -> None:
    with Served() as served:
        async with unharmed(served, megabytes=8):
            for _ in range(10):
                async with served.connect(max_size=None) as visit:
                    await hello(visit)
                    with contextlib.suppress(ConnectionClosed):
                        await visit.send("x" * (10 * MEGABYTE))
                    with pytest.raises(ConnectionClosedError) as closed:
                        while True:
                            await visit.recv()
                    assert closed.value.rcvd is None or closed.value.rcvd.code == 1009


@on_loop
async def test_a_message_of_ten_megabytes_in_small_pieces_is_refused() -> None:
    def pieces() -> Iterator[str]:
        for _ in range(10_000):
            yield "x" * 1024

    with Served() as served:
        async with unharmed(served, megabytes=8), served.connect() as visit:
            await hello(visit)
            with pytest.raises(ConnectionClosedError) as closed:
                await visit.send(pieces())
                while True:
                    await visit.recv()
            assert closed.value.rcvd is None or closed.value.rcvd.code == 1009


@on_loop
async def test_the_number_of_connections_that_send_no_request_is_limited() -> None:
    with Served(patience=600.0, per_address=100) as served, contextlib.ExitStack() as attack:
        async with unharmed(served, megabytes=16):
            open_before = served.files()
            address = ("127.0.0.1", served.port)
            silent = [attack.enter_context(socket.create_connection(address)) for _ in range(1000)]
            refused = 0
            for one in silent[100:]:
                refused += b"too many connections from your address" in await asyncio.to_thread(everything, one)
            assert refused > 850
            assert served.files() - open_before <= 100


@on_loop
async def test_the_number_of_websockets_that_send_no_hello_is_limited() -> None:
    with Served(patience=2.0, per_address=100) as served:
        async with unharmed(served, megabytes=24):
            open_before = served.files()
            sockets: list[ClientConnection] = []
            for _ in range(1000):
                with contextlib.suppress(InvalidStatus, InvalidMessage, OSError):
                    sockets.append(await served.connect())
                assert served.files() - open_before <= 101  # one more is perhaps still closing
            assert len(sockets) >= 50
            for one in sockets:
                assert json.loads(await one.recv())["code"] == "silent"
                with pytest.raises(ConnectionClosed):
                    await one.recv()
                assert one.close_code == 4408


@on_loop
async def test_the_server_drops_a_client_whose_request_never_ends() -> None:
    with Served(patience=0.5) as served:
        reader, writer = await asyncio.open_connection("127.0.0.1", served.port)
        writer.write(b"GET / HTTP/1.1\r\nhost: 127.0.0.1\r\n")  # the end of the request is missing
        with contextlib.suppress(ConnectionResetError):
            assert await reader.read() == b""
        writer.close()


@on_loop
async def test_the_server_drops_a_client_whose_second_request_never_ends() -> None:
    with Served(patience=0.5) as served:
        reader, writer = await asyncio.open_connection("127.0.0.1", served.port)
        writer.write(b"GET /nothing HTTP/1.1\r\nhost: 127.0.0.1\r\n\r\nGET / HTTP/1.1\r\n")
        with contextlib.suppress(ConnectionResetError):
            assert b"404 Not Found" in await reader.read()
        writer.close()


@on_loop
async def test_a_client_that_stops_reading_is_dropped_and_costs_little() -> None:
    text = "x" * 9_000
    with Served(patience=0.5) as served:
        async with unharmed(served, megabytes=16):
            open_before = served.files()
            with upgraded(served) as deaf:
                deaf.sendall(masked('{"type": "hello", "v": 1}'))
                deaf.setblocking(False)
                # The agent repeats each text, so megabytes of answers wait for this client.
                with contextlib.suppress(BlockingIOError, ConnectionError):
                    for number in range(400):
                        deaf.sendall(masked(json.dumps({"type": "say", "id": f"{number}", "text": text})))
                hang_up = select.poll()
                hang_up.register(deaf, 0)  # wait for the end of the connection without reading
                assert await asyncio.to_thread(hang_up.poll, 15_000)
            assert served.files() <= open_before


def everything(one: socket.socket) -> bytes:
    """Return all data that a socket receives until the other end closes."""
    one.settimeout(60)
    received = b""
    with contextlib.suppress(ConnectionResetError):
        while more := one.recv(1000):
            received += more
    return received


def until_closed(one: socket.socket) -> bytes:
    """Return all data that a WebSocket receives until it is closed, cleanly or not."""
    received = b""
    with contextlib.suppress(ConnectionResetError):
        while b"\x88" not in received and (more := one.recv(1000)):
            received += more
    return received


@contextlib.contextmanager
def upgraded(served: Served) -> Iterator[socket.socket]:
    """Open a WebSocket on a plain socket with a small buffer for unread data."""
    with socket.socket() as one:
        one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        one.settimeout(60)
        one.connect(("127.0.0.1", served.port))
        one.sendall(
            b"GET /ws HTTP/1.1\r\nhost: 127.0.0.1\r\nconnection: upgrade\r\nupgrade: websocket\r\n"
            b"sec-websocket-version: 13\r\nsec-websocket-key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
        )
        assert b"101 Switching Protocols" in one.recv(1000)
        yield one


def masked(text: str) -> bytes:
    """Return a text frame, masked as clients must mask it."""
    data = text.encode()
    size = bytes([0x80 | len(data)]) if len(data) < 126 else b"\xfe" + len(data).to_bytes(2, "big")
    return b"\x81" + size + b"\0\0\0\0" + data


@on_loop
async def test_the_server_drops_a_client_that_does_not_close_its_end_of_the_websocket() -> None:
    with Served(patience=0.5) as served:
        open_before = served.files()
        with upgraded(served) as stubborn:
            stubborn.sendall(masked("no hello"))
            hang_up = select.poll()
            hang_up.register(stubborn, 0)
            assert await asyncio.to_thread(hang_up.poll, 15_000)
            assert served.files() <= open_before


@on_loop
async def test_the_server_survives_requests_of_arbitrary_bytes() -> None:
    with Served() as served:
        async with unharmed(served, megabytes=8):
            for junk in (b"\0" * 1000, b"GET / HTTP/9.9\r\n\r\n", b"A" * 100_000, b"\x81\xff" * 50):
                reader, writer = await asyncio.open_connection("127.0.0.1", served.port)
                writer.write(junk)
                with contextlib.suppress(ConnectionError):
                    await writer.drain()
                    writer.write_eof()
                    await reader.read()
                writer.close()
        assert served.end() == 0
        assert served.errors == ""


@on_loop
async def test_the_server_survives_invalid_frames_and_does_not_log_them() -> None:
    no_text = b"\x81\x82\0\0\0\0\xff\xfe"
    unmasked = b"\x81\x02{}"
    reserved = b"\xf1\x80\0\0\0\0"
    unknown = b"\x83\x80\0\0\0\0"
    endless = b"\x81\xff" + (2**63 - 1).to_bytes(8, "big") + b"\0\0\0\0"
    with Served() as served:
        async with unharmed(served, megabytes=8):
            for frame in (no_text, unmasked, reserved, unknown, endless):
                with upgraded(served) as visit:
                    visit.sendall(masked('{"type": "hello", "v": 1}') + frame)
                    assert b"\x88" in await asyncio.to_thread(until_closed, visit)
        assert served.end() == 0
        assert served.errors == ""
