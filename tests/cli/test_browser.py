"""A command opens its page in a browser, unless the session has no screen or the user wants no browser."""

import asyncio
import sys
import webbrowser

import pytest

from ravestate.cli import browser


@pytest.mark.parametrize(
    ("wanted", "terminal", "display", "opens"),
    [
        (None, True, "DISPLAY", True),
        (None, True, "WAYLAND_DISPLAY", True),
        (None, True, "", False),
        (None, False, "DISPLAY", False),
        (True, False, "", True),
        (False, True, "DISPLAY", False),
    ],
)
def test_a_page_opens_if_the_user_wants_it_or_by_default_if_the_session_has_a_screen(
    wanted: bool | None, terminal: bool, display: str, opens: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[str] = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setattr(sys.stdout, "isatty", lambda: terminal)
    for variable in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(variable, raising=False)
    if display:
        monkeypatch.setenv(display, ":0")
    asyncio.run(browser.open_page("http://127.0.0.1:8421", wanted))
    assert opened == (["http://127.0.0.1:8421"] if opens else [])
