"""A function that loads the library of a messenger on its first use."""

from __future__ import annotations

import asyncio
import importlib

from ravestate.errors import PlatformError


async def library(platform: str, package: str, extra: str) -> None:
    """Import the package that a platform needs, in a thread, because the import is slow.

    Args:
        platform: The name of the platform in the error, for example ``telegramio``.
        package: The package to import.
        extra: The extra of Ravestate that installs the package.

    Raises:
        PlatformError: The package is missing; the message says how to get it.
    """
    try:
        await asyncio.to_thread(importlib.import_module, package)
    except ImportError as error:
        raise PlatformError(f"{platform} needs {error.name}: pip install 'ravestate[{extra}]'") from error
