"""The web server, with one socket, one application, and limits on connections."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import functools
import gc
import socket
import sys
from collections.abc import Callable, Generator, Iterable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, cast
from urllib.parse import quote

import uvicorn

from ravestate.errors import PlatformError

from .access import is_local
from .application import make_app, settings_of
from .channel import LONGEST
from .limits import LimitedHTTP, LimitedWebSocket

if TYPE_CHECKING:
    from starlette.routing import BaseRoute

    from ravestate.runtime.agent import Agent


SPARE = 128  # the number of open files that the server leaves to the rest of the process
BACKLOG = 256  # how many connections the system accepts before the server takes them
UNREAD = 128 * 1024  # how many bytes the system buffers for a client that does not read
LAST_WORDS = 2.0  # when the server ends, connections may take this many seconds to close


SWITCH = 0.0005
"""A computing thread gives way to another one after this many seconds. An answer takes several turns of the event loop.
With Python's default, each turn would wait 5 ms while another thread analyses a sentence."""

COLLECT = (10_000, 10, 10)
"""The thresholds of the cyclic garbage collector. With the default of Python 3.11 (700, 10, 10), it would scan all
objects of several hundred conversations every few seconds. All answers would have to wait for it."""


_before: list[tuple[float, tuple[int, int, int]]] = []  # for each running server: the settings to restore


@contextlib.contextmanager
def low_latency() -> Generator[None]:
    """Tune the interpreter for quick answers inside the ``with`` block. The last block to end restores the settings."""
    _before.append(_before[0] if _before else (sys.getswitchinterval(), gc.get_threshold()))
    sys.setswitchinterval(SWITCH)
    gc.set_threshold(*COLLECT)
    try:
        yield
    finally:
        switch, collect = _before.pop()
        if not _before:
            sys.setswitchinterval(switch)
            gc.set_threshold(*collect)


