"""The files that users send: pictures and voice notes."""

from __future__ import annotations

import asyncio

from .attempts import back_off
from .messages import Carrier, DeliveryError

FETCHES = 4
"""The maximum number of attempts to fetch a file."""


async def fetched(carrier: Carrier, file: str) -> bytes:
    """Return the bytes of a file; try again after failures.

    Raises:
        DeliveryError: The messenger will never deliver the file, for example because it is too big, or all attempts have
            failed.
    """
    for attempt in range(FETCHES):
        try:
            return await carrier.fetch(file)
        except DeliveryError as error:
            if error.final or attempt == FETCHES - 1:
                raise
            await asyncio.sleep(error.wait or back_off(attempt))
    raise AssertionError("the last attempt raises")
