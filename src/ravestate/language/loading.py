"""A lock, so that only one thread at a time imports a large library, and none before the console's prompt."""

from __future__ import annotations

import threading

LOADING = threading.RLock()
"""A lock to hold during the import of a large library, and while a model loads, which may import parts of a library.

Two threads that import parts of one library at the same time may deadlock. The interpreter then gives one thread a
module that is only half loaded. This happens with numpy, which spaCy, onnxruntime and others import.

The console holds the lock until it shows its prompt. If other threads loaded models meanwhile, that would take seconds.
"""


def wait_for_prompt() -> None:
    """Wait until the console shows its prompt, and until no thread holds `LOADING`. Rules that load much begin with this."""
    with LOADING:
        pass
