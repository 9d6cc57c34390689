"""An agent's page in a separate process, on a real port. Visitors come over the network."""

import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

from websockets.asyncio.client import ClientConnection, connect

HERE = Path(__file__)


class Served:
    """An agent that repeats each input, served by a separate process: ``with Served() as served``.

    Args:
        patience: The time for which the server waits for silent clients and for clients that do not read (seconds). Keep
            it short for quick tests.
        settings: The settings of ``webio``.
    """

    def __init__(self, patience: float | None = None, **settings: Any) -> None:
        self._patience = patience
        self._settings = {"port": 0, **settings}
        self.errors = ""
        """The error output of the process, after its end."""

    def __enter__(self) -> "Served":
        self.process = subprocess.Popen(
            [sys.executable, str(HERE), json.dumps([self._patience, self._settings])],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            env={**os.environ, "PYTHONPATH": os.pathsep.join((str(HERE.parents[3]), str(HERE.parents[4] / "src")))},
        )  # fmt: skip
        assert self.process.stdout is not None
        self.line = self.process.stdout.readline()
        found = re.search(r"http://([^/]*:(\d+))/", self.line)
        if found is None:
            raise AssertionError(f"no address: {self.line}{self.process.communicate()[1]}")
        self.host, self.port = found[1], int(found[2])
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.end()

    def end(self, how: signal.Signals = signal.SIGINT) -> int:
        """End the process with a signal, and return its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(how)
            try:
                self.errors = self.process.communicate(timeout=20)[1]
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.errors = self.process.communicate()[1]
                raise
        return self.process.returncode

    def connect(self, **options: Any) -> connect:
        """Open a WebSocket to the server."""
        return connect(f"ws://{self.host}/ws", ping_interval=None, compression=None, **options)

    def peak(self) -> int:
        """Return the peak memory of the process so far (bytes). Linux only."""
        status = Path(f"/proc/{self.process.pid}/status").read_text(encoding="ascii")
        found = re.search(r"VmHWM:\s+(\d+) kB", status)
        assert found is not None
        return int(found[1]) * 1024

    def files(self) -> int:
        """Return the number of open files and sockets of the process. Linux only."""
        return len(os.listdir(f"/proc/{self.process.pid}/fd"))


async def hello(socket: ClientConnection, **fields: Any) -> dict[str, Any]:
    """Say hello, and return the welcome."""
    await socket.send(json.dumps({"type": "hello", "v": 1, **fields}))
    return json.loads(await socket.recv())


async def talk(socket: ClientConnection, said: Sequence[str]) -> None:
    """Say these texts, and check that the agent repeats each of them."""
    for text in said:
        await socket.send(json.dumps({"type": "say", "id": text.replace(" ", "-"), "text": text}))
        answered = ""
        while answered != text:
            frame = json.loads(await socket.recv())
            assert frame["type"] in ("message", "typing", "pong"), frame
            if frame["type"] == "message" and frame["from"] == "agent":
                answered = frame["text"]
                assert answered in (text, "Hello!")


if __name__ == "__main__":
    import ravestate as rs
    from modules.platform.webio.visit import parrot
    from ravestate.modules import webio
    from ravestate.modules.platform.webio import channel, limits

    patience, settings = json.loads(sys.argv[1])
    if patience is not None:
        channel.SILENT = limits.TIMEOUT = limits.STALL_TIMEOUT = patience
    rs.run(parrot, webio, settings={"webio": settings})
