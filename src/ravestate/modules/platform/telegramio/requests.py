"""Requests to the Bot API. They raise a `FloodError` if the server asks for a wait, or a `NetworkError` if it fails."""

from __future__ import annotations

import json
from typing import Any

from telegram.error import NetworkError, TelegramError
from telegram.request import HTTPXRequest

WAIT = 5.0  # how many seconds to wait if the server asks for a wait but gives no time


class FloodError(TelegramError):
    """The server asks the bot to wait for some seconds."""

    def __init__(self, seconds: float) -> None:
        super().__init__(f"too many messages: the server asks to wait {seconds:g} s")
        self.seconds = seconds


class Requests(HTTPXRequest):
    """Requests that raise a `FloodError` if the server asks for a wait. Otherwise the library would log a warning."""

    async def do_request(self, *values: Any, **named: Any) -> tuple[int, bytes]:
        """Make a request; return the status and the body of the answer."""
        code, body = await super().do_request(*values, **named)
        if code == 429:
            try:
                raise FloodError(float(json.loads(body)["parameters"]["retry_after"]))
            except (ValueError, KeyError, TypeError):
                raise FloodError(WAIT) from None
        if code >= 500:
            raise NetworkError(f"the server has failed (status {code})")
        return code, body


def wait_of(error: Exception) -> float:
    """Return the wait that the server asks for in an error (seconds); 0 if it asks for none."""
    return error.seconds if isinstance(error, FloodError) else 0.0
