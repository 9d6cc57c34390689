"""Attempts at something that may fail for a while, such as a login."""

from __future__ import annotations

import asyncio
import logging
import random

FIRST_WAIT, LONGEST_WAIT = 0.5, 60.0
"""The seconds before the second attempt, and before the later ones at most. Each wait is twice the one before."""

TOLD = 3
"""The failures in a row that are not worth a warning."""


def back_off(attempt: int) -> float:
    """Return the seconds to wait after attempt number `attempt`, the first being 0; chance spreads the attempts."""
    return min(LONGEST_WAIT, FIRST_WAIT * 2 ** min(attempt, 16)) * random.uniform(0.75, 1.0)


class Attempts:
    """Attempts at something. Each failure in a row waits twice as long as the one before.

    Args:
        log: The logger of the platform.
        what: The failure, for the log, such as ``no updates``.
    """

    def __init__(self, log: logging.Logger, what: str) -> None:
        self._log = log
        self._what = what
        self._failures = 0

    async def fail(self, why: object, wait: float = 0.0) -> None:
        """Log a failure, and wait before the next attempt: for `wait` seconds if the messenger has set them."""
        level = logging.WARNING if self._failures == TOLD else logging.INFO
        self._log.log(level, "%s: %s; trying again", self._what, why)
        seconds = wait or back_off(self._failures)
        self._failures += 1
        await asyncio.sleep(seconds)

    def succeed(self) -> None:
        """Forget the failures so far."""
        self._failures = 0
