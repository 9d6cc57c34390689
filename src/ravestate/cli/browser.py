"""The option ``--browser`` of commands with a page: whether to open the page in a browser."""

from __future__ import annotations

import argparse
import asyncio
import os
import sys
import webbrowser


def add_argument(parser: argparse.ArgumentParser) -> None:
    """Add the options ``--browser`` and ``--no-browser``. Without them, `browser` is None."""
    parser.add_argument(
        "--browser",
        action=argparse.BooleanOptionalAction,
        default=None,
        help="open a browser; the default if the session has a screen",
    )


async def open_page(address: str, wanted: bool | None) -> None:
    """Open a page in a browser if this is wanted; if `wanted` is None, if the session has a screen."""
    if wanted or (wanted is None and _has_screen()):
        await asyncio.to_thread(webbrowser.open, address)


def _has_screen() -> bool:
    """Return whether this session has a terminal, and a screen for a browser."""
    if not sys.stdout.isatty():
        return False
    return sys.platform in ("darwin", "win32") or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
