"""Functions that remove control characters from text, so that it is safe to show to a person or a model."""

from __future__ import annotations

import re

# A terminal's escape sequences: CSI (colours, cursor), OSC (titles, links), and sequences of two characters.
_ESCAPES = re.compile(
    r"\x1b\[[0-?]*[ -/]*[@-~]|\x1b\][^\x07\x1b]*(?:\x07|\x1b\\)|\x1b[ -/]*[0-~]|\x9b[0-?]*[ -/]*[@-~]"
)
# C0 except tab and line feed, DEL, C1.
_CONTROLS = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")
_SURROGATES = re.compile(r"[\ud800-\udfff]")


def without_controls(text: str) -> str:
    """Return `text` without control characters. Use this function for a piece of a longer text.

    A piece may have only a part of an escape sequence, so these sequences are not recognised. Line feeds and tabs stay.
    Lone surrogates, which in Python stand for bytes that are not UTF-8, become U+FFFD. So the result can always be
    encoded.

    Example:
        >>> without_controls("a\\x00b\\udcff")
        'ab�'
    """
    return _SURROGATES.sub("\ufffd", _CONTROLS.sub("", text))


def printable(text: str) -> str:
    """Return `text` without terminal escape sequences and control characters. Use this function for a whole text.

    The function works like `without_controls`. It also removes escape sequences, and turns ``\\r\\n`` and ``\\r`` into
    line feeds.

    Example:
        >>> printable("\\x1b[31mred\\x1b[0m\\x00")
        'red'
    """
    if "\r" in text:
        text = text.replace("\r\n", "\n").replace("\r", "\n")
    if "\x1b" in text or "\x9b" in text:
        text = _ESCAPES.sub("", text)
    return without_controls(text)
