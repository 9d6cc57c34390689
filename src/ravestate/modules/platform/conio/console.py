"""A console: lines that come in, texts that go out, whether a person sits there or a pipe ends there."""

from __future__ import annotations

import contextlib
import errno
import importlib
import sys
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from types import TracebackType
from typing import Literal, Protocol, TextIO

from ravestate.errors import PlatformError
from ravestate.modules._folders import user_folder
from ravestate.modules._text import printable, without_controls

__all__ = ["Console", "Screen", "history_file", "prepare"]

_FULL = (errno.ENOSPC, errno.EFBIG, errno.EDQUOT)

Ending = Literal["end of input", "interrupt", "closed"]


class Screen(Protocol):
    """What a `Console` reads from and writes to."""

    interactive: bool
    """Whether somebody sits there."""

    async def __aenter__(self) -> object: ...

    async def __aexit__(self, *_: object) -> None: ...

    async def read(self) -> str:
        """The next line. Raises EOFError at the end, KeyboardInterrupt for Ctrl-C, OSError for a lost line."""
        ...

    def show(self, text: str) -> None:
        """Print whole lines. Raises OSError where nobody reads any more."""
        ...

    def stream(self, piece: str) -> None:
        """Print a piece of a line as soon as it makes sense."""
        ...

    def end(self) -> None:
        """End the line that was streamed, if any."""
        ...


class Console:
    """An async iterator of the lines that are typed, and a place to write to meanwhile.

    Where input and output are a terminal there is a prompt with editing and a history, and what is written
    appears above it. Elsewhere lines are read and written plainly. Control characters and bytes that are not
    text are taken out in both directions, so that neither a user nor a language model moves the cursor.

    Everything is to be called on one event loop; writing never fails: if nobody reads any more, the
    iteration ends.

    Example:
        ```python
        async with Console() as console:
            async for line in console:
                console.write(f"You said {line!r}.")
        ```
    """

    def __init__(
        self,
        screen: Screen | None = None,
        *,
        prompt: str = "> ",
        history: Path | None = None,
        on_key: Callable[[], None] | None = None,
        stdin: TextIO | None = None,
        stdout: TextIO | None = None,
    ) -> None:
        """Choose how to read and write; nothing is read or written yet.

        Args:
            screen: What to read from and write to, chosen by default.
            prompt: What stands before the line that is typed.
            history: The file that keeps what was typed; None keeps it for this session only.
            on_key: Called when somebody types, which only a terminal notices.
            stdin: Read this instead of standard input.
            stdout: Write this instead of standard output.

        Raises:
            PlatformError: It is a terminal, but prompt_toolkit is not installed.
        """
        if screen is None:
            stdin, stdout = stdin or sys.stdin, stdout or sys.stdout
            screen = _screen(prompt, history, on_key, stdin, stdout)
        self._screen = screen
        self._streamed = ""
        self._line_is_open = False
        self.ending: Ending | None = None
        """Why the iteration ended: end of input (Ctrl-D), interrupt (Ctrl-C), or closed (by whoever reads)."""
        self.failure: PlatformError | None = None
        """Why nothing more can be written, where that is not because nobody reads."""

    @property
    def interactive(self) -> bool:
        """Whether somebody sits there; otherwise all lines may come at once, and then the end."""
        return self._screen.interactive

    async def __aenter__(self) -> Console:
        await self._screen.__aenter__()
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.end()
        await self._screen.__aexit__(kind, error, trace)

    def __aiter__(self) -> AsyncIterator[str]:
        return self

    async def __anext__(self) -> str:
        """Wait for the next line, without its line end. A line that was begun when this was cancelled is kept."""
        if self.ending is None:
            try:
                return printable(await self._screen.read())
            except EOFError:
                self.ending = "end of input"
            except KeyboardInterrupt:
                self.ending = "interrupt"
            except OSError:
                self.ending = "closed"
        raise StopAsyncIteration

    def write(self, text: str) -> None:
        """Print `text` and a line end.

        If `text` begins with all that was streamed, it is what the streamed text becomes; otherwise the streamed line is
        ended before, and what is streamed later goes on in a line of its own.
        """
        text = printable(text)
        if self._streamed and text.startswith(self._streamed):
            self.stream(text[len(self._streamed) :])
            self.end()
        else:
            self._end_line()
            self._safely(lambda: self._screen.show(text))

    def stream(self, piece: str) -> None:
        """Print `piece` behind the pieces before it; where nobody watches, once its line is complete."""
        piece = without_controls(piece)
        if piece:
            self._streamed += piece
            self._line_is_open = True
            self._safely(lambda: self._screen.stream(piece))

    def end(self) -> None:
        """End the text that was streamed; without one this does nothing."""
        self._streamed = ""
        self._end_line()

    def _end_line(self) -> None:
        if self._line_is_open:
            self._line_is_open = False
            self._safely(self._screen.end)

    def _safely(self, write: Callable[[], None]) -> None:
        if self.ending == "closed":
            return
        try:
            write()
        except (OSError, ValueError) as error:  # mostly a broken pipe, a closed file
            self.ending = "closed"
            if isinstance(error, OSError) and error.errno in _FULL:
                self.failure = PlatformError(
                    f"conio: what the agent says cannot be written: {error.strerror}"
                )


def prepare() -> None:
    """Load what a `Console` on a terminal needs, which takes a while; on the event loop that would hold everybody up."""
    if _is_terminal(sys.stdin, sys.stdout):
        with contextlib.suppress(ImportError):  # the console says so
            importlib.import_module(".terminal", __package__)


def _is_terminal(stdin: TextIO | None, stdout: TextIO | None) -> bool:
    return stdin is not None and stdout is not None and stdin.isatty() and stdout.isatty()


def _screen(
    prompt: str,
    history: Path | None,
    on_key: Callable[[], None] | None,
    stdin: TextIO | None,
    stdout: TextIO | None,
) -> Screen:
    if _is_terminal(stdin, stdout):
        try:
            from .terminal import Terminal
        except ImportError as error:
            raise PlatformError(
                "conio on a terminal needs prompt_toolkit: pip install 'ravestate[console]'"
            ) from error
        return Terminal(prompt, history, on_key)
    from .pipes import Pipes

    return Pipes(stdin, stdout)


def history_file() -> Path:
    """Return where the lines typed are kept from session to session: in the user's folder for state."""
    return user_folder("state") / "history"
