"""The access check: the host names of the page, the web sites that may connect to it or embed it, and the token."""

from __future__ import annotations

import asyncio
import hmac
import ipaddress
from collections.abc import Mapping
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from .fields import ProtocolError
from .names import ORIGIN

if TYPE_CHECKING:
    from .names import Settings

PAUSE = 1.0  # the server waits this many seconds before it refuses a wrong token, so that guessing is slow


def is_local(host: str) -> bool:
    """Return whether only this machine can reach a server that listens on `host`."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False


class Access:
    """Checks each request before the server answers it.

    A page that only this machine can reach needs no token. So any site that is open in this machine's browser could
    talk to it. Two checks prevent that. Against DNS rebinding, a server without a token answers only requests for the
    names of this machine and of the origins in the settings. And any server accepts requests of web sites only from its
    own origin and from the origins in the settings. All methods expect header names in lower case.
    """

    def __init__(self, settings: Settings) -> None:
        self._token = settings.token.get_secret_value() if settings.token else None
        self._host = settings.host
        self.origins: tuple[str, ...] = settings.origins
        self._named = {urlsplit(origin).netloc for origin in settings.origins}

    def refusal(self, headers: Mapping[str, str]) -> str | None:
        """Return why the server refuses a request with these headers; None if it accepts the request."""
        host = headers.get("host", "").lower()
        name = _name_of(host)
        ours = host in self._named or is_local(name) or name == self._host.lower()
        if not ours and self._token is None:
            return f"this page is not known as {host!r}: add its origin to the setting webio.origins, or set a token"
        origin = headers.get("origin", "").lower()
        if origin and not self._may_show(origin, host):
            return f"{origin!r} may not connect: add it to the setting webio.origins"
        return None

    def refusal_of_board(self, headers: Mapping[str, str]) -> str | None:
        """Return why a request may not reach the board (Raveboard); None if it may.

        A page of another site may not reach the board.
        """
        origin, host = headers.get("origin", "").lower(), headers.get("host", "").lower()
        if origin and not _is_own(origin, host):
            return (
                f"{origin!r} may not inspect the agent; only the agent's own page at {host!r} may: open that page, "
                "or make the proxy in front of it pass on the Host header"
            )
        return None

    def foreign_embedder(self, headers: Mapping[str, str]) -> str | None:
        """Return the origin of the site that tries to embed the page without permission; None if no site tries.

        Browsers send ``Sec-Fetch-Dest`` only over HTTPS or to this machine. They send ``Referer`` because widget.js asks
        for it.
        """
        if headers.get("sec-fetch-dest") not in ("iframe", "frame"):
            return None
        found = ORIGIN.match(headers.get("referer", "").lower())
        if found is None or self._may_show(found[0], headers.get("host", "").lower()):
            return None
        return found[0]

    def _may_show(self, origin: str, host: str) -> bool:
        return _is_own(origin, host) or origin in self.origins

    def admits(self, token: str | None) -> bool:
        """Return whether a token is right, or no token is needed. The check takes the same time for any token."""
        return self._token is None or hmac.compare_digest(
            (token or "").encode("utf-8", "replace"), self._token.encode("utf-8", "replace")
        )

    async def check_token(self, token: str | None) -> None:
        """Raise a `ProtocolError` if the token is wrong (after a pause) or missing."""
        if not self.admits(token):
            if token:
                await asyncio.sleep(PAUSE)
            raise ProtocolError("token", "the token is wrong" if token else "a token is needed")


def _is_own(origin: str, host: str) -> bool:
    """Return whether an origin belongs to the requested host itself."""
    return origin.partition("://")[2] == host


def _name_of(host: str) -> str:
    """Return the host's name in a Host header, without the port; empty if the header is invalid."""
    try:
        return urlsplit(f"//{host}").hostname or ""
    except ValueError:
        return ""
