"""The agent watches a camera: how often it looks, and how it reports failures."""

import logging
from pathlib import Path
from typing import Any

import pytest

import ravestate as rs
from modules.modality.visionio.photographs import make, photo
from modules.modality.visionio.user_camera import UserCamera
from ravestate.errors import PlatformError
from ravestate.modules import interloc, rawio, visionio
from ravestate.modules.modality.visionio import eye, watching
from ravestate.modules.modality.visionio.watching import AGAIN, FAULTS, Watch
from ravestate.testing import simulate

LOG = logging.getLogger("test")


class Blind:
    """An eye whose camera fails `faults` times and then shows black pictures."""

    def __init__(self, faults: int, live: bool) -> None:
        self.faults, self.live = faults, live
        self.ended, self.skipped, self.waited, self.reopened = False, 3, 0.0, 0

    async def open(self, source: str, *, loop: bool = False) -> bool:
        return self.live

    async def look(self, *_: Any, **__: Any) -> dict[str, Any]:
        self.faults -= 1
        if self.faults >= 0:
            raise PlatformError("visionio: the camera gives no more pictures: is it unplugged?")
        return {"picture": [640, 480], "dark": True, "faces": []}

    def reopen(self) -> None:
        self.reopened += 1

    def close(self) -> None:
        pass


async def watched(monkeypatch: pytest.MonkeyPatch, eye: Blind, looks: int) -> list[float]:
    """Look `looks` times; return how long the watch waited after each look (seconds)."""
    monkeypatch.setattr(watching, "Eye", lambda _: eye)
    watch = Watch(visionio.Settings(source="/dev/video0", fps=10, load=0.5), None, LOG)
    waits: list[float] = []
    now = 0.0

    async def sleep(seconds: float) -> None:
        nonlocal now
        waits.append(seconds)
        now += seconds

    assert await watch.begin()
    for _ in range(looks):
        frame = await watch.next()
        assert frame is True
        await watch.look(["faces"], {}, 0.0, frame)
        now += 0.02
        if not await watch.rest(now - 0.02, now, sleep):
            break
    assert watch.skipped == 3
    return waits


def run(coroutine: Any) -> Any:
    import asyncio

    return asyncio.run(coroutine)


