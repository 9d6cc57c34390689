"""Count the failures of an operation that may fail for a while, for example a login, and wait after each failure."""

from __future__ import annotations

import asyncio
import logging
import random

FIRST_WAIT, LONGEST_WAIT = 0.5, 60.0
"""The first and the longest wait between two attempts (seconds). Until the longest wait, each wait is about twice as
long as the wait before it."""

TOLD = 3
"""After this many failures in a row, the next failure is logged as a warning."""


def back_off(attempt: int) -> float:
    """Return how many seconds to wait after the attempt with index `attempt` (from 0). The result has a random part."""
    return min(LONGEST_WAIT, FIRST_WAIT * 2 ** min(attempt, 16)) * random.uniform(0.75, 1.0)


class Attempts:
    """Counts the consecutive failures of an operation. Each wait is about twice as long as before, up to a minute.

    Args:
        log: The logger of the platform.
        what: The log's words for the failure, for example ``no updates``.
    """

    def __init__(self, log: logging.Logger, what: str) -> None:
        self._log = log
        self._what = what
        self._failures = 0

    async def fail(self, why: object, wait: float = 0.0) -> None:
        """Log a failure, and wait before the next attempt.

        Args:
            why: The reason, for the log.
            wait: The wait that the messenger asks for (seconds). If it is 0, the wait comes from `back_off`.
        """
        level = logging.WARNING if self._failures == TOLD else logging.INFO
        self._log.log(level, "%s: %s; trying again", self._what, why)
        seconds = wait or back_off(self._failures)
        self._failures += 1
        await asyncio.sleep(seconds)

    def succeed(self) -> None:
        """Forget the failures so far."""
        self._failures = 0
