"""A track follows a face through the pictures, and says when the worker must compute a new vector for it."""

from typing import Any

from ravestate.modules.meta.ontology import Node
from ravestate.modules.modality.visionio.tracks import LOST, REFRESH, TRIES, Tracks

ADA = Node("Person", {"name": "Ada"})


def seen(track: int | None = None, *, quality: float = 1.0, vector: bool = True) -> dict[str, Any]:
    return {"box": [1, 2, 3, 4], "track": track, "quality": quality, "vector": [0.5] * 128 if vector else None}


def needs_vector(tracks: Tracks, now: float) -> bool:
    [known] = tracks.request(now)["known"]
    return not known["fresh"]


def test_a_face_gets_a_track_number_and_keeps_it() -> None:
    tracks = Tracks()
    [(one, new)] = tracks.update([seen()], 0.0)
    assert new and one.number == 1 and one.vector == (0.5,) * 128
    [(same, new), (other, _)] = tracks.update([seen(1, vector=False), seen()], 0.1)
    assert same is one and not new and other.number == 2


def test_a_face_needs_vectors_until_enough_agree_and_later_only_at_intervals() -> None:
    tracks = Tracks(sure=3)
    for number in range(3):
        [(one, _)] = tracks.update([seen(1 if number else None)], number / 10)
        one.recognise(ADA, 0.3, 0.3)
        assert needs_vector(tracks, number / 10 + 0.05) is (number < 2)
    for number in range(3, 10 * round(REFRESH) + 2):
        tracks.update([seen(1, vector=False)], number / 10)
        assert not needs_vector(tracks, number / 10)
    assert needs_vector(tracks, 0.2 + REFRESH)
    tracks.update([seen(1)], 4.0)
    one.recognise(None, None, 0.3)  # now another person is there
    assert needs_vector(tracks, 4.05)


def test_after_some_tries_a_badly_visible_face_gets_only_one_vector_per_second() -> None:
    tracks = Tracks()
    for number in range(TRIES):
        [(one, _)] = tracks.update([seen(1 if number else None, quality=0.1)], number / 10)
        one.recognise(ADA, 0.3, 0.3)
    assert one.agreed == 0
    assert not needs_vector(tracks, TRIES / 10) and needs_vector(tracks, TRIES / 10 + 1.0)


def test_a_face_that_has_gone_loses_its_track_number() -> None:
    tracks = Tracks()
    tracks.update([seen()], 0.0)
    tracks.update([], LOST)
    assert len(tracks.request(LOST)["known"]) == 1
    tracks.update([], LOST + 0.1)
    assert tracks.request(LOST + 0.1)["known"] == []
    [(one, _)] = tracks.update([seen(1)], LOST + 0.2)  # a late result with an old number
    assert one.number == 2


def test_after_a_pause_of_the_camera_no_track_is_known() -> None:
    tracks = Tracks()
    tracks.update([seen()], 0.0)
    assert tracks.request(LOST + 0.1)["known"] == []


def test_a_thorough_search_is_requested_once_per_second() -> None:
    tracks = Tracks()
    assert tracks.request(0.0)["thorough"] == 1
    tracks.update([], 0.0)
    assert tracks.request(0.9)["thorough"] == 0 and tracks.request(1.0)["thorough"] == 1
