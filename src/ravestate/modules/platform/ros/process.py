"""A bridge process, which runs a ROS library for the agent. It starts again if it dies, and ends cleanly."""

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
"""The waits before a new process replaces a dead one (seconds). Each further death leads to the next, longer wait. After
a process has done some work, the waits begin with the shortest again."""

ENDING = 3.0
"""A process may take this many seconds to end cleanly."""


class BridgeProcess:
    """The process of one bridge. Use an instance on one event loop only.

    Args:
        place: The program, and the interpreter that has its packages.
        config: The configuration of the program, as data for JSON.
        handle: A function to call with each frame from the process, except the frames that this class handles.
        ready: A function to call when the first process, or a replacement, is ready for work.
        lost: A function to call with a sentence when a process has died, or cannot start.
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
        """The number of processes that replaced a dead process."""
        self.failed: PlatformError | None = None
        """The reason why no process can run; None if a process can run."""
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
        """The process id, if the process runs."""
        return self._process.pid if self._process is not None else None

    @property
    def frames(self) -> Frames | None:
        """The pipe to the process; None if the process is not ready for work."""
        return self._frames if self._works else None

    def start(self) -> None:
        """Start the process. It becomes ready later."""
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
        """Let the process finish its work and end. If it does not end, kill it."""
        self._closing = True
        if self._again is not None:
            self._again.cancel()
        frames, process = self._frames, self._process
        if frames is not None and process is not None:
            if self._works:  # otherwise, the process waits for a ROS master, and has nothing to finish
                frames.send(Kind.CLOSE)
                with contextlib.suppress(TimeoutError):
                    async with asyncio.timeout(ENDING):
                        await frames.flush()
                        await asyncio.to_thread(process.wait, ENDING)
            frames.close()
        await asyncio.to_thread(self._bury)

    def kill(self) -> None:
        """Kill the process, and start no replacement."""
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
        """Make sure that the process is gone. Return how it ended, in words."""
        process, self._process = self._process, None
        return process.end(patience=0.1) if process is not None else "closed"
