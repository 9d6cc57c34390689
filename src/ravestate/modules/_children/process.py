"""Models in separate processes, which all contexts of the main process share.

If a model hangs or crashes, only its own process ends, and the next request starts a new one. In a thread, a model
would also hold Python's global lock while it loads, and stop every event loop.
"""

from __future__ import annotations

import atexit
import contextlib
import itertools
import json
import os
import selectors
import sys
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import Any

from ravestate.errors import PlatformError

from .child import ENDING, Child

LOADING = 120.0
"""A model may take this many seconds to load."""

LINGER = 60.0
"""If the last user of a process releases it with ``drop(..., linger=True)``, the process stays loaded for this many
seconds."""

SERVER = Path(__file__).with_name("serve.py")


def _no_mend(_: str) -> str:
    return ""


@dataclass(frozen=True, slots=True)
class Backend:
    """A program that runs in a process, and the names that error messages use for it.

    Attributes:
        program: A file, or a folder with ``__init__.py``. Its function ``load`` gets the configuration, and returns the
            function that handles a request. The program imports nothing from Ravestate.
        owner: The module that uses the program.
        name: The backend's name in messages.
        mend: A function that gets the reason of a failed load, and returns advice for the end of the error message.
    """

    program: Path
    owner: str
    name: str
    mend: Callable[[str], str] = _no_mend


class ModelProcess:
    """The process of one model, which answers one request after another. All methods block and are thread-safe."""

    def __init__(self, backend: Backend, config: Mapping[str, Any], python: str = sys.executable) -> None:
        """Make the object. The process starts at the first request, or at a call of `start`.

        Args:
            backend: The program.
            config: Its configuration, as data for JSON.
            python: The Python interpreter that has the backend's packages.
        """
        self._backend = backend
        self._title = f"{backend.owner}: {backend.name}"
        self.restarts = 0
        """How many times a new process has replaced a dead or hanging one."""
        self._config = dict(config)
        self._python = python
        self._turn = threading.Lock()
        self._process: Child | None = None
        self._rest = b""
        self._closed = False

    @property
    def pid(self) -> int | None:
        """The process id; None if the process does not run."""
        return self._process.pid if self._process is not None else None

    @property
    def busy(self) -> bool:
        """Whether the process is working on a request, or loading."""
        return self._turn.locked()

    def start(self) -> None:
        """Load the model, unless it is loaded.

        Raises:
            PlatformError: The model cannot be loaded. The message has the backend's reason.
        """
        with self._turn:
            self._start()

    def request(
        self,
        header: Mapping[str, Any],
        data: bytes = b"",
        *,
        seconds: float,
        unwanted: threading.Event | None = None,
    ) -> tuple[dict[str, Any], bytes]:
        """Send a request, and return the answer: its header and its bytes. The first request loads the model.

        Args:
            header: The request, as data for JSON.
            data: Bytes that belong to the request, such as a picture or a sound.
            seconds: The maximum time for the answer. The time for loading the model does not count.
            unwanted: An event that another thread sets if the answer is no longer needed. A request that still waits
                for earlier requests is then dropped.

        Raises:
            PlatformError: The model cannot be loaded, refuses the request, has crashed, or does not answer within
                `seconds`. Or the request was dropped. After a crash or time-out, the next request starts a new process.
        """
        with self._turn:
            if unwanted is not None and unwanted.is_set():
                raise PlatformError(
                    f"{self._backend.owner}: a request to {self._backend.name} was dropped: a newer one replaces it"
                )
            self._start()
            answer, sound = self._exchange(header, data, seconds)
        if "error" in answer:
            raise PlatformError(f"{self._title} failed: {answer['error']}")
        return answer, sound

    def close(self) -> None:
        """Kill the process, which has nothing to save. Later requests fail."""
        self._closed = True
        if (process := self._process) is not None:
            process.kill()  # an open request then fails, because its pipe ends
        with self._turn:
            self._end()

    # ------------------------------------------------------------------------------- internals

    def _start(self) -> None:
        if self._closed:
            raise PlatformError(f"{self._title} is closed")
        if self.pid is not None:
            return
        if self._process is not None:
            self.restarts += 1
            self._end()
        try:
            # -P: a file beside `SERVER` must not replace a package of the same name.
            self._process = Child([self._python, "-P", str(SERVER), str(self._backend.program)], piped=True)
        except OSError as error:
            raise PlatformError(
                f"{self._backend.owner}: cannot start {self._python!r} for {self._backend.name}: {error}"
            ) from error
        if self._closed:  # `close` came while the process started, and found no process to kill
            self._process.kill()
        self._rest = b""
        answer, _ = self._exchange(self._config, b"", LOADING)
        if "error" in answer:
            self._end()
            raise PlatformError(
                f"{self._backend.owner}: cannot load {self._backend.name}: {answer['error']}{self._backend.mend(answer['error'])}"
            )

    def _exchange(self, header: Mapping[str, Any], data: bytes, seconds: float) -> tuple[dict[str, Any], bytes]:
        end = monotonic() + seconds
        try:
            self._send(json.dumps({**header, "size": len(data)}).encode() + b"\n" + data, end)
            while b"\n" not in self._rest:
                self._receive(end)
            line, _, self._rest = self._rest.partition(b"\n")
            answer: dict[str, Any] = json.loads(line)
            size = answer.pop("size")
            while len(self._rest) < size:
                self._receive(end)
            sound, self._rest = self._rest[:size], self._rest[size:]
            return answer, sound
        except TimeoutError:
            self._end()
            raise PlatformError(f"{self._title} did not answer within {seconds:g} s, and is restarted") from None
        except (EOFError, OSError):
            how = self._end(patience=ENDING)
            raise PlatformError(f"{self._backend.owner}: the process of {self._backend.name} ended ({how})") from None

    def _send(self, data: bytes, end: float) -> None:
        assert self._process is not None
        pipe = self._process.stdin
        rest = memoryview(data)
        while rest:
            _wait(pipe, selectors.EVENT_WRITE, end)
            with contextlib.suppress(BlockingIOError):
                rest = rest[os.write(pipe, rest) :]

    def _receive(self, end: float) -> None:
        assert self._process is not None
        pipe = self._process.stdout
        _wait(pipe, selectors.EVENT_READ, end)
        block = os.read(pipe, 1 << 20)
        if not block:
            raise EOFError
        self._rest += block

    def _end(self, patience: float = 0.0) -> str:
        process, self._process = self._process, None
        return process.end(patience) if process is not None else "closed"


