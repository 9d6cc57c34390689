"""A lock, so that only one thread at a time imports a large library."""

from __future__ import annotations

import threading

LOADING = threading.RLock()
"""A lock to hold during the import of a large library, and while a model loads, which may import parts of a library.

Two threads that import parts of one library at the same time may deadlock. The interpreter then gives one thread a
module that is only half loaded. This happens with numpy, which spaCy, onnxruntime and others import.
"""
