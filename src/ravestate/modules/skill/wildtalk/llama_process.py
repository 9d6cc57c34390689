"""A language model in a separate process, which all contexts of this process share.

In a thread, loading would stop every event loop for seconds, because it holds Python's global lock all the time.
A separate process also lets the agent survive a model file that crashes llama.cpp.
"""

from __future__ import annotations

import atexit
import contextlib
import json
import os
import secrets
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import IO

from ravestate.errors import PlatformError


@dataclass(frozen=True, slots=True)
class ModelKey:
    """A model's file, and the options to run it. Contexts with the same key share a process."""

    path: Path
    context_tokens: int
    parallel: int
    threads: int


class LlamaProcess:
    """The process of one model. All methods block and are thread-safe."""

    def __init__(self, key: ModelKey) -> None:
        """Take the key. The process is not started yet."""
        self.key = key
        self.users = 0
        self.secret = secrets.token_urlsafe(24)  # keeps out other users of this machine, who can reach the port
        self._address = ""
        self._starting = threading.Lock()
        self._process: subprocess.Popen[str] | None = None
        self._errors: IO[bytes] | None = None
        self._closed = False

    def start(self, progress: Callable[[float], None] | None = None) -> str:
        """Load the model, unless it is loaded; return the address of its server.

        If the process has died, start a new one.

        Raises:
            PlatformError: The model cannot be loaded; the message has llama.cpp's reason.
        """
        with self._starting:  # a second caller waits until the first has finished
            if not self.alive:
                self._end()
                self._warm(progress or (lambda _: None))
                self._address = self._wait(self._spawn())
            if progress is not None:
                progress(1.0)
            return self._address

    @property
    def alive(self) -> bool:
        """Whether the process runs."""
        return self._process is not None and self._process.poll() is None

    @property
    def pid(self) -> int | None:
        """The id of the process; None if it does not run."""
        return self._process.pid if self._process is not None and self.alive else None

    def obituary(self, grace: float = 0.0) -> str:
        """Return the cause of the process's end, with its last message; an empty string while it runs.

        The call waits up to `grace` seconds for a process that is about to end.
        """
        if (process := self._process) is None:
            return ""
        try:
            code = process.wait(grace)
        except subprocess.TimeoutExpired:
            return ""
        how = f"killed by signal {-code}" if code < 0 else f"exit code {code}"
        if code == -9:
            how += ", perhaps out of memory: take a smaller model"
        reason = self._reason()
        return f"{how}: {reason}" if reason else how

    def close(self) -> None:
        """Kill the process. It has nothing to save."""
        self._closed = True
        if self._process is not None:
            self._process.kill()  # if `start` is still running, it sees the end of the pipe and fails
        with self._starting:
            self._end()

    # ------------------------------------------------------------------------------- internals

    def _warm(self, progress: Callable[[float], None]) -> None:
        """Read the file, which is the slow part of loading. Llama.cpp then finds the file in memory."""
        with contextlib.suppress(OSError), self.key.path.open("rb", buffering=0) as file:
            size, done, shown = os.fstat(file.fileno()).st_size, 0, 0.0
            while not self._closed and (block := file.read(4 << 20)):
                done += len(block)
                if done / size - shown >= 0.02:
                    shown = done / size
                    progress(0.95 * min(shown, 1.0))

    def _spawn(self) -> subprocess.Popen[str]:
        self._refuse_closed()
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115  # `_end` closes it
        try:
            # -P: a file in the child's folder must not be imported in place of a package of the same name.
            self._process = subprocess.Popen(
                [sys.executable, "-P", str(Path(__file__).with_name("llama_child.py"))],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._errors,
                encoding="utf-8",
                start_new_session=True,
            )
        except (OSError, ValueError) as error:
            raise PlatformError(f"wildtalk: cannot start Python for the model ({sys.executable!r}): {error}") from error
        return self._process

    def _wait(self, process: subprocess.Popen[str]) -> str:
        assert process.stdin is not None and process.stdout is not None
        with contextlib.suppress(OSError):  # the process has already ended; its exit code explains why
            config = {**asdict(self.key), "path": str(self.key.path), "key": self.secret}
            process.stdin.write(json.dumps(config) + "\n")
            process.stdin.flush()
        if address := process.stdout.readline().strip():
            return address
        process.wait()
        self._refuse_closed()
        reason = (self._reason() or self.obituary()).rstrip(".")
        self._end()
        raise PlatformError(
            f"wildtalk: cannot load the model {str(self.key.path)!r}: {reason}. {_remedy(reason, self.key)}"
        )

    def _refuse_closed(self) -> None:
        if self._closed:
            raise PlatformError("wildtalk: the model was closed while it was loading")

    def _reason(self) -> str:
        """Return llama.cpp's reason for a failure: its first line about an error, which is the most precise."""
        if self._errors is None:
            return ""
        self._errors.seek(0)
        said = self._errors.read(1 << 16).decode("utf-8", "replace").splitlines()
        faults = [line for line in said if " E " in line] or said[-1:]
        for line in faults:
            if "error loading model:" in line and "failed to load model from" not in line:
                return line.rpartition("error loading model:")[2].strip()
        return faults[0].rpartition(" E ")[2].strip() if faults else ""

    def _end(self) -> None:
        process, self._process = self._process, None
        if process is not None:
            process.kill()
            with contextlib.suppress(OSError):
                process.communicate()
        if self._errors is not None:
            self._errors.close()
            self._errors = None


def _remedy(reason: str, key: ModelKey) -> str:
    if "No module named" in reason:
        return "Install it: pip install 'ravestate[wildtalk]'"
    if "corrupted or incomplete" in reason or "failed to read" in reason:
        return "The file is cut short or damaged: fetch it again"
    if "unknown model architecture" in reason:
        return "This llama.cpp is too old for it: pip install -U xllamacpp"
    if "alloc" in reason or "memory" in reason:
        return f"Take a smaller model, or fewer wildtalk.context_tokens than {key.context_tokens}"
    return "Name a chat model in GGUF format: --set wildtalk.model_path=/path/to/model.gguf"


# ------------------------------------------------------------------------------------- sharing

_processes: dict[ModelKey, LlamaProcess] = {}
_sharing = threading.Lock()


def take(key: ModelKey) -> LlamaProcess:
    """Return the process for `key`, started or not, and count one more user. Call `drop` when you are done."""
    with _sharing:
        process = _processes.setdefault(key, LlamaProcess(key))
        process.users += 1
        return process


def drop(process: LlamaProcess) -> None:
    """Remove a user of `process`. When no user is left, the process ends; this blocks for a few milliseconds."""
    with _sharing:
        process.users -= 1
        if process.users:
            return
        del _processes[process.key]
    process.close()


@atexit.register
def _close_all() -> None:
    for process in list(_processes.values()):
        process.close()
