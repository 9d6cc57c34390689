"""``ravestate activity`` on files of landmarks, and on a real video."""

from __future__ import annotations

import functools
import sys
from pathlib import Path

import pytest

from modules.modality.activity.performers import performance
from ravestate.cli import main
from ravestate.modules.modality.activity import video
from ravestate.modules.modality.activity.files import write

VIDEO = Path(sys.prefix) / "share" / "ravestate" / "eyes" / "videos" / "walk.mp4"


@pytest.fixture
def folder(tmp_path: Path) -> str:
    return str(tmp_path / "taught")


def recording(tmp_path: Path, name: str, seed: int = 2) -> str:
    file = tmp_path / f"{name}-{seed}.npz"
    write(file, performance(name, seed))
    return str(file)


def test_the_action_guess_names_the_activity(tmp_path: Path, folder: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["activity", "guess", recording(tmp_path, "rowing"), "--folder", folder]) == 0
    line = capsys.readouterr().out.strip()
    assert line.endswith("%  rowing")


def test_the_action_guess_names_a_movement_that_teach_has_learnt(
    tmp_path: Path, folder: str, capsys: pytest.CaptureFixture[str]
) -> None:
    file = recording(tmp_path, "skiing")
    assert main(["activity", "guess", file, "--folder", folder]) == 0
    assert capsys.readouterr().out.strip().endswith("unknown")
    more = recording(tmp_path, "skiing", 3)
    assert main(["activity", "teach", "Nordic skiing", file, more, "--folder", folder]) == 0
    assert "learnt nordic skiing from 2 demonstrations" in capsys.readouterr().out
    assert main(["activity", "guess", recording(tmp_path, "skiing", 4), "--folder", folder]) == 0
    assert capsys.readouterr().out.strip().endswith("nordic skiing")
    assert main(["activity", "list", "--folder", folder]) == 0
    assert "nordic skiing  (taught)" in capsys.readouterr().out
    assert main(["activity", "forget", "nordic sking", "--folder", folder]) == 2
    assert "did you mean 'nordic skiing'?" in capsys.readouterr().err
    assert main(["activity", "forget", "Nordic skiing", "--folder", folder]) == 0
    assert capsys.readouterr().out == "forgot nordic skiing: 2 demonstrations\n"
    assert main(["activity", "guess", file, "--folder", folder]) == 0
    assert capsys.readouterr().out.strip().endswith("unknown")


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["guess", "{tmp}/missing.npz"], 2, "there is no file"),
        (["guess", "{tmp}"], 2, "is a folder"),
        (["teach", " ", "{tmp}/bad.npz"], 2, "the name is empty"),
        (["guess", "{tmp}/bad.npz"], 1, "not a file of landmarks"),
        (["teach", "x", "{tmp}/bad.npz"], 1, "not a file of landmarks"),
    ],
)
def test_wrong_use_is_reported(
    tmp_path: Path, folder: str, capsys: pytest.CaptureFixture[str], arguments: list[str], code: int, message: str
) -> None:
    (tmp_path / "bad.npz").write_text("hello")
    given = [argument.replace("{tmp}", str(tmp_path)) for argument in arguments]
    assert main(["activity", *given, "--folder", folder]) == code
    assert message in capsys.readouterr().err
    assert not Path(folder).exists()


def test_walking_in_a_real_video_is_unknown_and_is_a_poor_demonstration(
    folder: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The recogniser does not know walking. Several people come and go in the video, so it is a poor demonstration."""
    assert VIDEO.is_file(), "the video of the tests is missing: run make test, which fetches it"
    poses_in = functools.cache(video.poses_in)  # look at the video only once
    monkeypatch.setattr(video, "poses_in", lambda file, *_: poses_in(file))
    assert main(["activity", "guess", str(VIDEO), "--folder", folder]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) >= 3
    assert all(line.endswith("unknown") for line in lines), lines
    assert main(["activity", "teach", "walking about", str(VIDEO), "--folder", folder]) == 0
    seen = capsys.readouterr()
    assert "learnt walking about" in seen.out
    assert "demonstrations would not be recognised" in seen.err and "forget 'walking about'" in seen.err
