"""Keeping secrets out of the log: libraries write addresses that contain a token."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Generator
from typing import Any

HIDDEN = "[secret]"


@contextlib.contextmanager
def secret(*texts: str) -> Generator[None]:
    """Replace secret texts in all log records that any logger makes in the body, tracebacks included."""
    hidden = sorted((text for text in texts if len(text) >= 8), key=len, reverse=True)
    make = logging.getLogRecordFactory()
    plain = logging.Formatter()

    def without(text: str) -> str:
        for each in hidden:
            text = text.replace(each, HIDDEN)
        return text

    def make_without(*values: Any, **named: Any) -> logging.LogRecord:
        record = make(*values, **named)
        with contextlib.suppress(TypeError, ValueError):  # the wrong arguments of the message; a handler reports them
            message = record.getMessage()
            if (safe := without(message)) != message:
                record.msg, record.args = safe, ()
        if record.exc_info:
            record.exc_text = without(plain.formatException(record.exc_info))
        return record

    logging.setLogRecordFactory(make_without)
    try:
        yield
    finally:
        logging.setLogRecordFactory(make)
