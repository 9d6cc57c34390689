"""Our half of the wire: a contestant in a process of its own, asked by JSON lines (see ``peers/wire.py``)."""

from __future__ import annotations

import json
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
    """A contestant failed, or said nothing in time."""


class Child:
    """A process that answers requests.

    Args:
        command: What to run: an interpreter and its arguments.
    """

    def __init__(self, *command: str) -> None:
        self._errors = tempfile.TemporaryFile(mode="w+", encoding="utf-8", errors="replace")  # noqa: SIM115  # until close()
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._errors, text=True, cwd=ROOT
        )

    @classmethod
    def ours(cls, module: str) -> Child:
        """A module of this package, run by the project's own interpreter."""
        return cls(sys.executable, "-m", module)

    @classmethod
    def peer(cls, interpreter: Path | str, script: str) -> Child:
        """A script among the peers, run by an interpreter of theirs."""
        return cls(str(interpreter), str(PEERS / script))

    def ask(self, call: str, timeout: float = 600.0, /, **arguments: Any) -> Any:
        """Have a function of the contestant called.

        Raises:
            ChildError: It raised, ended, or took longer than `timeout` (seconds).
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
        """Let it end."""
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
