"""A bridge process: started with the first use, started again when it dies, and ended in order."""

from __future__ import annotations

import asyncio
import contextlib
import json
import socket
from collections.abc import Callable, Mapping
from typing import Any

from ravestate.errors import PlatformError
from ravestate.modules._children.child import Child

from .frames import Frames, Handle, Kind
from .places import Place

BACK_OFF = (0.1, 0.3, 1.0, 3.0)
"""Seconds until a new process replaces a dead one, by the number of processes that died without work."""

ENDING = 3.0
"""Seconds that a process has to end in order."""


class BridgeProcess:
    """The process of one bridge. Use it on one loop.

    Args:
        place: The program, and the interpreter that has its packages.
        config: The configuration of the program, as data for JSON.
        handle: Called with each frame of the process, except those that this class handles.
        ready: Called when a process is ready to work: the first one, and each that replaces another.
        lost: Called with a sentence when a process has died.
    """

    def __init__(
        self,
        place: Place,
        config: Mapping[str, Any],
        *,
        handle: Handle,
        ready: Callable[[], None],
        lost: Callable[[str], None],
    ) -> None:
        self.restarts = 0
        """The number of processes that replaced a dead one."""
        self.failed: PlatformError | None = None
        """The reason for which there is no process, and will be none; else None."""
        self._place = place
        self._config = config
        self._handle = handle
        self._ready = ready
        self._lost = lost
        self._process: Child | None = None
        self._frames: Frames | None = None
        self._again: asyncio.TimerHandle | None = None
        self._idle_deaths = 0
        self._works = False
        self._closing = False

    @property
    def pid(self) -> int | None:
        """The process's number, if it runs."""
        return self._process.pid if self._process is not None else None

    @property
    def frames(self) -> Frames | None:
        """The pipe to the process, once it is ready for work."""
        return self._frames if self._works else None

    def start(self) -> None:
        """Start the process; it is ready later."""
        self._again = None
        ours, theirs = socket.socketpair()
        try:
            self._process = Child(
                self._place.command(theirs.fileno()),
                pass_fds=(theirs.fileno(),),
                environment=self._place.environment,
            )
        except OSError as error:
            ours.close()
            self.failed = PlatformError(f"{self._place.name}: cannot start {self._place.python!r}: {error}")
            self._lost(str(self.failed))
            return
        finally:
            theirs.close()
        self._frames = Frames(ours, self._take, self._died)
        self._frames.send(Kind.OPEN, body=json.dumps(self._config).encode())

    async def close(self) -> None:
        """Let the process finish and end; kill it if it does not."""
        self._closing = True
        if self._again is not None:
            self._again.cancel()
        frames, process = self._frames, self._process
        if frames is not None and process is not None:
            if self._works:  # else it waits for a master, and has nothing to finish
                frames.send(Kind.CLOSE)
                with contextlib.suppress(TimeoutError):
                    async with asyncio.timeout(ENDING):
                        await frames.flush()
                        await asyncio.to_thread(process.wait, ENDING)
            frames.close()
        await asyncio.to_thread(self._bury)

    def kill(self) -> None:
        """Kill the process, and start no other."""
        if self._again is not None:
            self._again.cancel()
        if self._frames is not None:
            self._frames.close()
        self._bury()

    def _take(self, kind: Kind, channel: int, number: int, body: memoryview) -> None:
        if kind is Kind.READY:
            self._works = True
            self._ready()
        elif kind is Kind.FAULT and not self._works:
            self.failed = PlatformError(f"{self._place.name}: {json.loads(bytes(body))}{self._place.mend}")
        else:
            self._idle_deaths = 0
            self._handle(kind, channel, number, body)

    def _died(self) -> None:
        if self._closing:
            return
        how = self._bury()
        self._works = False
        if self.failed is None:
            wait = BACK_OFF[min(self._idle_deaths, len(BACK_OFF) - 1)]
            self._idle_deaths += 1
            self.restarts += 1
            self._again = asyncio.get_running_loop().call_later(wait, self.start)
        self._lost(
            str(self.failed) if self.failed else f"the process of {self._place.name} ended ({how}); it starts again"
        )

    def _bury(self) -> str:
        """Make sure that the process is gone; return how it ended."""
        process, self._process = self._process, None
        return process.end(patience=0.1) if process is not None else "closed"
