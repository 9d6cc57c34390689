"""The module `activity` in virtual time: it recognises activities from poses, and learns new ones."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

import ravestate as rs
from modules.modality.activity.performers import performance
from ravestate.engine.trace import Settled
from ravestate.modules import activity
from ravestate.testing import Simulation, simulate


class Witness:
    """A module that records the recognised activities."""

    def __init__(self) -> None:
        self.seen: list[activity.Activity] = []
        self.module = rs.Module("witness", requires=[activity])

        @self.module.rule(when=activity.recognised.max_age(None).detached())
        async def note(ctx: rs.RuleContext) -> None:
            self.seen.append(ctx.payload(activity.recognised))

    @property
    def names(self) -> set[str]:
        return {one.name for one in self.seen}


def show(sim: Simulation, poses: Sequence[activity.Pose]) -> tuple[float, float]:
    """Emit the poses of a performance as a camera would; return the times of its beginning and end."""
    start = sim.now
    for pose in poses:
        sim.advance(max(0.0, start + pose.at - sim.now))
        sim.emit(activity.posed, activity.Pose(sim.now, pose.points))
    return start, sim.now


def test_a_known_activity_is_recognised_every_half_second(tmp_path: Path) -> None:
    witness = Witness()
    with simulate(activity, witness.module, settings={"activity": {"folder": tmp_path}}) as sim:
        sim.advance(1.0)
        start, end = show(sim, performance("rowing", 2))
        assert witness.names == {"rowing"}
        assert 2 <= len(witness.seen) <= 3
        one = witness.seen[-1]
        assert start <= one.start < one.end <= end
        assert 0.5 < one.confidence <= 1.0


def test_an_unknown_movement_raises_no_signal_until_it_is_taught(tmp_path: Path) -> None:
    settings = {"activity": {"folder": tmp_path}}
    witness = Witness()
    with simulate(activity, witness.module, settings=settings) as sim:
        sim.advance(1.0)
        begin, end = show(sim, performance("skiing", 2))
        assert witness.seen == []
        sim.emit(activity.taught, activity.Lesson("Nordic_Skiing", begin, end))
        assert "nordic skiing" in sim.read(activity.known)
        assert [file.name for file in tmp_path.iterdir()] == ["nordic-skiing-1.npz"]
        sim.advance(5.0)
        show(sim, performance("skiing", 2))
        assert witness.names == {"nordic skiing"}
    again = Witness()
    with simulate(activity, again.module, settings=settings) as sim:  # after a restart
        sim.advance(1.0)
        show(sim, performance("skiing", 2))
        assert again.names == {"nordic skiing"}


def test_a_resignation_says_that_too_little_of_the_body_is_visible(tmp_path: Path) -> None:
    with simulate(activity, settings={"activity": {"folder": tmp_path}}) as sim:
        sim.advance(1.0)
        show(sim, [activity.Pose(pose.at, np.full_like(pose.points, np.nan)) for pose in performance("rowing", 2)])
        reasons = [one.reason for one in sim.trace if isinstance(one, Settled) and one.rule == "activity:recognise"]
    assert reasons
    assert all(reason.endswith("show too little of a body") for reason in reasons)


def test_a_lesson_without_poses_or_without_a_name_has_no_effect(tmp_path: Path) -> None:
    with simulate(activity, settings={"activity": {"folder": tmp_path}}) as sim:
        sim.advance(1.0)
        sim.emit(activity.taught, activity.Lesson("nothing", 0.0, 1.0))
        sim.emit(activity.taught, activity.Lesson(" ", 0.0, 1.0))
        assert len(sim.read(activity.known)) == 16
        assert list(tmp_path.iterdir()) == []


def test_in_view_becomes_false_when_the_person_leaves(tmp_path: Path) -> None:
    with simulate(activity, settings={"activity": {"folder": tmp_path}}) as sim:
        assert not sim.read(activity.in_view)
        show(sim, performance("waving", 1)[:10])
        assert sim.read(activity.in_view)
        sim.advance(3.0)
        assert not sim.read(activity.in_view)


def test_a_body_that_leaves_and_comes_back_is_a_new_movement(tmp_path: Path) -> None:
    """The poses before a long gap do not mix with those after it."""
    witness = Witness()
    with simulate(activity, witness.module, settings={"activity": {"folder": tmp_path}}) as sim:
        sim.advance(1.0)
        show(sim, performance("boxing", 2))
        sim.advance(10.0)
        witness.seen.clear()
        show(sim, performance("waving", 2))
        assert witness.names == {"waving"}


def test_the_label_of_another_recogniser_becomes_a_recognised_activity(tmp_path: Path) -> None:
    witness = Witness()
    with simulate(activity, witness.module, settings={"activity": {"folder": tmp_path}}) as sim:
        sim.advance(10.0)
        sim.emit(activity.label, "Playing_the_Piano")
        sim.emit(activity.label, "  ")
        assert witness.seen == [activity.Activity("playing the piano", 1.0, 7.0, 10.0)]


def test_a_broken_file_is_reported_and_skipped(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    (tmp_path / "bad.npz").write_bytes(b"nothing")
    np.savez(tmp_path / "empty.npz", times=np.zeros(0), points=np.zeros((0, 33, 4)))
    with simulate(activity, settings={"activity": {"folder": tmp_path}}) as sim:
        sim.advance(1.0)
        assert len(sim.read(activity.known)) == 16
    assert "bad.npz" in caplog.text and "empty.npz" in caplog.text


def test_a_lesson_that_cannot_be_written_to_the_folder_lasts_for_this_session(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    place = tmp_path / "file"
    place.write_text("")
    with simulate(activity, settings={"activity": {"folder": place}}) as sim:
        sim.advance(1.0)
        begin, end = show(sim, performance("golf", 2))
        sim.emit(activity.taught, activity.Lesson("golf", begin, end))
        assert "golf" in sim.read(activity.known)
    assert "cannot be written" in caplog.text