def _wait(pipe: int, event: int, end: float) -> None:
    with selectors.DefaultSelector() as selector:
        selector.register(pipe, event)
        if not selector.select(max(0.0, end - monotonic())):
            raise TimeoutError


# ------------------------------------------------------------------------------------- sharing

_processes: dict[str, ModelProcess] = {}
_users: dict[str, int] = {}
_timers: dict[str, threading.Timer] = {}
_sharing = threading.Lock()
_unshared = itertools.count()


def take(
    backend: Backend, config: Mapping[str, Any], python: str = sys.executable, *, shared: bool = True
) -> ModelProcess:
    """Return the process for a backend and a configuration. Pair each call with a call of `drop`.

    The process might not have started yet.

    Args:
        backend, config, python: As for `ModelProcess`.
        shared: Whether all callers with the same configuration share a process. If not, this caller gets a new one.
    """
    with _sharing:
        key = json.dumps(
            [str(backend.program), dict(config), python, None if shared else next(_unshared)], sort_keys=True
        )
        if (timer := _timers.pop(key, None)) is not None:
            timer.cancel()
        process = _processes.get(key)
        if process is None:
            process = _processes[key] = ModelProcess(backend, config, python)
        _users[key] = _users.get(key, 0) + 1
        return process


def is_shared(process: ModelProcess) -> bool:
    """Return whether several callers of `take` share a process now."""
    with _sharing:
        return any(known is process and _users[key] > 1 for key, known in _processes.items())


def drop(process: ModelProcess, *, linger: bool = False) -> None:
    """Release a process that `take` has returned. The process ends after its last release.

    Args:
        process: The process.
        linger: Whether the process ends only `LINGER` seconds later, because a caller is likely to take it again.
    """
    with _sharing:
        key = next((key for key, known in _processes.items() if known is process), None)
        if key is None:
            return
        _users[key] -= 1
        if _users[key]:
            return
        if linger:
            timer = _timers[key] = threading.Timer(LINGER, _end_unused, [key])
            timer.daemon = True
            timer.start()
            return
        del _processes[key], _users[key]
    process.close()


def _end_unused(key: str) -> None:
    """End a process that no caller has taken again for `LINGER` seconds."""
    with _sharing:
        if _timers.get(key) is not threading.current_thread():
            return  # a caller has taken the process again at the last moment
        del _timers[key], _users[key]
        process = _processes.pop(key)
    process.close()


@atexit.register
def _close_all() -> None:
    for timer in list(_timers.values()):
        timer.cancel()
    for process in list(_processes.values()):
        process.close()
