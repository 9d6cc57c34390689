"""Find the poses in a video file, with the vision worker of `visionio`, a separate process."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

from ravestate.errors import PlatformError

from .files import SUFFIX, read
from .pose import Pose, pose_of

RATE = 12.0
"""How many pictures to look at per second of video."""


def poses_in(file: Path, python: Path | None = None, progress: Callable[[float], None] = lambda _: None) -> list[Pose]:
    """Return the poses in a file of landmarks (``.npz``) or a video.

    Args:
        file: The file.
        python: The interpreter of the vision worker, for a video; by default, `visionio` finds it.
        progress: A function to call before each picture of the video, with the picture's time (seconds).

    Raises:
        PlatformError: The file cannot be read, or the vision worker is missing.
    """
    if file.suffix.lower() == SUFFIX:
        return list(read(file)[1])
    if not file.is_file():
        raise PlatformError(f"activity: there is no file {file}")
    return asyncio.run(_watched(file, python, progress))


async def _watched(file: Path, python: Path | None, progress: Callable[[float], None]) -> list[Pose]:
    from ravestate.modules.modality.visionio.eye import Eye

    poses: list[Pose] = []
    eye = Eye(python)
    try:
        await eye.open(str(file))
        number = 0
        while not eye.ended:
            at = number / RATE
            progress(at)
            seen = await eye.look(["pose"], {}, at=at)
            if seen is not None and seen.get("pose"):
                poses.append(pose_of(seen["pose"], at, *seen["picture"]))
            number += 1
    finally:
        eye.close()
    return poses
