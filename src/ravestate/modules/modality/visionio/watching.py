"""Functions to watch a camera: open it, look at its newest picture, and handle its failures."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable, Mapping, Sequence
from typing import Any, Literal

from ravestate.errors import PlatformError

from .eye import Eye
from .frames import Frame, Frames
from .names import Settings
from .places import default_camera

AGAIN = 5.0
"""The seconds between two attempts to open a lost camera."""
MADE_UP = 0.5
"""Later looks make up for a delay of at most this many seconds. The rest of a longer delay is lost."""
FAULTS = 5
"""After this many failures in a row, the agent gives up, unless the camera is a device."""

Sleep = Callable[[float], Awaitable[None]]


class Watch:
    """A camera that the agent watches: a camera that the vision worker opens, or the camera of a platform.

    Args:
        settings: The settings of visionio.
        frames: The platform's camera; None to open the camera in the settings.
        log: The logger for faults. A repeated fault is logged only once.
    """

    def __init__(self, settings: Settings, frames: Frames | None, log: logging.Logger) -> None:
        self._settings = settings
        self._frames = frames
        self._log = log
        self._eye: Eye | None = None
        self._live = frames is not None
        self._faults = 0
        self._told = ""
        self._dark = 0
        self._silent = False
        self._due = 0.0

    @property
    def blind(self) -> bool:
        """Whether the agent sees nothing, because looks fail or the platform's camera sends no pictures."""
        return self._silent or self._faults > 0

    @property
    def skipped(self) -> int:
        """How many pictures were skipped because newer ones had come."""
        if self._frames is not None:
            return self._frames.dropped
        return self._eye.skipped if self._eye is not None else 0

    async def begin(self) -> bool:
        """Start the worker and open the camera. Return whether this worked.

        If not, the log says why, unless the setting `source` is empty.
        """
        settings = self._settings
        source = settings.source
        if self._frames is None and source == "default":
            if (found := default_camera()) is None:
                self._log.warning(
                    "visionio sees nothing: there is no camera. Name a device, a video or a folder of pictures: "
                    "--set visionio.source=PATH"
                )
                return False
            source = found
        if self._frames is None and not source:
            return False
        try:
            self._eye = Eye(settings.python)
            if self._frames is None:
                self._live = await self._eye.open(source, loop=settings.loop)
        except PlatformError as error:
            self._log.error("%s", error)
            self.close()
            return False
        return True

    async def next(self) -> Frame | bool | None:
        """Wait for the next picture of the platform's camera. The worker's own cameras need no wait.

        Returns:
            The picture of the platform's camera, or True for a camera of the worker. The result is False if the
            platform's camera has sent no picture for `gone_after` seconds, and None after the last picture.
        """
        if self._frames is not None:
            self._silent = False
            try:
                return await asyncio.wait_for(self._frames.next(), self._settings.gone_after)
            except TimeoutError:
                self._silent = True
                return False
        return None if self._eye is None or self._eye.ended else True

    async def look(
        self, want: Sequence[str], request: Mapping[str, Any], at: float, frame: Frame | Literal[True]
    ) -> dict[str, Any] | None:
        """Return the worker's answer; None if there is no new picture, or if the look failed.

        Args:
            want, request: As for `Eye.look`.
            at: The time of the wanted picture in a video or a folder (seconds since the beginning).
            frame: The picture; True for the camera of the worker.
        """
        assert self._eye is not None
        try:
            seen = await self._eye.look(want, request, at=at, frame=None if frame is True else frame)
        except PlatformError as error:
            self._faults += 1
            if str(error) != self._told:
                self._told = str(error)
                self._log.warning("%s", error)
            return None
        if seen is not None:
            if self._faults and self._live:
                self._log.info("visionio sees again")
            self._faults, self._told = 0, ""
            self._note_dark(seen["dark"])
        return seen

    async def rest(self, began: float, now: float, sleep: Sleep) -> bool:
        """Wait until the next look is due. Return whether there is a next look.

        A look is due one period (1 / `fps`) after the last look was due. So a slow look, for example a search
        for small faces, does not lower the rate. But the share of the time for looking never exceeds the setting `load`.

        Args:
            began: The time at which this look began (seconds).
            now: The time at which this look ended.
            sleep: A function that waits for some seconds on the context's clock.
        """
        assert self._eye is not None
        settings = self._settings
        if self._faults >= FAULTS and not (self._live and self._frames is None):
            self._log.error("visionio gives up after %d failures in a row: %s", self._faults, self._told)
            return False
        if self._faults and self._live and self._frames is None:
            await sleep(AGAIN)
            self._eye.reopen()
            return True
        period, work = 1.0 / settings.fps, max(0.0, now - began - self._eye.waited)
        self._due = max(self._due, began - MADE_UP) + period
        await sleep(max(self._due - now, work * (1.0 / settings.load - 1.0), 0.001))
        return True

    def close(self) -> None:
        """Release the camera and the worker."""
        if self._eye is not None:
            self._eye.close()
            self._eye = None

    def _note_dark(self, dark: bool) -> None:
        self._dark = self._dark + 1 if dark else 0
        if self._dark == round(3 * self._settings.fps):
            self._log.warning(
                "visionio: the camera's picture is black: is the lens covered, the room dark, or another program using it?"
            )
