"""Tracks. A track follows a face from picture to picture, and decides when the face needs a new vector.

A vector describes a face as 128 numbers.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ravestate.modules.meta.ontology import Node

from .face import Box, Look, Vector

LOST = 1.5
"""If a face is not found for this many seconds, its track ends."""
REFRESH = 3.0
"""After enough vectors of a face agree, the face gets a new vector at this interval (seconds), because two people may
have changed places."""
TRIES = 10
"""If the vectors of a face do not agree after this many vectors, the face gets only one new vector per second."""
THOROUGH = 1.0
"""The seconds between two thorough searches of a picture, which find small faces."""


@dataclass(slots=True)
class Track:
    """A face that the agent follows.

    Attributes:
        number: The track's number.
        box: The last place of the face.
        seen: The time at which the face was seen last (seconds).
        vector: The newest vector; None before the first vector.
        quality: The visibility of the face for this vector.
        encoded: The time of this vector.
        tries: The number of vectors so far.
        person: The nearest person in memory; None if nobody is near enough.
        distance: The distance to this person's nearest stored vector; None without a person.
        agreed: The number of good vectors in a row that agree about the person.
    """

    number: int
    box: Box
    seen: float
    vector: Vector | None = None
    quality: float = 0.0
    encoded: float = float("-inf")
    tries: int = 0
    person: Node | None = None
    distance: float | None = None
    agreed: int = 0

    def __repr__(self) -> str:
        return f"Track({self.number}, box={self.box}, quality={self.quality})"

    def fresh(self, now: float, sure: int) -> bool:
        """Return whether the newest vector is fresh enough, so that the face needs no new one now."""
        wait = REFRESH if self.agreed >= sure else 1.0 if self.tries >= TRIES else 0.0
        return now - self.encoded < wait

    def recognise(self, person: Node | None, distance: float | None, quality: float) -> None:
        """Note the person to whom the newest vector belongs.

        Args:
            person: The nearest person in memory; None if nobody is near enough.
            distance: The distance to this person's nearest stored vector; None without a person.
            quality: The minimum quality of a vector that counts.
        """
        same = (self.person and self.person.id) == (person and person.id)
        if self.quality >= quality:
            self.agreed = self.agreed + 1 if same else 1
        self.person, self.distance = person, distance


@dataclass(frozen=True, slots=True, eq=False)
class Sighting:
    """The faces in a picture.

    Attributes:
        look: The picture's time and size.
        faces: The track of each face, and whether the track's vector comes from this picture.
    """

    look: Look
    faces: tuple[tuple[Track, bool], ...]

    def __repr__(self) -> str:
        return f"Sighting({self.look}, faces={[track.box for track, _ in self.faces]})"


@dataclass(slots=True)
class Tracks:
    """The faces that the agent follows.

    Attributes:
        sure: The number of vectors in a row that must agree before the agent decides whose face it is.
    """

    sure: int = 3
    _tracks: dict[int, Track] = field(default_factory=dict[int, Track])
    _last: int = 0
    _thorough: float = float("-inf")

    def request(self, now: float) -> dict[str, Any]:
        """Return the tracks for the vision worker's next look. End the tracks of faces that were lost for too long."""
        self._lose(now)
        known = [
            {"track": one.number, "box": list(one.box), "fresh": one.fresh(now, self.sure)}
            for one in self._tracks.values()
        ]
        return {"known": known, "thorough": int(now - self._thorough >= THOROUGH)}

    def update(self, faces: Iterable[Mapping[str, Any]], now: float) -> list[tuple[Track, bool]]:
        """Find or make the tracks for the faces of a picture. Return each track, and whether it has a new vector."""
        if now - self._thorough >= THOROUGH:
            self._thorough = now
        found: list[tuple[Track, bool]] = []
        for face in faces:
            box: Box = tuple(face["box"])
            track = self._tracks.get(face["track"])
            if track is None:
                self._last += 1
                track = self._tracks[self._last] = Track(self._last, box, now)
            track.box, track.seen = box, now
            if face["vector"] is not None:
                track.vector, track.quality = tuple(face["vector"]), face["quality"]
                track.encoded, track.tries = now, track.tries + 1
            found.append((track, face["vector"] is not None))
        self._lose(now)
        return found

    def _lose(self, now: float) -> None:
        for one in [one for one in self._tracks.values() if now - one.seen > LOST]:
            del self._tracks[one.number]
