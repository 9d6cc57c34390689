"""Large libraries are imported one after the other."""

from __future__ import annotations

import threading

__all__ = ["LOADING"]

LOADING = threading.RLock()
"""Held while a large library is imported, and by whoever loads what may import parts of one on the way.

Of two threads that import parts of one library at the same time, one may be given a module that is only half there: the
interpreter resolves what would be a deadlock of its import locks in this way. (numpy is such a library, and spaCy, onnxruntime
and others import it.)
"""
