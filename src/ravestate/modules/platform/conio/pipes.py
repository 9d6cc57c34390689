"""The console without a terminal: plain lines from standard input to standard output."""

from __future__ import annotations

import asyncio
import contextlib
import os
import sys
import threading
from typing import TextIO

_BLOCK = 1 << 16


class Pipes:
    """Reads lines in its own thread, one at a time and only on request. Writes and flushes line by line.

    The streams may be pipes or files. The thread ends when its input ends or when this object is closed. The process
    can end while the thread waits for a line.
    """

    interactive = False

    def __init__(self, stdin: TextIO | None, stdout: TextIO | None, *, longest_line: int = 1 << 20) -> None:
        """Make a console; it reads nothing yet. Pass None for a closed stream.

        It reads at most `longest_line` bytes of each line, and ignores the rest of the line.
        """
        self._stdin = stdin
        self._stdout = stdout
        self._longest = longest_line
        self._watched = stdout is not None and stdout.isatty()
        self._unwritten = ""
        self._ended = False
        self._wanted = threading.Semaphore(0)
        self._line: asyncio.Future[str | None] | None = None
        self._loop: asyncio.AbstractEventLoop | None = None

    async def __aenter__(self) -> Pipes:
        return self

    async def __aexit__(self, *_: object) -> None:
        self._loop = None  # from now on, no task waits for a line
        self._wanted.release()

    async def read(self) -> str:
        """Return the next line, as `Screen.read` describes."""
        if self._stdin is None or self._ended:
            raise EOFError
        if self._loop is None:
            self._loop = asyncio.get_running_loop()
            # When the program ends, nothing can wake a thread that waits for input. So the thread is a daemon.
            threading.Thread(target=self._read_all, args=(self._stdin,), name="conio", daemon=True).start()
        if self._line is None:
            self._line = self._loop.create_future()
            self._wanted.release()
        line = await asyncio.shield(self._line)  # if this wait is cancelled, the next call gets the line
        self._line = None
        if line is None:
            self._ended = True
            raise EOFError
        return line

    def show(self, text: str) -> None:
        """Print whole lines, as `Screen.show` describes."""
        self._write(text + "\n")

    def stream(self, piece: str) -> None:
        """Print a piece of a line: immediately on a terminal, but elsewhere only when the line is complete."""
        self._unwritten += piece
        if self._watched:
            ready, self._unwritten = self._unwritten, ""
        else:
            ready, line_end, self._unwritten = self._unwritten.rpartition("\n")
            ready += line_end
        if ready:
            self._write(ready)

    def end(self) -> None:
        """End the line of pieces, as `Screen.end` describes."""
        rest, self._unwritten = self._unwritten, ""
        self._write(rest + "\n")

    def _write(self, text: str) -> None:
        if self._stdout is None:
            raise BrokenPipeError
        encoding = self._stdout.encoding or "utf-8"
        try:
            self._stdout.write(text.encode(encoding, "replace").decode(encoding))
            self._stdout.flush()
        except OSError:
            self._silence()
            raise

    def _silence(self) -> None:
        """Redirect the broken standard output, because Python's own flush at exit would print a second error."""
        if self._stdout is not None and self._stdout is sys.stdout:
            with contextlib.suppress(OSError, ValueError):
                nowhere = os.open(os.devnull, os.O_WRONLY)
                os.dup2(nowhere, self._stdout.fileno())
                os.close(nowhere)

    # The following methods run in the reading thread.

    def _read_all(self, stdin: TextIO) -> None:
        rest, ended, skipping = b"", False, False
        while True:
            self._wanted.acquire()
            if self._loop is None:
                return
            while b"\n" not in rest and not ended:
                try:
                    block = os.read(stdin.fileno(), _BLOCK)
                except (OSError, ValueError):
                    block = b""
                ended = not block
                if skipping:  # leave out the rest of a line that was too long
                    _, line_end, block = block.partition(b"\n")
                    skipping = not line_end
                rest += block
                if len(rest) > self._longest and b"\n" not in rest:
                    rest, skipping = rest[: self._longest] + b"\n", True
            line, line_end, rest = rest.partition(b"\n")
            if ended and not line and not line_end:
                self._deliver(None)
                return
            self._deliver(line[: self._longest].removesuffix(b"\r").decode("utf-8", "replace"))

    def _deliver(self, line: str | None) -> None:
        loop, future = self._loop, self._line
        if loop is None or future is None:
            return

        def resolve() -> None:
            if not future.done():
                future.set_result(line)

        with contextlib.suppress(RuntimeError):  # the event loop is closed
            loop.call_soon_threadsafe(resolve)
