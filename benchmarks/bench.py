"""Tools that all questions share: contestants (Ravestate and its peers), the number of repetitions, and progress
messages."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator
from pathlib import Path

from benchmarks import environments
from benchmarks.child import Child

__all__ = ["Bench"]


class Bench(contextlib.ExitStack):
    """The contestants of one question. Leaving the ``with`` block ends the contestants' processes.

    Args:
        question: The name of the question.
        quick: Whether to repeat less often.
    """

    def __init__(self, question: str, quick: bool) -> None:
        super().__init__()
        self.question = question
        self.quick = quick

    def rounds(self, many: int, few: int = 3) -> Iterator[int]:
        """Yield the index of each repetition. In each repetition, run all contestants, so that noise affects them
        alike."""
        total = few if self.quick else many
        for number in range(total):
            self.progress(f"round {number + 1} of {total}")
            yield number

    def several(self, many: int, few: int) -> int:
        """Return the number of measurements within a repetition: `many`, or `few` if `quick`."""
        return few if self.quick else many

    def ours(self, module: str = "benchmarks.peers.ours") -> Child:
        """Return a process of Ravestate."""
        return self._started(Child.ours(module))

    def clips(self) -> Child:
        """Return a process of CLIPS."""
        return self._started(Child.peer(environments.clips(self.progress), "clips_rules.py"))

    def peer(self, script: str) -> Child:
        """Return a process of another peer; `script` is the peer's file in ``peers``."""
        return self._started(Child.peer(environments.peers(self.progress), script))

    def reference(self) -> Child:
        """Return a process of the reference implementation."""
        return self._started(Child.peer(environments.reference(self.progress), "reference.py"))

    def callbacks(self) -> Child:
        """Return a process of the floor (bare asyncio, without rules)."""
        return self._started(Child.peer(sys.executable, "callbacks.py"))

    def reference_interpreter(self) -> Path:
        """Return the interpreter that has the reference implementation."""
        return environments.reference(self.progress)

    def progress(self, text: str) -> None:
        """Print progress on the error stream; leave the rounds out unless the stream is a terminal."""
        if sys.stderr.isatty():
            print(f"\r\033[K{self.question}: {text}", end="", file=sys.stderr, flush=True)
        elif not text.startswith("round"):
            print(f"{self.question}: {text}", file=sys.stderr, flush=True)

    def _started(self, child: Child) -> Child:
        self.callback(child.close)
        return child
