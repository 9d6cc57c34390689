"""Attempts at something that may fail for a while, such as a login."""

from __future__ import annotations

import asyncio
import logging
import random

FIRST_WAIT, LONGEST_WAIT = 0.5, 60.0
"""The shortest and the longest wait between two attempts (seconds). Each wait is twice the wait before it."""

TOLD = 3
"""The number of failures in a row before the log gets a warning."""


def back_off(attempt: int) -> float:
    """Return the seconds to wait after the attempt with the number `attempt`, counted from 0, with a random part."""
    return min(LONGEST_WAIT, FIRST_WAIT * 2 ** min(attempt, 16)) * random.uniform(0.75, 1.0)


class Attempts:
    """Counts the failures of an action in a row, and waits after each failure: each time twice as long.

    Args:
        log: The logger of the platform.
        what: The failure, for the log, such as ``no updates``.
    """

    def __init__(self, log: logging.Logger, what: str) -> None:
        self._log = log
        self._what = what
        self._failures = 0

    async def fail(self, why: object, wait: float = 0.0) -> None:
        """Log a failure, and wait before the next attempt: for `wait` seconds if the messenger asks for a wait."""
        level = logging.WARNING if self._failures == TOLD else logging.INFO
        self._log.log(level, "%s: %s; trying again", self._what, why)
        seconds = wait or back_off(self._failures)
        self._failures += 1
        await asyncio.sleep(seconds)

    def succeed(self) -> None:
        """Forget the failures so far."""
        self._failures = 0
