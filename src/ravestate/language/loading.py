"""Load large libraries and models one at a time, and after the console's prompt."""

from __future__ import annotations

import threading

LOADING = threading.RLock()
"""A lock to hold while a large library is imported, or a model loads. Loading a model may import parts of a library.

If two threads import parts of one library at the same time, they may wait for each other. To avoid the deadlock, the
interpreter gives one thread a half-loaded module. This happens with numpy, which spaCy, onnxruntime and others import.
"""

LONGEST = 5.0
"""The maximum time in seconds that models wait for a prompt."""

_shown = threading.Event()
_shown.set()


def expect_prompt() -> None:
    """Note that the console will soon show its prompt. If models loaded first, the prompt would come seconds later."""
    _shown.clear()


def note_prompt() -> None:
    """Note that the prompt has appeared, or will not appear."""
    _shown.set()


def wait_for_prompt() -> bool:
    """Wait until an expected prompt has appeared. After `LONGEST` seconds, stop waiting and return false.

    A background rule that loads a large library or model calls this first.
    """
    return _shown.wait(LONGEST)
