"""Limits on clients that open too many connections, send too slowly, or do not read.

The classes extend uvicorn's protocols, which have no such limits.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import socket
import struct
from typing import Any, cast

from uvicorn.protocols.http.h11_impl import H11Protocol, RequestResponseCycle
from uvicorn.protocols.utils import ClientDisconnected
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.exceptions import InvalidState

TIMEOUT = 10.0  # a client may take this many seconds to send its request, and as many to read the answer

LOWEST_RATE = 8 * 1024
"""The lowest rate at which a client may send a request (bytes per second). A client is too slow if it
lags behind this rate by more than the bytes of `TIMEOUT` seconds."""

STALL_TIMEOUT = 20.0  # the client of a WebSocket may leave data unread for this many seconds

FULL = (
    b"HTTP/1.1 503 Service Unavailable\r\nconnection: close\r\ncontent-type: text/plain\r\ncontent-length: %d\r\n\r\n%s"
)

FOREIGN = (
    "Invalid HTTP request received.",
    "Invalid UTF-8 sequence received from client.",
    "Unsupported upgrade request.",
)
"""Uvicorn's messages about faults of clients. The log leaves them out, so that strangers cannot fill the disk."""

log = logging.getLogger("ravestate.webio.limits")
log.setLevel(logging.WARNING)
log.addFilter(lambda record: record.msg not in FOREIGN)


class LimitedHTTP(H11Protocol):
    """HTTP with time limits, and at most `most` connections, of which at most `per_address` come from one address.

    WebSockets count as connections, too.
    """

    def __init__(self, *args: Any, per_address: int, most: int, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.logger = log
        self._per_address = per_address
        self._most = most
        self._received = 0  # how many bytes came since the last check
        self._waited: object = None  # the request (or None) at the last check; `self` if it was in progress
        self._late: tuple[object, float] = (None, 0.0)  # a request, and by how many bytes it is behind the lowest rate

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]  # as in the base class
        """Accept a new connection, or refuse it if there are too many."""
        super().connection_made(transport)
        if len(self.connections) > self._most:
            self._refuse("too many connections")
        elif self._from_same_address() > self._per_address:
            self._refuse("too many connections from your address")
        else:
            self.loop.call_later(TIMEOUT, self._check)

    def data_received(self, data: bytes) -> None:
        self._received += len(data)
        super().data_received(data)

    def _from_same_address(self) -> int:
        own = self.client[0] if self.client else None
        clients = (cast("Any", connection).client for connection in self.connections)
        return sum(1 for client in clients if client and client[0] == own)

    def _refuse(self, why: str) -> None:
        self.connections.discard(self)  # do not count this connection any more: closing it takes a moment
        self.transport.write(FULL % (len(why), why.encode()))
        self.transport.close()

    def _check(self) -> None:
        """Hang up if the client has sent no request since the last check, sends too slowly, or does not read."""
        if self.transport.is_closing() or self.transport.get_protocol() is not self:
            return
        request = cast("RequestResponseCycle | None", self.cycle)
        if request is None or request.response_complete or self.flow.write_paused:
            spent = request is self._waited
            self._waited = request
        else:
            spent = self._is_late(request)
            self._waited = self  # a value that is not equal to any request
        if spent:
            _hang_up(self.transport)
            return
        self._received = 0
        self.loop.call_later(TIMEOUT, self._check)

    def _is_late(self, request: RequestResponseCycle) -> bool:
        """Return whether the client sends a request too slowly on average. Waits for the server do not count."""
        due = LOWEST_RATE * TIMEOUT
        behind = self._late[1] if self._late[0] is request else 0.0
        waits = self.flow.read_paused or not request.more_body
        behind = 0.0 if waits else max(0.0, behind + due - self._received)
        self._late = (request, behind)
        return behind > due


class LimitedWebSocket(WebSocketsSansIOProtocol):
    """A WebSocket that hangs up on a client that does not read, instead of storing more and more data for it."""

    _stalled: asyncio.TimerHandle | None = None

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.logger = log

    async def send(self, message: Any) -> None:
        """Send a message; raise `ClientDisconnected` if the server has closed the connection because of a fault."""
        if self.close_sent:
            raise ClientDisconnected
        await super().send(message)
        if self.close_sent:
            self.handshake_complete = True  # else uvicorn would log the missing answer as an error

    async def run_asgi(self) -> None:
        """Run the application. `TIMEOUT` seconds after its end, hang up if the client has not closed the connection."""
        await super().run_asgi()
        self.loop.call_later(TIMEOUT, self._end_late)

    def shutdown(self) -> None:
        """Close the connection when the server stops. uvicorn itself fails if the client closes it at that moment."""
        with contextlib.suppress(InvalidState):
            super().shutdown()
        self.transport.close()

    def _end_late(self) -> None:
        if not self.disconnected:
            _hang_up(self.transport)

    def pause_writing(self) -> None:
        """Start a time limit, because the client leaves much data unread."""
        super().pause_writing()
        self._stalled = self.loop.call_later(STALL_TIMEOUT, _hang_up, self.transport)

    def resume_writing(self) -> None:
        """Stop the time limit, because the client is reading again."""
        super().resume_writing()
        self._stop_timer()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop the time limit, because the connection has ended."""
        self._stop_timer()
        super().connection_lost(exc)

    def handle_ping(self) -> None:
        """Answer a ping; hang up on a client that does not read the answers."""
        if self.writable.is_set():
            super().handle_ping()
        else:
            _hang_up(self.transport)

    def keepalive_timeout(self) -> None:
        """Hang up on a client that no longer answers pings."""
        super().keepalive_timeout()
        _hang_up(self.transport)

    def _stop_timer(self) -> None:
        if self._stalled is not None:
            self._stalled.cancel()
            self._stalled = None


def _hang_up(transport: asyncio.Transport) -> None:
    """Close a connection immediately; the system drops the unread data instead of trying to deliver it."""
    connected = transport.get_extra_info("socket")
    if connected is not None:
        with contextlib.suppress(OSError):
            connected.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    transport.abort()
