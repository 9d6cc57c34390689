"""A file for the log of a chat on a terminal, so that no log line appears between the lines of the chat."""

from __future__ import annotations

import contextlib
import logging
import os
import sys
from collections.abc import Generator
from logging.handlers import RotatingFileHandler
from pathlib import Path

from ravestate.folders import user_folder

LARGEST = 1_000_000  # when the log file reaches this size in bytes, a new one begins; one old file is kept


def log_file() -> Path:
    """Return the path of the log file for chats, in the user's state folder."""
    return user_folder("state") / "log"


@contextlib.contextmanager
def log_to_file(file: Path) -> Generator[None]:
    """Inside the ``with`` block, write the log to a file if the chat and the log would share a terminal.

    After the block, the log goes where it went before. If the file got warnings or errors, a line on standard error
    names the file. If standard output or standard error is redirected, or the file cannot be opened, the log is not
    moved. While the disk is full, the newest lines of the log may be lost.
    """
    if not all(stream is not None and stream.isatty() for stream in (sys.stdout, sys.stderr)):
        yield
        return
    try:
        file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        os.close(os.open(file, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600))  # readable only by the user
        handler = _LogFile(file, maxBytes=LARGEST, backupCount=1, encoding="utf-8", errors="replace")
    except OSError:
        yield
        return
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(name)s: %(message)s"))
    warnings = 0

    def count(record: logging.LogRecord) -> bool:
        nonlocal warnings
        warnings += record.levelno >= logging.WARNING
        return True

    handler.addFilter(count)
    root, stderr = logging.getLogger(), sys.stderr
    replaced = [other for other in root.handlers if _writes_to_terminal(other)]
    for other in replaced:
        root.removeHandler(other)
    root.addHandler(handler)
    try:
        yield
    finally:
        root.removeHandler(handler)
        with contextlib.suppress(OSError):  # a full disk
            handler.close()
        for other in replaced:
            root.addHandler(other)
        if warnings:
            print(f"The log of this chat has {warnings} warning{'s'[: warnings > 1]}: {file}", file=stderr)


class _LogFile(RotatingFileHandler):
    """A log file that prints nothing on the terminal of the chat if the file cannot be written.

    It hides only an `OSError`. Other errors, such as a log message with wrong arguments, are printed.
    """

    def handleError(self, record: logging.LogRecord) -> None:
        if not isinstance(sys.exc_info()[1], OSError):
            super().handleError(record)


def _writes_to_terminal(handler: logging.Handler) -> bool:
    stream = getattr(handler, "stream", None)
    return stream is not None and stream.isatty()