def test_a_lost_camera_is_reported_once_and_reopened_until_it_works(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    eye = Blind(8, live=True)
    caplog.set_level(logging.INFO)
    waits = run(watched(monkeypatch, eye, 10))
    assert waits[:8] == [AGAIN] * 8 and waits[8:] == pytest.approx([0.02, 0.02])
    assert eye.reopened == 8
    assert caplog.text.count("is it unplugged?") == 1 and caplog.text.count("sees again") == 1


def test_the_agent_stops_reading_a_file_that_fails_repeatedly(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    waits = run(watched(monkeypatch, Blind(100, live=False), 20))
    assert len(waits) == FAULTS - 1
    assert "gives up after 5 failures" in caplog.text


def test_black_pictures_are_reported_once(monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> None:
    run(watched(monkeypatch, Blind(0, live=True), 70))
    assert caplog.text.count("is the lens covered") == 1


def looks_of(monkeypatch: pytest.MonkeyPatch, *spent: float) -> list[float]:
    """Return the start times of looks that take the given seconds. The settings are 10 looks/s and a load of 0.5."""

    async def began() -> list[float]:
        now, found = 0.0, list[float]()

        async def sleep(seconds: float) -> None:
            nonlocal now
            now += seconds

        monkeypatch.setattr(watching, "Eye", lambda _: Blind(0, live=False))
        watch = Watch(visionio.Settings(source="film.mp4", fps=10, load=0.5), None, LOG)
        assert await watch.begin()
        for one in spent:
            found.append(now)
            now += one
            await watch.rest(now - one, now, sleep)
        return found

    return run(began())


def test_on_a_slow_machine_the_agent_looks_less_often(monkeypatch: pytest.MonkeyPatch) -> None:
    assert looks_of(monkeypatch, 0.3, 0.3, 0.3, 0.0) == pytest.approx([0.0, 0.6, 1.2, 1.8])


def test_one_slow_look_in_a_second_does_not_lower_the_rate(monkeypatch: pytest.MonkeyPatch) -> None:
    second = (0.09, *[0.02] * 9)
    began = looks_of(monkeypatch, *second, *second, 0.0)
    assert began[-1] == pytest.approx(2.0)
    assert began[:4] == pytest.approx([0.0, 0.18, 0.22, 0.3])


def test_a_damaged_picture_in_a_folder_is_reported_and_skipped(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    for number in (0, 1, 3, 4, 5):
        (tmp_path / f"{number}.jpg").write_bytes(photo("hanks").read_bytes())
    (tmp_path / "2.jpg").write_bytes(b"broken")
    settings = {"visionio": {"source": str(tmp_path), "fps": 1}, "ontology": {"path": str(tmp_path / "m.lbug")}}
    with simulate(visionio.module, settings=settings) as sim:
        sim.advance(5.5)
        assert len(sim.read(visionio.visitors)) == 1
        assert sim.failures == []
    assert caplog.text.count("2.jpg") == 1


def test_the_agent_looks_at_the_newest_picture_of_a_platform(tmp_path: Path) -> None:
    """The agent skips older pictures. When the camera is closed, all visitors have left."""
    frames = visionio.Frames()
    settings = {"visionio": {"source": ""}, "ontology": {"path": str(tmp_path / "m.lbug")}}
    data = photo("hanks").read_bytes()
    with simulate(visionio.module, settings=settings) as sim:
        sim.put(visionio.camera, frames)
        for _ in range(3):
            frames.put(b"older")
            frames.put(data)
            sim.advance(0.3)
        assert len(sim.read(visionio.visitors)) == 1
        frames.put(b"broken")
        sim.advance(0.3)
        assert frames.dropped == 3
        sim.advance(10)  # no pictures come, as when a telephone's screen is locked
        assert not sim.read(visionio.visitors)
        for _ in range(3):
            frames.put(data)
            sim.advance(0.3)
        assert len(sim.read(visionio.visitors)) == 1
        frames.close()
        sim.advance(10)
        assert not sim.read(visionio.visitors) and sim.failures == []


def test_the_agent_looks_through_the_users_camera(tmp_path: Path) -> None:
    """The agent asks for pictures at its own pace, marks faces on the page, and notices when the camera goes off."""
    user = UserCamera(photo("hanks").read_bytes())
    settings = {"visionio": {"source": "", "fps": 5}, "ontology": {"path": str(tmp_path / "m.lbug")}}
    with simulate(visionio.module, settings=settings) as sim:
        sim.put(rawio.camera, user)
        sim.advance(3)
        looks = sum(getattr(record, "signal", "") == visionio.looked.name for record in sim.trace)
        assert 5 <= user.asked <= looks + 2
        ((_, visitor),) = sim.read(visionio.visitors).items()
        (face,) = user.marks[-1]
        x, y, width, height = face.box
        assert face.name == "" and 0 < x < x + width < 1 and 0 < y < y + height < 1
        sim.put(interloc.users, {visitor.key: "Tom"})
        sim.advance(1)
        assert [each.name for each in user.marks[-1]] == ["Tom"]
        user.picture = None
        sim.put(rawio.camera, None)
        sim.advance(10)
        assert not sim.read(visionio.visitors)
        second = UserCamera(photo("biden").read_bytes())
        sim.put(rawio.camera, second)
        sim.advance(2)
        assert len(sim.read(visionio.visitors)) == 1 and second.marks
        assert user.refused == [] and sim.failures == []


def test_an_agent_that_cannot_see_turns_the_users_camera_off(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def missing(_: object) -> str:
        raise PlatformError("visionio needs the packages of the eyes: `make eyes` sets them up")

    monkeypatch.setattr(eye, "eyes_python", missing)
    user = UserCamera(photo("hanks").read_bytes())
    settings = {"visionio": {"source": ""}, "ontology": {"path": str(tmp_path / "m.lbug")}}
    with simulate(visionio.module, settings=settings) as sim:
        sim.put(rawio.camera, user)
        sim.advance(1)
        assert user.refused == ["the agent cannot see at the moment"] and sim.failures == []
    assert caplog.text.count("`make eyes`") == 1


def test_a_rule_can_react_to_poses_of_bodies(tmp_path: Path) -> None:
    heard: list[visionio.Pose] = []
    dancer = rs.Module("dancer", requires=[visionio])

    @dancer.rule(when=visionio.pose.max_age(None).detached(), background=True)
    async def note(ctx: rs.RuleContext) -> None:
        heard.append(ctx.payload(visionio.pose))

    pictures = tmp_path / "pictures"
    pictures.mkdir()
    (pictures / "0.jpg").write_bytes(photo("obama3").read_bytes())
    make("cv2.imwrite(a[0], np.full((480, 640, 3), 128, np.uint8))", pictures / "1.png")
    settings = {"visionio": {"source": str(pictures), "fps": 1}, "ontology": {"path": str(tmp_path / "m.lbug")}}
    with simulate(dancer, settings=settings) as sim:
        sim.advance(3.5)
        assert sim.failures == []
    body, nobody = heard[0].landmarks, heard[-1].landmarks
    assert body is not None and len(body) == 33 and all(len(point) == 4 for point in body)
    nose, hip = body[0], body[24]
    assert nose[1] < hip[1] and nose[3] > 0.9  # the nose is above the hip and clearly visible
    assert nobody is None


def test_black_pictures_of_a_video_are_reported(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    file = tmp_path / "black.mp4"
    make(
        """
out = cv2.VideoWriter(a[0], cv2.VideoWriter_fourcc(*"mp4v"), 10, (320, 240))
for _ in range(50):
    out.write(np.zeros((240, 320, 3), np.uint8))
out.release()
""",
        file,
    )
    seen: list[visionio.Look] = []
    settings = {"visionio": {"source": str(file), "fps": 5}, "ontology": {"path": str(tmp_path / "m.lbug")}}
    with simulate(visionio.module, settings=settings) as sim:
        sim.advance(4.5)
        seen = [
            r.payload for r in sim.trace if getattr(r, "signal", "") == visionio.looked.name and hasattr(r, "payload")
        ]
    assert seen and all(look.dark and not look.tracks for look in seen)
    assert caplog.text.count("is the lens covered") == 1
