"""Who may come in: which hosts the page answers to, which web sites may connect and embed it, and the token."""

from __future__ import annotations

import asyncio
import hmac
import ipaddress
from collections.abc import Mapping
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from .names import ORIGIN
from .protocol import ProtocolError

if TYPE_CHECKING:
    from .names import Settings

__all__ = ["Access", "is_local"]

PAUSE = 1.0
"""Seconds after which a wrong token is refused, so that guessing takes long."""


def is_local(host: str) -> bool:
    """Whether an address to listen on is this machine's own, which others cannot reach."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False


class Access:
    """The checks before anything is served.

    A page of this machine's own needs no token, so anything that this machine's browser shows could talk to it. Hence it
    answers only to names of this machine, which keeps out a web site whose name was made to point here (DNS rebinding),
    and only to pages that it has served itself, or whose origin the settings name.

    Args:
        settings: Those of ``webio``.
    """

    def __init__(self, settings: Settings) -> None:
        self._token = settings.token.get_secret_value() if settings.token else None
        self._host = settings.host
        self.origins: tuple[str, ...] = settings.origins
        self._named = {urlsplit(origin).netloc for origin in settings.origins}

    def refusal(self, headers: Mapping[str, str]) -> str | None:
        """Why a request is refused; None if it is not.

        Args:
            headers: Those of the request, names in small letters.
        """
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
        """Why a request that `refusal` lets in may not look inside of the agent, as only the page itself may; else None.

        Args:
            headers: Those of the request, names in small letters.
        """
        origin, host = headers.get("origin", "").lower(), headers.get("host", "").lower()
        if origin and not _is_own(origin, host):
            return (
                f"{origin!r} may not look inside of the agent, which only its own page at {host!r} does: open that, "
                "or let the proxy before it hand on the Host header"
            )
        return None

    def foreign_embedder(self, headers: Mapping[str, str]) -> str | None:
        """The origin of a page that wants to show this one in a frame, which the browser will not let it; else None.

        Browsers send what tells it over HTTPS and to this machine; widget.js lets them.

        Args:
            headers: Those of the request, names in small letters.
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
        """Whether a token is right, or none is needed. It takes as long whichever character is wrong."""
        return self._token is None or hmac.compare_digest(
            (token or "").encode("utf-8", "replace"), self._token.encode("utf-8", "replace")
        )

    async def check_token(self, token: str | None) -> None:
        """Refuse a wrong token, after a while.

        Raises:
            ProtocolError: It is wrong.
        """
        if not self.admits(token):
            if token:
                await asyncio.sleep(PAUSE)
            raise ProtocolError("token", "the token is wrong" if token else "a token is needed")


def _is_own(origin: str, host: str) -> bool:
    """Whether a page was served under the name that is asked for."""
    return origin.partition("://")[2] == host


def _name_of(host: str) -> str:
    """The name in a Host header, without the port."""
    try:
        return urlsplit(f"//{host}").hostname or ""
    except ValueError:
        return ""
