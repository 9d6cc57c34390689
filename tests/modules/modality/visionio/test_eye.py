"""Cameras of the vision worker: video files, folders and devices. A worker that dies is replaced."""

import os
import signal
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from modules.modality.visionio.photographs import make, photo
from ravestate.errors import PlatformError
from ravestate.modules.modality.visionio.eye import Eye
from ravestate.modules.modality.visionio.places import eyes_python

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


def test_a_worker_that_dies_is_replaced_and_the_video_continues(clip: Path) -> None:
    from ravestate.modules._children import process as processes

    eye = Eye()
    shared, eye._process = eye._process, processes.take(  # a separate process, which the test kills
        eye._process._backend, {"want": ["faces"]}, eyes_python(), shared=False
    )  # fmt: skip
    processes.drop(shared)

    async def watch() -> None:
        await eye.open(str(clip))
        assert await see(eye, 0.0) == 1
        assert eye.process.pid is not None
        killed = eye.process.pid
        os.kill(killed, signal.SIGKILL)
        with pytest.raises(PlatformError, match="ended"):
            for _ in range(3):  # the process can take a moment to die
                await see(eye, 0.5)
        assert await see(eye, 1.0) == 1
        assert eye.process.pid not in (None, killed)

    try:
        run(watch())
    finally:
        eye.close()


def test_the_worker_ends_when_its_last_user_closes() -> None:
    from ravestate.modules._children import process as processes

    one = Eye()
    one._process, shared = (
        processes.take(one._process._backend, {"want": []}, eyes_python(), shared=False),
        one._process,
    )
    processes.drop(shared)
    one.process.start()
    pid = one.process.pid
    assert pid is not None
    one.close()
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


def test_a_camera_is_closed_even_while_the_worker_is_busy(clip: Path) -> None:
    one, other = Eye(), Eye()
    try:
        assert run(one.open(str(clip))) is False
        stream = one._stream
        with one.process._turn:  # as if the worker looked at a picture for another agent
            one.close()
        for thread in threading.enumerate():
            if thread.name == "visionio-close":
                thread.join(20)
        answer, _ = other.process.request({"do": "look", "stream": stream, "want": [], "at": 0.0}, seconds=20)
        assert answer == {"closed": True}
    finally:
        other.close()
