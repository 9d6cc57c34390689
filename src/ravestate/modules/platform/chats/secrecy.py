"""Functions that keep secrets out of the log. Some libraries log addresses that contain a token."""

from __future__ import annotations

import contextlib
import logging
from collections import Counter
from collections.abc import Generator, Iterable
from typing import Any

HIDDEN = "[secret]"


class Censor:
    """Replaces secret texts in the records of all loggers, including tracebacks, while there are secrets."""

    def __init__(self) -> None:
        self._secrets: Counter[str] = Counter()
        self._make = logging.LogRecord  # the factory that the censor has replaced
        self._plain = logging.Formatter()

    def add(self, secrets: Iterable[str]) -> None:
        """Hide texts. If no texts were hidden before, install the censor."""
        if not self._secrets:
            self._make = logging.getLogRecordFactory()
            logging.setLogRecordFactory(self.record)
        self._secrets.update(secrets)

    def remove(self, secrets: Iterable[str]) -> None:
        """Stop hiding texts, unless another caller hides them, too. If no texts are left, remove the censor."""
        self._secrets -= Counter(secrets)
        if not self._secrets:
            logging.setLogRecordFactory(self._make)

    def record(self, *values: Any, **named: Any) -> logging.LogRecord:
        """Return a log record without secrets."""
        record = self._make(*values, **named)
        with contextlib.suppress(TypeError, ValueError):  # the arguments do not fit the message; a handler reports this
            message = record.getMessage()
            if (safe := self._without(message)) != message:
                record.msg, record.args = safe, ()
        if record.exc_info:
            record.exc_text = self._without(self._plain.formatException(record.exc_info))
        return record

    def _without(self, text: str) -> str:
        for each in sorted(self._secrets, key=len, reverse=True):
            text = text.replace(each, HIDDEN)
        return text


censor = Censor()
"""The censor of this process. Several platforms may have secrets at the same time."""


@contextlib.contextmanager
def secret(*texts: str) -> Generator[None]:
    """Inside the ``with`` block, replace secret texts in the records of all loggers, including tracebacks.

    Texts of fewer than 8 characters are not replaced, because they may be ordinary words.
    """
    hidden = [text for text in texts if len(text) >= 8]
    if not hidden:
        yield
        return
    censor.add(hidden)
    try:
        yield
    finally:
        censor.remove(hidden)
