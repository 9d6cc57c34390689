"""A child process, with functions to start it, to end it, and to get the last line of its error output."""

from __future__ import annotations

import contextlib
import os
import subprocess
import tempfile
from collections.abc import Mapping, Sequence

ENDING = 2.0
"""After its standard output is closed, a process may take this many seconds to end by itself; then it is killed."""
LONGEST = 1 << 16
"""`Child.end` reads the end of the error output: at most this many bytes."""


class Child:
    """A running child process. It is in a separate session, so that Ctrl-C does not reach it.

    Args:
        command: The program and its arguments.
        piped: Whether standard input and output are pipes. If not, the input is empty, and the output goes to the error
            output.
        pass_fds: The file descriptors that the process inherits.
        environment: Environment variables in addition to those of this process.

    Raises:
        OSError: The program cannot be started.
    """

    def __init__(
        self,
        command: Sequence[str],
        *,
        piped: bool = False,
        pass_fds: Sequence[int] = (),
        environment: Mapping[str, str] | None = None,
    ) -> None:
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115  # `end` closes it
        try:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE if piped else subprocess.DEVNULL,
                stdout=subprocess.PIPE if piped else self._errors,
                stderr=self._errors,
                bufsize=0,
                pass_fds=pass_fds,
                env={**os.environ, **(environment or {})},
                start_new_session=True,
            )
        except OSError:
            self._errors.close()
            raise
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                os.set_blocking(pipe.fileno(), False)

    @property
    def pid(self) -> int | None:
        """The process id; None if the process does not run."""
        return self._process.pid if self._process.poll() is None else None

    @property
    def stdin(self) -> int:
        """The descriptor of the pipe to the process; it never blocks."""
        assert self._process.stdin is not None, "the process has no pipes"
        return self._process.stdin.fileno()

    @property
    def stdout(self) -> int:
        """The descriptor of the pipe from the process; it never blocks."""
        assert self._process.stdout is not None, "the process has no pipes"
        return self._process.stdout.fileno()

    def kill(self) -> None:
        """Kill the process. Call `end` afterwards."""
        self._process.kill()

    def wait(self, seconds: float) -> None:
        """Wait until the process has ended, but not longer than `seconds`."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(seconds)

    def end(self, patience: float = 0.0) -> str:
        """Make sure that the process is gone. Return how it ended, in words, with the last line of its error output.

        Args:
            patience: Wait this many seconds for the process to end by itself, then kill it.
        """
        self.wait(patience)
        hung = self._process.poll() is None
        if hung:
            self._process.kill()
        code = self._process.wait()
        how = "it did not end by itself" if hung else f"killed by signal {-code}" if code < 0 else f"exit code {code}"
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                with contextlib.suppress(OSError):
                    pipe.close()
        if not self._errors.closed:
            size = self._errors.seek(0, os.SEEK_END)
            self._errors.seek(max(0, size - LONGEST))
            said = self._errors.read(LONGEST).decode("utf-8", "replace").strip().splitlines()
            how += f": {said[-1]}" if said else ""
            self._errors.close()
        return how
