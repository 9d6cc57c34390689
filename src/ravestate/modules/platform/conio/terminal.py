"""The console on a terminal: a prompt with editing and history, and output above it."""

from __future__ import annotations

import asyncio
import contextlib
import contextvars
import os
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

from prompt_toolkit import PromptSession
from prompt_toolkit.application import in_terminal
from prompt_toolkit.filters import Condition
from prompt_toolkit.formatted_text import StyleAndTextTuples
from prompt_toolkit.history import FileHistory, History, InMemoryHistory
from prompt_toolkit.input import Input
from prompt_toolkit.key_binding import KeyBindings, KeyPressEvent
from prompt_toolkit.keys import Keys
from prompt_toolkit.output import Output
from prompt_toolkit.patch_stdout import patch_stdout
from prompt_toolkit.utils import get_cwidth

from ravestate.modules._text import without_controls

LONGEST = 10_000
"""A line of this many characters ignores further keys, because the undo history may store the whole line for each key.
A pasted text is always accepted whole."""

_OPEN = "…"  # the mark of an interrupted text; the console adds it to a streamed line when the user enters a line


class Terminal:
    """Reads lines with prompt_toolkit, and prints texts without disturbing the line that the user types.

    A finished line appears above the prompt. A line that comes in pieces (`stream`) is the first row of the prompt
    until it is finished or as wide as the terminal. This row can grow while the user types below it.
    """

    interactive = True

    def __init__(
        self,
        prompt: str = "> ",
        history: Path | None = None,
        on_key: Callable[[], None] | None = None,
        *,
        input: Input | None = None,
        output: Output | None = None,
    ) -> None:
        """Make a console; it reads and writes nothing yet.

        The file `history` keeps typed lines. If the file cannot be written, the lines are kept for this session only.
        `on_key` is called after each key that changes the line, unless the line is then empty.
        """
        self._prompt = prompt
        self._streamed = ""
        self._left_open = False
        self._late = ""
        self._unprinted: list[str] = []
        self._printing: asyncio.Task[None] | None = None
        self._lost = False
        self._session: PromptSession[str] = PromptSession(
            self.message, history=_history(history), key_bindings=self._keys(), input=input, output=output
        )
        self._on_key = on_key
        self._session.default_buffer.on_text_changed += self._tell
        self._patch = contextlib.ExitStack()
        self._context = contextvars.copy_context()

    async def __aenter__(self) -> Terminal:
        self._context = contextvars.copy_context()
        stderr = sys.stderr
        self._patch.enter_context(patch_stdout(raw=True))  # any other print goes above the prompt as well
        if not stderr.isatty():  # standard error is redirected, so it does not disturb the prompt
            self._patch.enter_context(contextlib.redirect_stderr(stderr))
        return self

    async def __aexit__(self, *_: object) -> None:
        self.end()
        if self._printing is not None:
            await asyncio.wait([self._printing])
        self._patch.close()

    async def read(self) -> str:
        """Return the next line, as `Screen.read` describes."""
        if self._lost:
            raise EOFError
        try:
            return await self._session.prompt_async(handle_sigint=False, set_exception_handler=False)
        finally:
            # The streamed text so far stays above the line that the user typed.
            self._left_open = bool(self._streamed)
            self._streamed = ""

    def show(self, text: str) -> None:
        """Print whole lines, as `Screen.show` describes."""
        if self._lost:
            raise BrokenPipeError
        self._unprinted.append(text + "\n")
        if self._printing is None or self._printing.done():
            loop = asyncio.get_running_loop()
            self._printing = loop.create_task(self._print(), context=self._context.copy())

    def stream(self, piece: str) -> None:
        """Print a piece of a line, as `Screen.stream` describes."""
        if self._left_open:  # keep the pieces; the last one will show whether the user's line interrupted the text
            self._late += piece
            return
        *lines, self._streamed = (self._streamed + piece).split("\n")
        for line in lines:
            self.show(line)
        width = self._session.output.get_size().columns
        while get_cwidth(self._streamed) >= width > 1:
            row, self._streamed = _full_row(self._streamed, width)
            self.show(row)
        self._session.app.invalidate()

    def end(self) -> None:
        """End the line of pieces, as `Screen.end` describes."""
        late, self._late, self._left_open = self._late, "", False
        line, self._streamed = self._streamed, ""
        if late and not late.endswith(_OPEN):  # the mark means that the agent broke off the text: drop the late pieces
            line += late
        if line:
            self.show(line)

    def message(self) -> StyleAndTextTuples:
        """Return the text before the typed line: the streamed line, if there is one, and the prompt."""
        before: StyleAndTextTuples = []
        if self._streamed:
            before = [("", self._streamed), ("", _OPEN if self._session.app.is_done else ""), ("", "\n")]
        return [*before, ("class:prompt", self._prompt)]

    def _keys(self) -> KeyBindings:
        keys = KeyBindings()
        is_full = Condition(lambda: len(self._session.default_buffer.text) >= LONGEST)

        @keys.add(Keys.Any, filter=is_full)  # keys that insert a character; not editing keys, Enter or pasting
        def leave_out(event: KeyPressEvent) -> None:
            """Ignore the key, because the line is full."""

        @keys.add(Keys.Vt100MouseEvent, eager=True)  # a pasted colour code may look like a mouse event
        def ignore(event: KeyPressEvent) -> None:
            """Ignore the mouse."""

        return keys

    def _tell(self, _: object) -> None:
        if self._on_key is not None and self._session.default_buffer.text:
            self._on_key()

    async def _print(self) -> None:
        output = self._session.output
        try:
            while self._unprinted:
                async with in_terminal():
                    text, self._unprinted = "".join(self._unprinted), []
                    output.enable_autowrap()
                    output.write_raw(text.replace("\n", "\r\n"))
                    output.flush()
        except OSError:  # the terminal is gone
            self._lost = True
            app = self._session.app
            if app.is_running:
                app.exit(exception=EOFError())


def _full_row(text: str, width: int) -> tuple[str, str]:
    """Split a text that is too long for one row. Return its first row (less than `width` columns) and the rest."""
    used = end = 0
    for end, character in enumerate(text):  # noqa: B007  # used after the loop
        used += get_cwidth(character)
        if used >= width:
            break
    space = text.rfind(" ", 0, end + 1)
    if space > 0:
        return text[:space], text[space + 1 :]
    end = max(end, 1)
    return text[:end], text[end:]


class _KeptHistory(FileHistory):
    """A history file that may become unreadable or unwritable at any time, without an error."""

    def load_history_strings(self) -> Iterable[str]:
        with contextlib.suppress(OSError):
            return super().load_history_strings()
        return ()

    def store_string(self, string: str) -> None:
        with contextlib.suppress(OSError):
            super().store_string(without_controls(string))


def _history(file: Path | None) -> History:
    if file is None:
        return InMemoryHistory()
    try:
        file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        # A user's words to an agent are private.
        os.close(os.open(file, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600))
    except OSError:
        return InMemoryHistory()
    return _KeptHistory(str(file))
