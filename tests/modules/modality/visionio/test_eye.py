"""Cameras of the vision worker: video files, folders and devices. A worker that dies is replaced."""

import os
import shutil
import signal
import sys
import threading
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from threading import Thread

import pytest

from modules.modality.visionio.photographs import make, photo
from ravestate.errors import PlatformError
from ravestate.modules.modality.visionio import eye as eyes
from ravestate.modules.modality.visionio.eye import Eye

CLIP = """
frames = [cv2.resize(cv2.imread(a[0]), (320, 400)), cv2.resize(cv2.imread(a[1]), (320, 400))]
out = cv2.VideoWriter(a[2], cv2.VideoWriter_fourcc(*"mp4v"), 10, (320, 400))
for number in range(40):
    out.write(frames[number // 20])
out.release()
"""


@pytest.fixture
def eye() -> Iterator[Eye]:
    one = Eye()
    yield one
    one.close()


@pytest.fixture(scope="session")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A video that shows one man for two seconds, and then another man for two seconds."""
    file = tmp_path_factory.mktemp("clip") / "two.mp4"
    make(CLIP, photo("obama"), photo("biden"), file)
    return file


async def see(eye: Eye, at: float) -> int | None:
    """Return the number of faces in the picture at a time of the video; None if there is no new picture."""
    seen = await eye.look(["faces"], {"most": 0}, at=at)
    return None if seen is None else len(seen["faces"])


def run(coroutine: object) -> object:
    import asyncio

    return asyncio.run(coroutine)  # type: ignore[arg-type]


def test_a_video_gives_its_newest_picture_and_skips_older_ones(eye: Eye, clip: Path) -> None:
    async def watch() -> None:
        assert await eye.open(str(clip)) is False
        assert await see(eye, 0.0) == 1
        assert await see(eye, 0.01) is None  # still the same picture
        assert await see(eye, 1.05) == 1
        assert eye.skipped == 9 and not eye.ended
        assert await see(eye, 9.0) == 1
        assert eye.skipped == 9 + 28 and eye.ended
        assert await see(eye, 9.5) is None

    run(watch())


def test_a_video_begins_again_if_it_is_opened_as_a_loop(eye: Eye, clip: Path) -> None:
    async def watch() -> None:
        await eye.open(str(clip), loop=True)
        for at in (0.0, 3.0, 5.0, 8.5):
            assert await see(eye, at) == 1
        assert not eye.ended

    run(watch())


def test_each_picture_of_a_folder_is_shown_for_a_second(eye: Eye, tmp_path: Path) -> None:
    for number, name in enumerate(("biden", "six")):
        (tmp_path / f"{number}.jpg").write_bytes(photo(name).read_bytes())
    (tmp_path / "2.jpg").write_bytes(b"broken")
    (tmp_path / "notes.txt").write_text("not a readable picture")

    async def watch() -> None:
        await eye.open(str(tmp_path))
        assert await see(eye, 0.0) == 1
        assert await see(eye, 0.9) is None
        assert (await see(eye, 1.0) or 0) >= 3
        with pytest.raises(PlatformError, match=r"2\.jpg: .*not a readable picture"):
            await see(eye, 2.0)
        assert await see(eye, 3.0) is None and eye.ended

    run(watch())


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("/dev/video97", "there is no camera /dev/video97"),
        ("97", "there is no camera /dev/video97"),
        ("nowhere.mp4", "there is no camera, video or folder nowhere.mp4"),
        ("/dev/null", "the camera /dev/null cannot be opened"),
    ],
)
def test_a_missing_camera_is_reported(eye: Eye, name: str, why: str) -> None:
    with pytest.raises(PlatformError, match=why):
        run(eye.open(name))


def test_an_empty_folder_is_reported(eye: Eye, tmp_path: Path) -> None:
    with pytest.raises(PlatformError, match="has no pictures"):
        run(eye.open(str(tmp_path)))


def test_a_file_that_is_not_a_video_is_reported(eye: Eye, tmp_path: Path) -> None:
    (tmp_path / "bad.mp4").write_bytes(b"\0" * 5000)
    with pytest.raises(PlatformError, match="not a readable video"):
        run(eye.open(str(tmp_path / "bad.mp4")))


def test_a_truncated_video_is_reported_or_ends(eye: Eye, tmp_path: Path, clip: Path) -> None:
    """The file has only the first half of a Motion-JPEG video, as if the disk had been full."""
    file = tmp_path / "cut.avi"
    make(CLIP.replace("mp4v", "MJPG"), photo("obama"), photo("biden"), file)
    data = file.read_bytes()
    file.write_bytes(data[: len(data) // 2])

    async def watch() -> str:
        try:
            await eye.open(str(file))
            for number in range(60):
                await see(eye, number / 10)
        except PlatformError as error:
            return str(error)
        return ""

    assert "damaged" in str(run(watch())) or eye.ended


@pytest.fixture
def eye_alone(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Eye]:
    """An eye with a worker of its own, which the test may kill: each program gets a process."""
    copy = tmp_path / "worker"
    shutil.copytree(eyes.WORKER.program, copy)
    monkeypatch.setattr(eyes, "WORKER", replace(eyes.WORKER, program=copy))
    one = Eye()
    yield one
    one.close()


def test_a_worker_that_dies_is_replaced_and_the_video_continues(eye_alone: Eye, clip: Path) -> None:
    async def watch() -> None:
        await eye_alone.open(str(clip))
        assert await see(eye_alone, 0.0) == 1
        assert eye_alone.process.pid is not None
        killed = eye_alone.process.pid
        os.kill(killed, signal.SIGKILL)
        with pytest.raises(PlatformError, match="ended"):
            for _ in range(3):  # the process can take a moment to die
                await see(eye_alone, 0.5)
        assert await see(eye_alone, 1.0) == 1
        assert eye_alone.process.pid not in (None, killed)

    run(watch())


def test_the_worker_ends_when_its_last_user_closes(eye_alone: Eye) -> None:
    eye_alone.process.start()
    pid = eye_alone.process.pid
    assert pid is not None
    eye_alone.close()
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


STUB = """
streams = set()

