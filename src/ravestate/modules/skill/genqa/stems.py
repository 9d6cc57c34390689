"""Stems of words, by the tokenizer of the index."""

from __future__ import annotations

import sqlite3
import threading

TOKENIZER = "porter unicode61 remove_diacritics 2"
"""The tokenizer keeps letters and digits, in lower case, without accents and without English endings."""


class Stems:
    """SQLite's tokenizer, as a function. Thread-safe.

    Example:
        >>> Stems()("Was the capital of Colombia always Bogotá?", "capitals")
        [['wa', 'the', 'capit', 'of', 'colombia', 'alwai', 'bogota'], ['capit']]
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._base = sqlite3.connect(":memory:", check_same_thread=False, isolation_level=None)
        self._base.execute(f"CREATE VIRTUAL TABLE texts USING fts5(text, tokenize='{TOKENIZER}')")
        self._base.execute("CREATE VIRTUAL TABLE words USING fts5vocab(texts, 'instance')")

    def __call__(self, *texts: str) -> list[list[str]]:
        """Return the stems of each text, in order."""
        found: list[list[tuple[int, str]]] = [[] for _ in texts]  # by place in the text
        with self._lock:
            self._base.execute("DELETE FROM texts")
            self._base.executemany("INSERT INTO texts(rowid, text) VALUES (?, ?)", enumerate(texts))
            rows: list[tuple[str, int, int]] = self._base.execute('SELECT term, doc, "offset" FROM words').fetchall()
        for term, text, offset in rows:
            found[text].append((offset, term))
        return [[term for _, term in sorted(stems)] for stems in found]

    def close(self) -> None:
        """Close the tokenizer's database."""
        self._base.close()
