"""The camera of the chat page, in a real browser with the real vision worker. The browser's camera plays a video."""

import os
import re
from pathlib import Path
from typing import Any

import pytest
from playwright.async_api import Page, expect

from end_to_end.stage import PHONE, Host, Stage, hide, on_stage
from end_to_end.test_access import findings
from end_to_end.test_speech import point
from modules.modality.visionio.photographs import PHOTOS, make, photo
from modules.platform.webio.eyes import eyes
from ravestate.board.application import INSIDE, RecordedAgent, routes
from ravestate.modules import activity, charades, hibye, interloc, persqa, rawio, visionio, webio
from ravestate.modules.platform.webio.server import Server

VIDEO = """
room = np.full((480, 640, 3), 150, np.uint8)
picture = cv2.imread(a[0])
scale = 440 / picture.shape[0]
picture = cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
width = min(300, picture.shape[1])
room[40:, 40:40 + width] = picture[:, :width]  # left, in the camera's picture
with open(a[1], "wb") as out:
    for _ in range(10):
        out.write(cv2.imencode(".jpg", room, [cv2.IMWRITE_JPEG_QUALITY, 92])[1].tobytes())
"""


@pytest.fixture(scope="module")
def video(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A video of a man on the left. Chromium repeats it as the camera's picture."""
    file = tmp_path_factory.mktemp("camera") / "man.mjpeg"
    make(VIDEO, photo("obama"), file)
    return file


def view(page: Page) -> Any:
    return page.get_by_role("region", name="Camera", exact=True)


async def turn_on(page: Page) -> None:
    await page.get_by_role("button", name="see you").click()
    await expect(page.get_by_text("keeps none of them")).to_be_visible()
    await page.get_by_role("button", name="Turn the camera on").click()
    await expect(view(page)).to_be_visible()


@on_stage
async def test_the_name_that_a_stranger_gives_appears_at_their_face_and_on_the_board(
    stage: Stage, video: Path, tmp_path: Path
) -> None:
    settings: dict[str, Any] = {
        "webio": {"port": 0, "title": "Elske"},
        "ontology": {"path": str(tmp_path / "memory.lbug")},
        "idle": {"bored_after": 1e6},
        "visionio": {"fps": 5, "gone_after": 60},  # on a busy machine, a picture can take seconds to arrive
    }
    agent = RecordedAgent(webio, hibye, persqa, visionio, settings=settings)
    async with (
        Server(agent, routes(agent.recorders), INSIDE) as server,
        stage.devices(film=video) as browser,
        stage.open(server.address, browser=browser) as page,
    ):
        host = Host(server)
        await turn_on(page)
        face = page.locator(".face")
        await expect(face).to_have_text("unknown")
        box, whole = await face.bounding_box(), await page.locator(".picture").bounding_box()
        assert box is not None
        assert whole is not None
        # The preview is mirrored, so the face is on the right.
        assert box["x"] + box["width"] / 2 > whole["x"] + whole["width"] / 2
        field = page.get_by_label("What you say to Elske")
        await field.fill("My name is Barack.")
        await field.press("Enter")
        await expect(face).to_have_text("Barack")
        await expect(page.locator(".line.agent").last).to_contain_text("emember your face")
        (session,) = host.sessions
        assert list(session.context.read(interloc.users)) == [session.visitor]
        board = await page.context.new_page()
        await board.goto(f"{server.address}board/")
        await board.get_by_role("button", name="All", exact=True).click()
        await point(board, "faces", "Barack")
        await page.get_by_role("button", name="End camera").click()
        await expect(view(page)).to_have_count(0)
        assert session.camera is None


@on_stage
async def test_the_pictures_in_the_documentation_can_be_taken(stage: Stage, tmp_path: Path) -> None:
    """To renew the pictures, run `PICTURES=docs/pictures pytest ...`."""
    figure = tmp_path / "figure.mjpeg"
    make(Path(__file__).with_name("drawn_figure.py").read_text(), figure)
    folder = Path(os.environ.get("PICTURES", tmp_path))
    settings: dict[str, Any] = {
        "webio": {"port": 0, "title": "Elske"},
        "ontology": {"path": str(tmp_path / "memory.lbug")},
        "idle": {"bored_after": 1e6},
        "emotion": {"emoji": False},
        "visionio": {"fps": 5, "gone_after": 60},  # on a busy machine, a picture can take seconds to arrive
    }
    agent = RecordedAgent(webio, hibye, persqa, charades, visionio, settings=settings)
    async with (
        Server(agent, routes(agent.recorders), INSIDE) as server,
        stage.devices(film=figure) as browser,
        stage.open(
            server.address, browser=browser, viewport={"width": 920, "height": 640}, color_scheme="light"
        ) as page,
    ):
        await turn_on(page)
        field = page.get_by_label("What you say to Elske")
        await expect(page.locator(".face")).to_have_text("unknown")
        await field.fill("My name is Ada.")
        await field.press("Enter")
        await expect(page.locator(".face")).to_have_text("Ada")
        await expect(page.locator(".line.agent").last).to_contain_text("emember your face")
        await field.fill("Yes, please.")
        await field.press("Enter")
        await expect(page.locator(".line.agent").last).to_contain_text("know you")
        await page.screenshot(path=folder / "camera.png")
        board = await page.context.new_page()
        await board.set_viewport_size({"width": 1100, "height": 640})
        await board.emulate_media(color_scheme="light")
        await board.goto(f"{server.address}board/")
        await board.get_by_role("button", name="All", exact=True).click()
        await expect(board.get_by_text("faces", exact=True)).to_be_visible()
        await board.screenshot(path=folder / "board-camera.png")
    for name in ("camera.png", "board-camera.png"):
        assert (folder / name).read_bytes().startswith(b"\x89PNG")


@on_stage
async def test_a_visitor_who_refuses_the_camera_gets_advice_and_can_turn_it_on_later(stage: Stage) -> None:
    async with (
        stage.launch("--use-fake-device-for-media-stream", "--deny-permission-prompts") as browser,
        stage.serve(eyes, title="Elske") as served,
        stage.open(served.address, browser=browser) as page,
    ):
        await page.get_by_role("button", name="see you").click()
        await page.get_by_role("button", name="Turn the camera on").click()
        await expect(page.get_by_role("alert")).to_contain_text("The camera is not allowed. Allow it")
        await expect(view(page)).to_have_count(0)
        await page.context.grant_permissions(["camera"])
        await page.get_by_role("button", name="see you").click()  # the notice before the camera does not appear again
        await expect(view(page)).to_be_visible()
        await expect(page.get_by_role("alert")).to_have_count(0)


@on_stage
async def test_on_a_phone_every_button_is_large_enough_for_a_finger(stage: Stage, video: Path) -> None:
    async with (
        stage.devices(film=video) as browser,
        stage.serve(eyes, title="Elske") as served,
        stage.open(served.address, browser=browser, **PHONE) as page,
    ):
        await page.get_by_role("button", name="see you").tap()
        await fits(page)
        await page.get_by_role("button", name="Turn the camera on").tap()
        await expect(view(page)).to_be_visible()
        (session,) = served.sessions
        camera = await session.context.next(rawio.camera.changed) if session.camera is None else session.camera
        camera.mark([rawio.Face((0.0, 0.0, 0.5, 0.5), 20 * "Anna ")])
        await expect(page.locator(".face")).to_be_visible()
        await page.get_by_text("What is kept").tap()
        await fits(page)
        assert await findings(page) == []


async def fits(page: Page) -> None:
    """Check that each button is large enough for a finger, and that nothing is wider than the screen."""
    for button in await page.get_by_role("button").all():
        box = await button.bounding_box()
        assert box is not None
        assert min(box["width"], box["height"]) >= 44, await button.text_content()
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= 360
    assert await page.evaluate("document.documentElement.scrollWidth") == 360


@on_stage
async def test_the_camera_goes_off_when_the_page_goes_to_the_background(stage: Stage, video: Path) -> None:
    async with (
        stage.devices(film=video) as browser,
        stage.serve(eyes, title="Elske") as served,
        stage.open(served.address, browser=browser) as page,
    ):
        await turn_on(page)
        await hide(page)
        await expect(page.get_by_role("alert")).to_have_text("The camera is off: the page was in the background.")
        assert served.sessions[0].camera is None


WALK = """
film = cv2.VideoCapture(a[0])
with open(a[1], "wb") as out:
    for _ in range(90):  # three seconds; Chromium repeats them
        more, picture = film.read()
        if not more:
            break
        scale = 480 / picture.shape[0]
        picture = cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
        out.write(cv2.imencode(".jpg", picture)[1].tobytes())
"""


@on_stage
async def test_a_round_of_charades_can_be_played_with_a_real_video(stage: Stage, tmp_path: Path) -> None:
    walk = tmp_path / "walk.mjpeg"
    make(WALK, PHOTOS.parent / "videos" / "walk.mp4", walk)
    settings: dict[str, Any] = {
        "webio": {"port": 0, "title": "Elske"},
        "ontology": {"path": str(tmp_path / "memory.lbug")},
        "activity": {"folder": str(tmp_path / "activities")},
        "idle": {"bored_after": 1e6},
        "emotion": {"emoji": False},
        "charades": {"count": 0.2, "watch": 1.5},
        "visionio": {"gone_after": 60},
    }
    agent = RecordedAgent(webio, charades, visionio, settings=settings)
    async with (
        Server(agent, routes(agent.recorders), INSIDE) as server,
        stage.devices(film=walk) as browser,
        stage.open(server.address, browser=browser) as page,
    ):
        await turn_on(page)
        answer = page.locator(".line.agent").last
        field = page.get_by_label("What you say to Elske")

        async def say(text: str, expected: str) -> str:
            await field.fill(text)
            await field.press("Enter")
            await expect(answer).to_contain_text(re.compile(expected))
            return str(await answer.text_content())

        await say("Let's play charades!", 'Say "ready"')
        (session,) = Host(server).sessions
        if not session.context.read(activity.in_view):
            await session.context.next(activity.in_view.true, timeout=60)
        said = await say("I'm ready.", r"Is it|Is that|Am I right|What was it")
        for _ in range(2):
            if "What was it" not in said:
                said = await say("No.", r"second guess|Then is it|What was it")
        assert "What was it" in said
        assert "remember" in await say("I was playing golf.", "playing golf")
        game = session.context.read(charades.game)
        assert (game.step, game.user, game.agent) == ("between", 1, 0)
