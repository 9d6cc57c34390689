"""A contestant in a process of its own, which answers requests in JSON lines (see ``peers/wire.py``)."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from typing import Any

__all__ = ["Child", "ChildError"]

PEERS = Path(__file__).resolve().parent / "peers"
ROOT = PEERS.parent.parent


class ChildError(Exception):
    """A contestant failed, or did not answer in time."""


class Child:
    """A process that answers requests.

    Args:
        command: The interpreter and its arguments.
    """

    def __init__(self, *command: str) -> None:
        self._errors = tempfile.TemporaryFile(mode="w+", encoding="utf-8", errors="replace")  # noqa: SIM115  # until close()
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            text=True,
            cwd=ROOT,
            env={**os.environ, "PYTHONDONTWRITEBYTECODE": ""},  # keep bytecode, as users do
        )

    @classmethod
    def ours(cls, module: str) -> Child:
        """Start a module of this package with the project's interpreter."""
        return cls(sys.executable, "-m", module)

    @classmethod
    def peer(cls, interpreter: Path | str, script: str) -> Child:
        """Start a script of a peer with the peer's interpreter."""
        return cls(str(interpreter), "-E", str(PEERS / script))  # -E ignores PYTHONPATH, which may name this checkout

    def ask(self, call: str, timeout: float = 600.0, /, **arguments: Any) -> Any:
        """Call a function of the contestant with these arguments, and return its result.

        Raises:
            ChildError: The function raised, the process ended, or the call took longer than `timeout` (seconds).
        """
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        watchdog = threading.Timer(timeout, self._process.kill)
        watchdog.start()
        try:
            print(json.dumps({"call": call, "with": arguments}), file=self._process.stdin, flush=True)
            line = self._process.stdout.readline()
        except BrokenPipeError:
            line = ""
        finally:
            watchdog.cancel()
        if not line:
            self._process.wait()
            self._errors.seek(0)
            raise ChildError(f"{call}: the process ended:\n{self._errors.read()[-2000:]}")
        reply = json.loads(line)
        if "error" in reply:
            raise ChildError(reply["error"])
        return reply["result"]

    def close(self) -> None:
        """End the process."""
        assert self._process.stdin is not None
        try:
            self._process.stdin.close()
            self._process.wait(timeout=20)
        except (subprocess.TimeoutExpired, BrokenPipeError):
            self._process.kill()
            self._process.wait()
        if self._process.stdout is not None:
            self._process.stdout.close()
        self._errors.close()
