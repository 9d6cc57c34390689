"""The order in which large libraries and models load: one at a time, and after the console's prompt."""

from __future__ import annotations

import threading

LOADING = threading.RLock()
"""A lock to hold during the import of a large library, and while a model loads, which may import parts of a library.

Two threads that import parts of one library at the same time may deadlock. The interpreter then gives one thread a
module that is only half loaded. This happens with numpy, which spaCy, onnxruntime and others import.
"""

LONGEST = 5.0
"""The maximum time in seconds that models wait for a prompt."""

_shown = threading.Event()
_shown.set()


def expect_prompt() -> None:
    """Note that the console is about to show its prompt. If models loaded meanwhile, the prompt would take seconds longer."""
    _shown.clear()


def note_prompt() -> None:
    """Note that the prompt has appeared, or will not appear."""
    _shown.set()


def wait_for_prompt() -> bool:
    """Wait until an expected prompt has appeared; return false if it has not after `LONGEST`.

    A background rule that loads a large library or model calls this first.
    """
    return _shown.wait(LONGEST)
