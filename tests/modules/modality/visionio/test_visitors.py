"""Decisions: whose face does a track show, and to which visitor does the track belong?"""

import pytest

from ravestate.errors import PlatformError
from ravestate.modules.meta.ontology import Node
from ravestate.modules.modality.visionio.face import FaceVec
from ravestate.modules.modality.visionio.visitors import (
    WAIT,
    Decision,
    Visitor,
    best,
    decide,
    gone,
    in_front,
    of_track,
    whose,
)

REST = (0.0,) * 127
"""All vectors here are equal except for their first number."""
ADA, BOB = Node("Person", {"name": "Ada"}), Node("Person", {"name": "Bob"})


def face(
    x: float, person: Node | None = None, *, track: int = 1, quality: float = 1.0, time: float = 0.0, size: int = 50
) -> FaceVec:
    return FaceVec((x, *REST), (0, 0, size, size), track, person, None, quality, True, time)


@pytest.mark.parametrize(
    ("vector", "found"),
    [((0.1,) * 127, "127 numbers"), ((), "0 numbers"), ((float("nan"), *REST), "a number that is not finite")],
)
def test_a_face_needs_128_finite_numbers(vector: tuple[float, ...], found: str) -> None:
    """Distances to any other vector would be meaningless, so each face would be a new visitor's."""
    with pytest.raises(PlatformError, match=f"has {found}: give it 128 finite numbers"):
        FaceVec(vector, (0, 0, 50, 50), 1)


def decided(*faces: FaceVec) -> Decision | None:
    return decide(faces, faces[-1], sure=3, quality=0.3)


def test_a_decision_needs_three_vectors_in_a_row_that_agree() -> None:
    assert decided(face(0, ADA), face(0, ADA)) is None
    assert decided(face(0), face(0, ADA), face(0, ADA)) is None
    assert decided(face(0, BOB), face(0, ADA), face(0, BOB), face(0, ADA)) is None
    assert (sure := decided(face(0), face(0, ADA), face(0, ADA), face(0, ADA))) is not None and sure.person is ADA
    assert (nobody := decided(face(0), face(0), face(0))) is not None and nobody.person is None


def test_vectors_of_other_tracks_and_of_low_quality_do_not_count_for_a_decision() -> None:
    assert decided(face(0, ADA), face(0, ADA, track=2), face(0, ADA)) is None
    assert decided(face(0, ADA), face(0, ADA, quality=0.1), face(0, ADA)) is None


def test_a_face_that_is_never_clearly_visible_counts_as_unknown_after_a_while() -> None:
    bad = [face(0, ADA, quality=0.1, time=t) for t in (0.0, 1.0, WAIT)]
    assert decided(*bad[:2]) is None
    assert (nobody := decided(*bad)) is not None and nobody.person is None


def test_a_visitor_keeps_the_best_of_similar_vectors() -> None:
    one = Visitor("a", ADA)
    for x, quality in ((0.0, 0.5), (0.01, 0.9), (0.3, 0.4), (0.5, 0.1), (0.9, 0.9)):
        one = one.met(face(x, quality=quality), least=0.3, threshold=0.5)
    # The visitor keeps neither 0.5, which was hardly visible, nor 0.9, which is another face.
    assert one.vectors == ((0.9, (0.01, *REST)), (0.4, (0.3, *REST)))
    assert one.good(0.5) == ((0.9, (0.01, *REST)),)
    assert best([(0.1 * n, (float(n),)) for n in range(20)], 3) == (
        (0.1 * 19, (19.0,)),
        (0.1 * 18, (18.0,)),
        (0.1 * 17, (17.0,)),
    )


def test_a_new_track_is_assigned_to_a_visitor_by_memory_or_by_its_vectors() -> None:
    ada = Visitor("a", ADA, known=True, vectors=((1.0, (0.0, *REST)),))
    stranger = Visitor("s", Node("Person"), vectors=((1.0, (0.4, *REST)),))
    here = {"a": ada, "s": stranger}
    assert whose(here, face(3.0), Decision(ADA), 0.5) is ada
    assert whose(here, face(0.35), Decision(None), 0.5) is stranger
    assert whose(here, face(0.1), Decision(None), 0.5) is ada
    assert whose(here, face(0.3), Decision(BOB), 0.5) is stranger  # the stranger is recognised only now
    assert whose(here, face(3.0), Decision(None), 0.5) is None


def test_visitors_are_found_by_track_by_distance_to_the_camera_and_by_absence() -> None:
    far = Visitor("f", ADA, seen=1.0, tracks=frozenset({1}))
    near = Visitor("n", BOB, seen=9.0, tracks=frozenset({2, 3}))
    here = {"f": far, "n": near}
    assert of_track(here, 3) is near and of_track(here, 4) is None
    assert in_front(here, [face(0, track=1, size=20), face(0, track=3, size=90)]) is near
    assert in_front({}, []) is None
    assert gone(here, 6.0, 4.0) == [far]


def test_the_reprs_of_faces_and_visitors_contain_no_vectors() -> None:
    """A trace contains these reprs."""
    assert "Ada" in repr(face(0.123456, ADA)) and "0.123456" not in repr(face(0.123456, ADA))
    assert "0.98765" not in repr(Visitor("a", ADA, vectors=((1.0, (0.98765,)),)))
