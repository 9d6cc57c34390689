"""What a connection may cost before the application hears of it, and after its client has stopped reading.

Both build on uvicorn's own protocols, which bound neither.
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

__all__ = ["LimitedHTTP", "LimitedWebSocket"]

TIMEOUT = 10.0
"""Seconds in which a client is to send its request, and then to read the answer."""

LOWEST_RATE = 8 * 1024
"""Bytes a second that a client is to send at least while more of its request is to come; it may be `TIMEOUT` late."""

STALL_TIMEOUT = 20.0
"""Seconds for which a client may leave unread what the server has for it."""

FULL = b"HTTP/1.1 503 Service Unavailable\r\nconnection: close\r\ncontent-type: text/plain\r\ncontent-length: %d\r\n\r\n%s"

FOREIGN = (
    "Invalid HTTP request received.",
    "Invalid UTF-8 sequence received from client.",
    "Unsupported upgrade request.",
)
"""What clients do wrong, in uvicorn's words. They are told; in the log anybody could write as much of it as they like."""

log = logging.getLogger("ravestate.webio.limits")
log.setLevel(logging.WARNING)
log.addFilter(lambda record: record.msg not in FOREIGN)


class LimitedHTTP(H11Protocol):
    """HTTP: bounds the number of connections, in all and from one address, and does not wait for the silent.

    Args:
        per_address: Connections from one address, WebSockets among them.
        most: Connections in all.
    """

    def __init__(self, *args: Any, per_address: int, most: int, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.logger = log
        self._per_address = per_address
        self._most = most
        self._received = 0  # bytes, since the last look
        self._waited: object = None  # the request for whose client was waited at the last look; at first, any
        self._late: tuple[object, float] = (None, 0.0)  # a request, and by how many bytes it is behind

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]  # as above it
        """Take a connection, or refuse it."""
        super().connection_made(transport)
        if len(self.connections) > self._most:
            self._refuse("too many connections")
        elif self._from_here() > self._per_address:
            self._refuse("too many connections from your address")
        else:
            self.loop.call_later(TIMEOUT, self._look)

    def data_received(self, data: bytes) -> None:
        """Take what the client has sent."""
        self._received += len(data)
        super().data_received(data)

    def _from_here(self) -> int:
        here = self.client[0] if self.client else None
        addresses = (cast("Any", other).client for other in self.connections)
        return sum(1 for address in addresses if address and address[0] == here)

    def _refuse(self, why: str) -> None:
        self.connections.discard(self)  # it counts no more, though it takes a moment to close
        self.transport.write(FULL % (len(why), why.encode()))
        self.transport.close()

    def _look(self) -> None:
        """Close if nothing has been asked since the last look, or the rest of it does not come, or its answer is still not
        read."""
        if self.transport.is_closing() or self.transport.get_protocol() is not self:
            return
        request = cast("RequestResponseCycle | None", self.cycle)
        if request is None or request.response_complete or self.flow.write_paused:
            spent = request is self._waited
            self._waited = request
        else:
            spent = self._is_late(request)
            self._waited = self  # for none
        if spent:
            _hang_up(self.transport)
            return
        self._received = 0
        self.loop.call_later(TIMEOUT, self._look)

    def _is_late(self, request: RequestResponseCycle) -> bool:
        """Whether a request comes in more slowly than it should, all in all, and not because the server does not read."""
        due = LOWEST_RATE * TIMEOUT
        behind = self._late[1] if self._late[0] is request else 0.0
        waits = self.flow.read_paused or not request.more_body
        behind = 0.0 if waits else max(0.0, behind + due - self._received)
        self._late = (request, behind)
        return behind > due


class LimitedWebSocket(WebSocketsSansIOProtocol):
    """WebSockets: drops who does not read, instead of keeping what is meant for them."""

    _stalled: asyncio.TimerHandle | None = None

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.logger = log

    async def send(self, message: Any) -> None:
        """Send what the application has for the client; one that was closed for what it has sent is gone."""
        if self.close_sent:
            raise ClientDisconnected
        await super().send(message)
        if self.close_sent:
            self.handshake_complete = True  # also where it was refused, which uvicorn takes for an oversight

    async def run_asgi(self) -> None:
        """Run the application; who has not closed its end some time after that is hung up on."""
        await super().run_asgi()
        self.loop.call_later(TIMEOUT, self._see_off)

    def shutdown(self) -> None:
        """Close the connection when the server stops. uvicorn fails if the client is closing it at the same moment."""
        with contextlib.suppress(InvalidState):
            super().shutdown()
        self.transport.close()

    def _see_off(self) -> None:
        if not self.disconnected:
            _hang_up(self.transport)

    def pause_writing(self) -> None:
        """The client leaves much unread: it has some time to make up."""
        super().pause_writing()
        self._stalled = self.loop.call_later(STALL_TIMEOUT, _hang_up, self.transport)

    def resume_writing(self) -> None:
        """The client reads again."""
        super().resume_writing()
        self._forgive()

    def connection_lost(self, exc: Exception | None) -> None:
        """It is gone."""
        self._forgive()
        super().connection_lost(exc)

    def handle_ping(self) -> None:
        """Answer, unless the client asks on and on and does not read the answers."""
        if self.writable.is_set():
            super().handle_ping()
        else:
            _hang_up(self.transport)

    def keepalive_timeout(self) -> None:
        """It answers no more: what is still meant for it will not be read."""
        super().keepalive_timeout()
        _hang_up(self.transport)

    def _forgive(self) -> None:
        if self._stalled is not None:
            self._stalled.cancel()
            self._stalled = None


def _hang_up(transport: asyncio.Transport) -> None:
    """Close at once, and let the system forget what was not read, instead of trying to deliver it."""
    connected = transport.get_extra_info("socket")
    if connected is not None:
        with contextlib.suppress(OSError):
            connected.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    transport.abort()
