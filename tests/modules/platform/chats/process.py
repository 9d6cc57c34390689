"""An agent on a messenger, in a separate process."""

import asyncio
import contextlib
import os
import signal
import sys


class AgentProcess:
    """An agent in a separate process. ``async with`` starts the process, and kills it at the end.

    Args:
        platform: The name of the platform.
        module: The other module of the agent, as on the command line.
        settings: The settings of the platform, passed as environment variables.
    """

    def __init__(self, platform: str, module: str, **settings: object) -> None:
        self._command = [sys.executable, "-m", "ravestate", "run", platform, module]
        names = {name: f"RAVESTATE_{platform}_{name}".upper() for name in settings}
        self._environment = {**os.environ, **{names[name]: str(value) for name, value in settings.items()}}
        self.process: asyncio.subprocess.Process | None = None

    async def __aenter__(self) -> "AgentProcess":
        await self.start()
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.kill()

    async def start(self) -> None:
        self.process = await asyncio.create_subprocess_exec(*self._command, env=self._environment)

    async def kill(self) -> None:
        await self.end(signal.SIGKILL)

    async def end(self, signal: signal.Signals) -> int:
        """Send a signal to the process, and return its exit code."""
        assert self.process is not None
        with contextlib.suppress(ProcessLookupError):
            self.process.send_signal(signal)
        return await self.process.wait()
