"""The people in front of the camera, and functions that find out from faces which people come and leave."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import dist

from ravestate.modules.meta.ontology import Node
from ravestate.modules.modality.interloc import Recognised

from .face import FaceVec, Vector

WAIT = 2.5
"""A face that has been badly visible for this many seconds counts as a stranger's face."""
KEPT = 8
"""The maximum number of vectors (descriptions of a face as 128 numbers) to keep from a visit."""
ALIKE = 0.15
"""A vector that is at most this far from a kept vector shows nothing new."""


@dataclass(frozen=True, slots=True)
class Visitor:
    """A person whom the agent sees.

    Attributes:
        key: Their key in ``interloc.users``.
        node: Their node in memory. A stranger has a transient node, which is not in memory.
        known: Whether the agent knows who they are.
        since, seen: When they came, and when they were last seen (seconds on the context's clock).
        tracks: The numbers of their tracks.
        vectors: Their best vectors of this visit, each with its quality, best first.
        linked: Whether they are a user whom a platform has added.
        faces: Whether memory has their face, or the agent has asked them. If not, the agent may ask.
        mistaken: The ids of people in memory with whom the agent has confused them.
        moving: Whether they are taking the place of a platform's user. The agent removes that user for a moment.
    """

    key: str
    node: Node
    known: bool = False
    since: float = 0.0
    seen: float = 0.0
    tracks: frozenset[int] = frozenset()
    vectors: tuple[tuple[float, Vector], ...] = ()
    linked: bool = False
    faces: bool = False
    mistaken: frozenset[str] = frozenset()
    moving: bool = False

    @property
    def name(self) -> str | None:
        """Their name, if it is known."""
        return self.node.get("name")

    def good(self, least: float) -> tuple[tuple[float, Vector], ...]:
        """Return the vectors of at least this quality, each with its quality."""
        return tuple(one for one in self.vectors if one[0] >= least)

    @property
    def item(self) -> Recognised | None:
        """Their item in ``interloc.users``; None if the agent does not know who they are."""
        return Recognised(self.node["name"], self.node) if self.known and self.name else None

    def met(self, face: FaceVec, *, least: float, threshold: float) -> Visitor:
        """Return the visitor after the agent has seen their face once more.

        Args:
            face: Their face.
            least: The minimum quality of each vector after the first vector.
            threshold: The maximum distance of two vectors of the same person.
        """
        vectors = self.vectors
        if face.fresh and (not vectors or (face.quality >= least and self.resembles(face.vector, threshold))):
            vectors = best([*vectors, (face.quality, face.vector)], KEPT)
        return replace(self, seen=at(face), tracks=self.tracks | {face.track}, vectors=vectors)

    def resembles(self, vector: Vector, threshold: float) -> bool:
        """Return whether a vector is close enough to this visit's vectors to belong to the same person."""
        return any(dist(vector, one) <= threshold for _, one in self.vectors)

    def __repr__(self) -> str:
        return f"Visitor({self.key!r}, {self.name!r}, known={self.known}, tracks={sorted(self.tracks)})"


@dataclass(frozen=True, slots=True)
class Question:
    """The question to a visitor whether the agent may remember their face.

    Attributes:
        key: The visitor's key in ``interloc.users``.
        time: The time of the question (seconds on the context's clock).
        said: Whether the agent has said the question. If the agent then says something else, the question is dropped:
            a later *yes* may answer those words.
    """

    key: str
    time: float
    said: bool = False


@dataclass(frozen=True, slots=True)
class Decision:
    """The person whose face a track follows (None for a stranger), with the vectors that have decided this."""

    person: Node | None
    vectors: tuple[Vector, ...] = ()


def at(face: FaceVec) -> float:
    """Return the time of a face (seconds on the context's clock)."""
    return face.time or 0.0


def best(vectors: Iterable[tuple[float, Vector]], most: int) -> tuple[tuple[float, Vector], ...]:
    """Return the `most` vectors of the best quality. If two vectors are nearly equal, keep only the better one."""
    kept: list[tuple[float, Vector]] = []
    for quality, vector in sorted(vectors, key=lambda one: -one[0]):
        if all(dist(vector, other) > ALIKE for _, other in kept):
            kept.append((quality, vector))
    return tuple(kept[:most])


def decide(history: Sequence[FaceVec], face: FaceVec, *, sure: int, quality: float) -> Decision | None:
    """Decide whose face a track follows, when its last `sure` vectors of good quality agree. Until then, return None.

    After `WAIT` seconds without a vector of good quality, the face counts as a stranger's.

    Args:
        history: The last faces, oldest first, with `face` at the end.
        face: The newest face of the track.
        sure: The number of vectors that must agree.
        quality: The minimum quality of a vector that counts.
    """
    track = [one for one in history if one.track == face.track]
    good = [one for one in track if one.fresh and one.quality >= quality][-sure:]
    people = {one.person.id if one.person else None for one in good}
    if len(good) == sure and len(people) == 1:
        return Decision(good[-1].person, tuple(one.vector for one in good))
    if not good and track and at(face) - at(track[0]) >= WAIT:
        return Decision(None)
    return None


def whose(visitors: Mapping[str, Visitor], face: FaceVec, decision: Decision, threshold: float) -> Visitor | None:
    """Return the visitor to whom a new track belongs; None if a new person has come.

    A face that was lost for a moment gets a new track. Memory or the vectors show to which visitor this track belongs.
    """
    for visitor in visitors.values():
        if decision.person is not None and visitor.node.id == decision.person.id:
            return visitor
    near = [visitor for visitor in visitors.values() if visitor.resembles(face.vector, threshold)]
    near = [visitor for visitor in near if decision.person is None or not visitor.known]
    return min(near, key=lambda visitor: min(dist(face.vector, v) for _, v in visitor.vectors), default=None)


def of_track(visitors: Mapping[str, Visitor], track: int) -> Visitor | None:
    """Return the visitor to whom a track belongs; None if there is none."""
    return next((visitor for visitor in visitors.values() if track in visitor.tracks), None)


def in_front(visitors: Mapping[str, Visitor], history: Sequence[FaceVec]) -> Visitor | None:
    """Return the visitor with the largest face, who counts as the speaker; None if the agent sees nobody."""
    sizes = {face.track: face.box[2] * face.box[3] for face in history}
    return max(
        visitors.values(),
        key=lambda visitor: max((sizes.get(track, 0) for track in visitor.tracks), default=0),
        default=None,
    )


def gone(visitors: Mapping[str, Visitor], now: float, after: float) -> list[Visitor]:
    """Return the visitors whose faces have not been seen for `after` seconds."""
    return [visitor for visitor in visitors.values() if now - visitor.seen > after]