class Server:
    """Serves the page of an agent: ``async with Server(agent) as server``. See also `webio.app`.

    Raises:
        PlatformError: Other machines can reach the address, and there is no token. Or the agent lacks `webio`, or has
            `conio`.
    """

    def __init__(self, agent: Agent, routes: Iterable[BaseRoute] = (), inside: str | None = None) -> None:
        self.app = make_app(agent, routes, inside)
        """The application that the server serves."""
        self._settings = settings_of(agent)
        if self._settings.token is None and not is_local(self._settings.host):
            raise PlatformError(
                f"webio: other machines can reach {self._settings.host!r}, so a token is needed: set "
                "RAVESTATE_WEBIO_TOKEN, for example to the output of "
                "python -c 'import secrets; print(secrets.token_urlsafe())'"
            )
        self._socket: socket.socket | None = None
        self.uvicorn: _Uvicorn | None = None
        """The uvicorn server with the connections; None before the start."""
        self._task: asyncio.Task[None] | None = None
        self._saved = contextlib.ExitStack()

    async def __aenter__(self) -> Server:
        """Start to listen. Raise a `PlatformError` if the address cannot be used."""
        settings = self._settings
        self._socket = _listen(settings.host, settings.port)
        limits = functools.partial(LimitedHTTP, per_address=settings.per_address, most=_most(2 * settings.sessions))
        self.uvicorn = _Uvicorn(
            uvicorn.Config(
                self.app,
                http=cast("Any", limits),
                ws=LimitedWebSocket,
                lifespan="on",
                ws_max_size=LONGEST,
                ws_per_message_deflate=False,  # frames are small, and each compressor would take memory
                backlog=BACKLOG,
                timeout_keep_alive=15,
                timeout_graceful_shutdown=int(LAST_WORDS),
                log_config=None,
                log_level="warning",
                access_log=False,
                server_header=False,
                date_header=False,
            )
        )
        self._task = asyncio.create_task(self.uvicorn.serve(sockets=[self._socket]))
        listening = asyncio.create_task(self.uvicorn.listening.wait())
        await asyncio.wait((self._task, listening), return_when=asyncio.FIRST_COMPLETED)
        listening.cancel()
        if self._task.done():
            self._task.result()
        self._saved.enter_context(low_latency())
        return self

    async def __aexit__(self, *_: object) -> None:
        """End the conversations cleanly, and stop the server."""
        assert self.uvicorn is not None and self._task is not None  # set by `__aenter__`
        with self._saved:
            await self.app.state.sessions.close()
            self.uvicorn.told.set()
            await self._task

    @property
    def port(self) -> int:
        """The port that the server listens on."""
        assert self._socket is not None  # set by `__aenter__`
        return int(self._socket.getsockname()[1])

    @property
    def address(self) -> str:
        """The address of the page; if the server listens on all addresses, the result contains this machine's name."""
        host = self._settings.host.strip("[]")
        if host in ("0.0.0.0", "::"):
            host = socket.gethostname()
        return f"http://{f'[{host}]' if ':' in host else host}:{self.port}/"

    def link(self, path: str = "") -> str:
        """Return the address of the page at `path`, with the token that its visitor needs."""
        token = self._settings.token
        secret = f"#token={quote(token.get_secret_value(), safe='')}" if token else ""
        return f"{self.address}{path}{secret}"

    def announce(self, pages: Mapping[str, str] = MappingProxyType({"agent": ""})) -> None:
        """Print the address of each page. `pages` maps names of pages to their paths.

        The token appears only on a terminal. Other outputs often end up in files that other people can read.
        """

        def lines(address: Callable[[str], str]) -> str:
            told = "\n".join(f"The {name} is at {address(path)}" for name, path in pages.items())
            return f"{told} (Ctrl-C ends it)\n"

        if self._settings.token is None or sys.stdout.isatty():
            sys.stdout.write(lines(self.link))
        else:
            sys.stdout.write(lines(lambda path: f"{self.address}{path}"))
            sys.stdout.write("To open it, add #token= and the token that you have set (webio.token).\n")
            if sys.stderr.isatty():
                sys.stderr.write(lines(self.link))
        sys.stdout.flush()

    async def until_failed(self) -> None:
        """Wait until the server ends by itself, which happens only after a failure; raise that failure."""
        assert self._task is not None  # set by `__aenter__`
        await asyncio.shield(self._task)


class _Uvicorn(uvicorn.Server):
    """A uvicorn server without a periodic tick and without signal handlers. The agent's runner has its own handlers."""

    def __init__(self, config: uvicorn.Config) -> None:
        super().__init__(config)
        self.listening = asyncio.Event()
        self.told = asyncio.Event()

    async def main_loop(self) -> None:
        """Run the server until `told` is set."""
        self.listening.set()
        await self.told.wait()

    @contextlib.contextmanager
    def capture_signals(self) -> Generator[None]:
        """Leave the signal handlers as they are."""
        yield


def _listen(host: str, port: int) -> socket.socket:
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            host.strip("[]"), port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
    except (OSError, UnicodeError) as error:  # a name such as "127.0.0..1" cannot even be encoded
        why = error.strerror if isinstance(error, OSError) else "it is not a name"
        raise PlatformError(f"webio: host {host!r} is not an address of this machine: {why}") from None
    listener = socket.socket(family, kind, protocol)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, UNREAD)  # accepted sockets inherit it
        if sys.platform != "win32":  # on Windows, this option would let others share the port
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(address)
    except OSError as error:
        listener.close()
        if error.errno == errno.EADDRINUSE:
            raise PlatformError(
                f"webio: port {port} is in use: choose another one, or take any free port with --set webio.port=0"
            ) from None
        raise PlatformError(f"webio: cannot listen on {host}, port {port}: {error.strerror}") from None
    return listener


def _most(wanted: int) -> int:
    """Return how many connections to allow: `wanted`, or fewer if the system limits the number of open files."""
    try:
        import resource
    except ImportError:  # Windows has no such limit
        return wanted
    soft, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    return wanted if soft == resource.RLIM_INFINITY else max(16, min(wanted, soft - SPARE))
