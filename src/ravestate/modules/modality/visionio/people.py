"""Functions that store, find and forget faces in memory. Memory has faces only of people who agreed, and faces
that ``ravestate vision learn`` stored.

A stored face is a vector: 128 numbers that identify the person.
"""

from __future__ import annotations

import base64
import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from math import dist

from ravestate.modules.meta.ontology import Graph, Node

from .face import NUMBERS, Vector
from .visitors import ALIKE

RELATION = "has_face"
"""The relation from a person to their faces."""
MERGE = 0.45
"""Two faces whose vectors are at most this far apart surely belong to one person. If two people in memory have the same
name, and faces this near to each other, memory merges them."""
MARGIN = 0.05
"""If the distances to the two most similar people differ by at most this much, the agent recognises neither person."""


@dataclass(frozen=True, slots=True)
class Nearest:
    """The person with the nearest stored face, and the Euclidean distance."""

    person: Node
    distance: float


def nearest(graph: Graph, vector: Sequence[float], threshold: float) -> Nearest | None:
    """Return the person with the nearest vector.

    Return None if nobody is within `threshold`, or if a second person is about as near (`MARGIN`).
    """
    faces = stored(graph)
    ranked = sorted((dist(vector, known), number) for number, (_, known) in enumerate(faces))
    if not ranked or ranked[0][0] > threshold:
        return None
    distance, first = ranked[0]
    person = owner(graph, faces[first][0])
    for other, number in ranked[1:]:
        if other > distance + MARGIN:
            break
        rival = owner(graph, faces[number][0])
        if person is None or (rival is not None and rival.id != person.id):
            return None
    return Nearest(person, distance) if person is not None else None


def least(graph: Graph, vector: Sequence[float]) -> float | None:
    """Return the distance to the nearest face in memory; None if memory has no faces."""
    return min((dist(vector, known) for _, known in stored(graph)), default=None)


def stored(graph: Graph) -> list[tuple[Node, Vector]]:
    """Return all faces in memory with their vectors, oldest first, without damaged faces."""
    return [
        (node, vector) for node in graph.find("Face", {}) if (vector := unpacked(node.get("vector", ""))) is not None
    ]


def owner(graph: Graph, face: Node) -> Node | None:
    """Return the person to whom a face belongs."""
    return next(iter(graph.related(face, RELATION, back=True)), None)


def faces_of(graph: Graph, person: Node) -> list[Node]:
    """Return a person's faces in memory, oldest first."""
    return graph.related(person, RELATION)


def has_faces(graph: Graph, person: Node) -> bool:
    """Return whether memory has a face of a person."""
    return graph.get(person.id) is not None and bool(faces_of(graph, person))


def keep(graph: Graph, person: Node, vectors: Iterable[tuple[float, Vector]], most: int) -> tuple[Node, int]:
    """Store a person's vectors in memory. Merge other people with the same name and face into this person.

    Args:
        graph: The memory.
        person: The person. If their node is not in memory yet, it is saved.
        vectors: Vectors with their qualities. The function leaves out vectors that are almost the same as stored ones.
        most: The maximum number of vectors to keep. The oldest vectors are removed.

    Returns:
        The person's node, and the number of vectors that were stored.
    """
    vectors = list(vectors)
    person = graph.save(person)
    for double in doubles(graph, person, [vector for _, vector in vectors]):
        person = graph.merge(person, double)
    present = faces_of(graph, person)
    known = [vector for face in present if (vector := unpacked(face.get("vector", ""))) is not None]
    filed = 0
    for quality, vector in vectors:
        if any(dist(vector, one) <= ALIKE for one in known):
            continue
        values = {"vector": packed(vector), "quality": round(quality, 3), "seen_at": datetime.now(UTC)}
        face = graph.save(Node("Face", values))
        graph.relate(person, RELATION, face, {})
        present.append(face)
        known.append(vector)
        filed += 1
    for face in present[: max(0, len(present) - most)]:
        graph.unrelate(person, RELATION, face, forget=True)
    return person, filed


def doubles(graph: Graph, person: Node, vectors: Sequence[Vector]) -> list[Node]:
    """Return the people in memory, other than `person`, who have the same name and the same face."""
    name = str(person.get("name", "")).casefold()
    found: dict[str, Node] = {}
    for face, known in stored(graph):
        if name and any(dist(vector, known) <= MERGE for vector in vectors):
            other = owner(graph, face)
            if other is not None and other.id != person.id and str(other.get("name", "")).casefold() == name:
                found[other.id] = other
    return list(found.values())


def forget_faces(graph: Graph, person: Node) -> int:
    """Remove a person's faces from memory. Return how many there were. The memory file keeps no bytes of them."""
    faces = faces_of(graph, person) if graph.get(person.id) is not None else []
    for face in faces:
        graph.forget(face)
    return len(faces)


def take_away(graph: Graph, person: Node, vectors: Sequence[Vector]) -> int:
    """Remove from a person the stored faces that surely belong to another person. Return how many there were.

    Args:
        graph: The memory.
        person: The person to whom memory wrongly gives these faces.
        vectors: The vectors of the other person's face.
    """
    faces = faces_of(graph, person) if graph.get(person.id) is not None else []
    wrong = [
        face
        for face in faces
        if (known := unpacked(face.get("vector", ""))) is not None and any(dist(known, one) <= MERGE for one in vectors)
    ]
    for face in wrong:
        graph.forget(face)
    return len(wrong)


def packed(vector: Sequence[float]) -> str:
    """Return a vector as text: base64 of single-precision numbers, little-endian."""
    return base64.b64encode(struct.pack(f"<{NUMBERS}f", *vector)).decode()


def unpacked(text: str) -> Vector | None:
    """Return the vector in a text; None if the text is damaged."""
    try:
        return struct.unpack(f"<{NUMBERS}f", base64.b64decode(text, validate=True))
    except (ValueError, struct.error):
        return None
