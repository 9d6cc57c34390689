"""A lock for the import of large libraries, one at a time."""

from __future__ import annotations

import threading

LOADING = threading.RLock()
"""A lock to hold while importing a large library, or loading a model, which may import parts of a library.

Two threads that import parts of one library at the same time may deadlock. The interpreter then hands one of them a
module that is only half loaded. This happens with numpy, which spaCy, onnxruntime and others import.
"""
