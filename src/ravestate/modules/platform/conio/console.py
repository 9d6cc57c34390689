"""A console: it reads the user's lines and prints the agent's texts, on a terminal or through pipes."""

from __future__ import annotations

import contextlib
import errno
import importlib
import sys
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Literal, Protocol, TextIO

from ravestate.errors import PlatformError
from ravestate.folders import user_folder
from ravestate.modules import rawio
from ravestate.modules._text import printable, without_controls

FULL = (errno.ENOSPC, errno.EFBIG, errno.EDQUOT)
"""The error numbers (``errno``) that mean that there is no room for more output."""

Ending = Literal["end of input", "interrupt", "closed"]


class Screen(Protocol):
    """The input and output of a `Console`: it reads lines and prints texts."""

    interactive: bool
    """Whether a person types the lines at a prompt (`Terminal`)."""

    async def __aenter__(self) -> object: ...

    async def __aexit__(self, *_: object) -> None: ...

    async def read(self) -> str:
        """Return the next line. Raise EOFError at the end of input, KeyboardInterrupt for Ctrl-C, OSError for a fault."""
        ...

    def show(self, text: str) -> None:
        """Print a text of whole lines. Raise OSError if the output is gone."""

    def stream(self, piece: str) -> None:
        """Print a piece of a line: immediately on a terminal, but elsewhere only when the line is complete."""

    def end(self) -> None:
        """End the line of pieces that `stream` has begun, if there is one."""


class Console:
    """An async iterator of the lines that the user types; meanwhile, `utter` and `grow` print texts.

    If input and output are a terminal, there is a prompt with editing and a history, and output appears above it.
    If not, or with `Pipes` as the screen, the console reads and writes plain lines. It removes control characters in both directions, so neither a
    user nor a language model can move the cursor.

    Call all methods on one event loop. Writing never fails: if the output is gone, the iteration ends after the next
    line.

    Example:
        ```python
        async with Console() as console:
            async for line in console:
                console.utter(f"You said {line!r}.")
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
        """Make a console; it reads and writes nothing yet.

        Args:
            screen: The input and output. By default, a `Terminal` or `Pipes`, depending on the streams.
            prompt: The text before the line that the user types.
            history: The file that keeps typed lines. If None, they are kept for this session only.
            on_key: A function to call when a key changes the line that the user types. Only a `Terminal` calls it.
            stdin, stdout: The streams to use instead of standard input and output.

        Raises:
            PlatformError: A terminal needs prompt_toolkit, which is not installed.
        """
        self._screen = screen or _screen(prompt, history, on_key, stdin or sys.stdin, stdout or sys.stdout)
        self._streamed = ""
        self._line_is_open = False
        self.ending: Ending | None = None
        """Why the iteration ended: end of input (Ctrl-D), interrupt (Ctrl-C) or closed (output is gone).

        The value is None while the iteration goes on.
        """
        self.failure: PlatformError | None = None
        """The error that made the output unusable, e.g. a full disk; None if the output works, or was merely closed."""

    @property
    def interactive(self) -> bool:
        """Whether a person types the lines at a prompt. If not, all lines and the end of input may arrive at the same
        time."""
        return self._screen.interactive

    async def __aenter__(self) -> Console:
        await self._screen.__aenter__()
        return self

    async def __aexit__(self, *error: object) -> None:
        self.fall_silent()
        await self._screen.__aexit__(*error)

    def __aiter__(self) -> AsyncIterator[str]:
        return self

    async def __anext__(self) -> str:
        """Return the next line, without its line end. If this call is cancelled, the next call returns the line."""
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

    def utter(self, text: str, origin: object = None) -> None:
        """Print `text` and a line end.

        If `text` begins with the pieces that `grow` has printed, only the rest of `text` is printed. If `text` begins
        in another way, the line of pieces ends first. Further pieces then begin a new line.
        """
        text = printable(text)
        if self._streamed and (rest := rawio.rest(text, self._streamed)) is not None:
            self.grow(rest)
            self.fall_silent()
        else:
            self._end_line()
            self._safely(lambda: self._screen.show(text))

    def grow(self, piece: str, origin: object = None) -> None:
        """Print `piece` after the earlier pieces of its text. Without a terminal, print only whole lines."""
        piece = without_controls(piece)
        if piece:
            self._streamed += piece
            self._line_is_open = True
            self._safely(lambda: self._screen.stream(piece))

    def fall_silent(self, origin: object = None) -> None:
        """End the line of the pieces printed so far; if there are none, do nothing."""
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
        except (OSError, ValueError) as error:  # usually a broken pipe or a closed file
            self.ending = "closed"
            if isinstance(error, OSError) and error.errno in FULL:
                self.failure = PlatformError(f"conio: the agent's words cannot be written: {error.strerror}")


def prepare() -> None:
    """If the console is a terminal, load prompt_toolkit. Call this in a thread, because it blocks."""
    if is_terminal(sys.stdin, sys.stdout):
        with contextlib.suppress(ImportError):  # the console reports the missing package
            importlib.import_module(".terminal", __package__)


def is_terminal(stdin: TextIO | None, stdout: TextIO | None) -> bool:
    """Return whether a person types the lines and sees the texts."""
    return stdin is not None and stdout is not None and stdin.isatty() and stdout.isatty()


def _screen(
    prompt: str, history: Path | None, on_key: Callable[[], None] | None, stdin: TextIO | None, stdout: TextIO | None
) -> Screen:
    if is_terminal(stdin, stdout):
        try:
            from .terminal import Terminal
        except ImportError as error:
            raise PlatformError("conio on a terminal needs prompt_toolkit: pip install 'ravestate[console]'") from error
        return Terminal(prompt, history, on_key)
    from .pipes import Pipes

    return Pipes(stdin, stdout)


def history_file() -> Path:
    """Return the file in the user's state folder that keeps typed lines from session to session."""
    return user_folder("state") / "history"
