"""Read and write movements: files with the landmarks (points) of a body over time, and the folder of taught activities.

A file of landmarks is a numpy archive (``.npz``) with ``times`` (T,) in seconds and ``points`` (T, 33, 4), see `Pose`.
The optional ``name`` is the activity's name. The folder of taught activities has one such file for each demonstration,
and no pictures.
"""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from ravestate.errors import PlatformError
from ravestate.folders import replace_file, user_folder

from .pose import Pose
from .recogniser import Recogniser, numpy

SUFFIX = ".npz"
LONGEST = 100
"""The maximum number of characters of an activity's name."""


def folder_of(folder: Path | None) -> Path:
    """Return the folder of taught activities: `folder`, or by default one in the user's data folder."""
    return user_folder("data") / "activities" if folder is None else folder.expanduser()


def read(file: Path) -> tuple[str, tuple[Pose, ...]]:
    """Return the activity's name (may be empty) and the poses in a file of landmarks.

    Raises:
        PlatformError: The file cannot be read, or is not a file of landmarks.
    """
    np = numpy()
    try:
        with np.load(file, allow_pickle=False) as data:
            times = np.asarray(data["times"], dtype=float)
            points = data["points"]
            name = str(data["name"]) if "name" in data else ""
    except OSError as error:
        raise PlatformError(f"activity: {file} cannot be read: {error.strerror or error}") from None
    except (KeyError, ValueError, EOFError, AttributeError, TypeError, zipfile.BadZipFile) as error:
        raise PlatformError(
            f"activity: {file} is not a file of landmarks ({error}): "
            "it must be an .npz file with times (T,) and points (T, 33, 4)"
        ) from None
    if times.ndim != 1 or len(times) != len(points):
        raise PlatformError(f"activity: {file} has {times.size} times for {len(points)} poses: give one for each")
    return name, tuple(Pose(float(at), one) for at, one in zip(times, points, strict=True))


def write(file: Path, poses: Sequence[Pose], name: str = "") -> None:
    """Write poses into a file of landmarks. The times in the file begin at 0.

    Raises:
        PlatformError: The file cannot be written.
    """
    np = numpy()
    times = np.array([pose.at - poses[0].at for pose in poses])
    points = np.stack([pose.points for pose in poses]).astype(np.float32)
    content = io.BytesIO()
    np.savez_compressed(content, times=times, points=points, name=np.array(name))
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        replace_file(file, content.getvalue())
    except OSError as error:
        raise PlatformError(f"activity: {file} cannot be written: {error.strerror or error}") from None


def taught_in(folder: Path, known: Recogniser) -> Iterator[tuple[Path, str]]:
    """Teach a recogniser all demonstrations in a folder. Yield each file that it cannot learn, with the reason."""
    for file in sorted(folder.glob(f"*{SUFFIX}")):
        try:
            name, poses = read(file)
        except PlatformError as error:
            yield file, str(error)
            continue
        if not known.teach(name or file.stem, poses):
            yield file, "it shows too little of a body"


def files_of(folder: Path) -> dict[str, list[Path]]:
    """Return the activities in a folder of taught activities: name → files. Skip damaged files."""
    found: dict[str, list[Path]] = {}
    for file in sorted(folder.glob(f"*{SUFFIX}")):
        try:
            name = clean(read(file)[0] or file.stem)
        except PlatformError:
            continue
        found.setdefault(name, []).append(file)
    return found


def keep(folder: Path, name: str, poses: Sequence[Pose]) -> Path:
    """Write a demonstration of an activity to a new file in the folder. Return the file.

    Raises:
        PlatformError: The file cannot be written.
    """
    stem = re.sub(r"[^\w]+", "-", name.lower()).strip("-") or "activity"
    stem = stem.encode()[:LONGEST].decode(errors="ignore")  # most file systems limit a name to 255 bytes
    number = 1
    while (file := folder / f"{stem}-{number}{SUFFIX}").exists():
        number += 1
    write(file, poses, name)
    return file


def clean(name: str) -> str:
    """Return the spoken form of an activity's name: ``Playing_Guitar`` becomes ``playing guitar``."""
    return " ".join(name.replace("_", " ").split()).lower()[:LONGEST]
