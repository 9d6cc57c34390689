"""A progress bar on standard error."""

from __future__ import annotations

import sys
import time
from contextlib import AbstractContextManager, suppress
from typing import Any, TextIO


class ProgressBar(AbstractContextManager["ProgressBar"]):
    """A progress bar that appears after `delay` seconds, and only on a terminal.

    It is a tqdm bar, which disappears at the end. If an input prompt owns the terminal, the bar is a single line
    instead, because that prompt prints standard error line by line.
    """

    def __init__(self, label: str, *, delay: float = 1.0, stream: TextIO | None = None) -> None:
        """`stream`: the stream to write to; by default, standard error at the time of the first call."""
        self._label = label
        self._shown_from = time.monotonic() + delay
        self._stream = stream
        self._told = False
        self._bar: Any = None

    def __call__(self, fraction: float) -> None:
        """Show that `fraction` (0.0 to 1.0) is done."""
        stream = self._stream or sys.stderr
        if stream is None or not stream.isatty() or time.monotonic() < self._shown_from:
            return
        if self._bar is not None:
            self._bar.update(round(100 * fraction) - self._bar.n)
        elif fraction < 1.0 and self._stream is None and stream is not sys.__stderr__:
            if not self._told:
                stream.write(f"{self._label}…\n")
            self._told = True
        elif fraction < 1.0:
            with suppress(ImportError):
                from tqdm import tqdm

                form = "{desc}: {bar} {percentage:3.0f} %"
                self._bar = tqdm(total=100, desc=self._label, file=stream, leave=False, bar_format=form)
                self._bar.update(round(100 * fraction))

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()
