"""Landmark files, films (the last poses in view) and windows (the parts of a long recording)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from modules.modality.activity.performers import performance
from ravestate.errors import PlatformError
from ravestate.modules.modality.activity import Film, Pose, pose_of
from ravestate.modules.modality.activity.files import clean, keep, read, write
from ravestate.modules.modality.activity.pose import checked
from ravestate.modules.modality.activity.windows import windows


def test_reading_a_file_gives_the_poses_and_the_name_that_were_written(tmp_path: Path) -> None:
    poses = performance("waving")
    write(tmp_path / "a.npz", poses, "waving")
    name, found = read(tmp_path / "a.npz")
    assert name == "waving"
    assert [pose.at for pose in found] == pytest.approx([pose.at - poses[0].at for pose in poses])
    assert np.array_equal(found[3].points, poses[3].points)


def test_each_demonstration_is_kept_in_a_new_file(tmp_path: Path) -> None:
    poses = performance("waving")
    assert [keep(tmp_path, "Über/../Fliegen", poses).name for _ in range(2)] == [
        "über-fliegen-1.npz",
        "über-fliegen-2.npz",
    ]
    assert keep(tmp_path, "!?", poses).name == "activity-1.npz"
    long = "水" * 100  # 300 bytes
    assert read(keep(tmp_path, long, poses))[0] == long


def test_a_pose_needs_33_landmarks() -> None:
    with pytest.raises(PlatformError, match=r"shape \(5, 4\): give \(33, 4\)"):
        Pose(0.0, np.zeros((5, 4), dtype=np.float32))


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({"times": np.zeros(3)}, "points"),
        ({"times": np.zeros(3), "points": np.zeros((2, 33, 4))}, "3 times for 2 poses"),
        ({"times": np.zeros(2), "points": np.zeros((2, 17, 3))}, r"shape \(17, 3\): give \(33, 4\)"),
        ({"times": np.array(["a"]), "points": np.zeros((1, 33, 4))}, "not a file of landmarks"),
        ({"times": np.array([{}], dtype=object), "points": np.zeros((1, 33, 4))}, "not a file of landmarks"),
    ],
)
def test_files_with_wrong_arrays_are_refused_with_a_reason(
    tmp_path: Path, data: dict[str, object], message: str
) -> None:
    file = tmp_path / "bad.npz"
    np.savez(file, **data)  # type: ignore[arg-type]
    with pytest.raises(PlatformError, match=message):
        read(file)


def test_missing_files_and_files_that_are_not_archives_are_refused(tmp_path: Path) -> None:
    (tmp_path / "text.npz").write_text("hello")
    for name in ("text.npz", "missing.npz"):
        with pytest.raises(PlatformError, match=name):
            read(tmp_path / name)
    with pytest.raises(PlatformError, match="must be numbers"):
        checked("hello")


def test_landmarks_have_the_same_unit_for_width_and_height() -> None:
    pose = pose_of(np.ones((33, 4)), 2.0, 1600, 800)
    assert pose.points[0].tolist() == [2.0, 1.0, 2.0, 1.0]
    assert pose.at == 2.0


def test_a_film_keeps_the_last_thirty_seconds() -> None:
    points = np.zeros((33, 4), np.float32)
    film = Film()
    for at in np.arange(0, 60, 0.5):
        film = film.with_pose(Pose(float(at), points))
    assert (film.poses[0].at, film.poses[-1].at) == (29.5, 59.5)
    assert [pose.at for pose in film.part(58.9, 100.0)] == [59.0, 59.5]
    assert film.with_pose(Pose(59.5, points)) is film
    # Time goes back if the clock changes or a video begins again. The film then drops the poses before this moment.
    assert len(film.with_pose(Pose(1.0, points)).poses) == 1
    assert repr(film) == "Film(61 poses, 30.0 s)"
    assert repr(Film()) == "Film()"


def test_a_long_recording_has_several_windows_and_a_short_one_has_one() -> None:
    points = np.zeros((33, 4), np.float32)
    poses = [Pose(at / 10, points) for at in range(101)]
    assert [(part[0].at, part[-1].at) for part in windows(poses, 3.0, 3.0)] == [(0, 3), (3, 6), (6, 9), (9, 10)]
    assert len(list(windows(poses[:10], 3.0, 1.5))) == 1
    assert list(windows([], 3.0, 1.5)) == []


def test_the_name_of_an_activity_is_cleaned_to_plain_words() -> None:
    assert clean(" Playing_the  Guitar\n") == "playing the guitar"