def load(config):
    def handle(header, data):
        if header["do"] == "open":
            streams.add(header["stream"])
            return {"live": True}, b""
        if header["do"] == "close":
            streams.discard(header["stream"])
            return {}, b""
        if "pipe" in header:
            open(header["pipe"]).read()
        return {"picture": [1, 1], "streams": len(streams)}, b""

    return handle
"""
"""A worker whose looks may wait for a pipe of the test."""


def test_a_camera_is_closed_even_while_the_worker_is_busy(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    program, pipe = tmp_path / "stub.py", tmp_path / "pipe"
    program.write_text(STUB)
    os.mkfifo(pipe)
    monkeypatch.setattr(eyes, "WORKER", replace(eyes.WORKER, program=program))
    one, other = Eye(), Eye()
    try:
        for each in (one, other):
            run(each.open("camera"))
        looks = Thread(target=other.look_now, args=([], {"pipe": str(pipe)}))
        looks.start()
        with pipe.open("w"):  # this opens the pipe as soon as the look has begun
            one.close()  # this does not wait for the look of the other agent
            assert one.process.busy
        looks.join(20)
        for thread in threading.enumerate():
            if thread.name == "visionio-close":
                thread.join(20)
        assert other.look_now([], {}) == {"picture": [1, 1], "streams": 1}
    finally:
        other.close()


CAMERAS = f"""
import sys
from unittest.mock import MagicMock

sys.modules["cv2"] = MagicMock()
sys.path.insert(0, {str(eyes.WORKER.program.parent)!r})
from worker import Worker


def load(config):
    return Worker().handle
"""
"""The worker without its models. It reads no picture."""


@pytest.fixture
def cameras(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Eye]:
    program = tmp_path / "cameras.py"
    program.write_text(CAMERAS)
    monkeypatch.setattr(eyes, "WORKER", replace(eyes.WORKER, program=program))
    one = Eye(Path(sys.executable))
    yield one
    one.close()


@pytest.mark.parametrize("runs", [False, True])
def test_a_look_without_an_open_camera_is_reported(cameras: Eye, runs: bool) -> None:
    if runs:
        cameras.process.start()
    for _ in range(2):
        with pytest.raises(PlatformError, match="no camera is open"):
            cameras.look_now([], {})


def test_a_camera_that_cannot_be_opened_again_is_reported_at_each_look(cameras: Eye, tmp_path: Path) -> None:
    picture = tmp_path / "photos" / "one.png"
    picture.parent.mkdir()
    picture.touch()
    assert run(cameras.open(str(picture.parent))) is False
    picture.unlink()
    cameras.reopen()
    for _ in range(2):
        with pytest.raises(PlatformError, match="has no pictures"):
            cameras.look_now([], {})


def test_the_worker_reports_a_look_at_a_camera_that_is_not_open(cameras: Eye) -> None:
    header = {"do": "look", "stream": "other", "want": [], "at": 0.0}
    assert cameras.process.request(header, seconds=20)[0] == {"fault": "no camera is open"}
