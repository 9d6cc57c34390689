"""A progress bar on standard error."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import Any, TextIO


class ProgressBar:
    """A progress bar that appears after `delay` seconds, and only on a terminal.

    On a terminal it is a tqdm bar, removed at the end. Where a prompt owns the terminal, it is a single line, because
    the prompt prints standard error line by line. Elsewhere nothing appears.

    Example:
        ```python
        with ProgressBar("Loading the language model") as bar:
            await backend.load(bar)
        ```
    """

    def __init__(self, label: str, *, delay: float = 1.0, stream: TextIO | None = None, size: int = 0) -> None:
        """`stream`: where to show it, by default standard error at the first call; `size`: bytes, to show the speed."""
        self._label = label
        self._size = size
        self._delay = delay
        self._stream = stream
        self._began = time.monotonic()
        self._told = False
        self._bar: Any = None

    def __call__(self, fraction: float) -> None:
        """Show that `fraction` (0.0 to 1.0) is done."""
        stream = self._stream or sys.stderr
        if stream is None or not stream.isatty():
            return
        if time.monotonic() - self._began < self._delay:
            return
        if self._stream is None and stream is not sys.__stderr__:
            if not self._told and fraction < 1.0:
                stream.write(f"{self._label}…\n")
                self._told = True
            return
        if self._bar is None:
            if fraction >= 1.0:
                return
            try:
                from tqdm import tqdm
            except ImportError:
                return
            self._bar = tqdm(
                total=self._size or 100,
                desc=self._label,
                file=stream,
                leave=False,
                unit="B",
                unit_scale=True,
                initial=round(self._size * fraction),  # a continued download has bytes already
                bar_format=None if self._size else "{desc}: {bar} {percentage:3.0f} %",
            )
        self._bar.update(round(self._bar.total * fraction) - self._bar.n)

    def close(self) -> None:
        """Remove the bar."""
        if self._bar is not None:
            self._bar.close()
            self._bar = None

    def __enter__(self) -> ProgressBar:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
