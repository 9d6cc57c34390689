"""The camera over the WebSocket: pictures that the agent asks for, faces that it marks, and mistakes of clients."""

import contextlib
from collections.abc import AsyncGenerator

import pytest
from starlette.applications import Starlette
from starlette.testclient import TestClient

from modules.platform.webio.eyes import JPEG, eyes, glance, pictures
from modules.platform.webio.visit import Visit, in_virtual_time, page, parrot, past
from ravestate.modules import rawio, webio
from ravestate.modules.platform.webio.fields import LONGEST_PICTURE
from ravestate.modules.platform.webio.session import Session
from ravestate.runtime.agent import Agent


@contextlib.asynccontextmanager
async def watching() -> AsyncGenerator[tuple[Session, Visit, Starlette]]:
    """Open a page with a visitor whose camera is on."""
    async with page(eyes, privacy="We keep nothing.") as app, Visit(app) as visit:
        assert (await visit.hello())["sight"] == "We keep nothing."
        visit.tell("camera", on=True)
        await past(0.1)
        (session,) = app.state.sessions
        yield session, visit, app


def show(visit: Visit, number: int, data: bytes = JPEG) -> None:
    visit.tell("picture", n=number)
    visit.send(data)


@in_virtual_time
async def test_the_agent_gets_the_requested_picture_and_the_page_gets_the_faces() -> None:
    async with watching() as (session, visit, _):
        assert visit.nothing_more()  # the agent has not asked for a picture yet
        session.context.emit(glance)
        assert await visit.next() == {"type": "look", "n": 1}
        show(visit, 1)
        faces = [{"box": [0.25, 0.0, 0.5, 0.4], "name": "Anna"}, {"box": [0.9, 0.0, 0.1, 0.2]}]
        assert await visit.next() == {"type": "faces", "faces": faces}
        assert session.context.read(pictures) == (JPEG,)
        session.context.emit(glance)
        assert await visit.next() == {"type": "look", "n": 2}
        await past(0.1)
        assert visit.nothing_more()  # the same faces are not sent again


@in_virtual_time
async def test_a_picture_that_the_agent_has_not_asked_for_is_dropped() -> None:
    async with watching() as (session, visit, _):
        show(visit, 0)
        show(visit, 1)
        session.context.emit(glance)
        assert await visit.next() == {"type": "look", "n": 1}
        show(visit, 7, JPEG + b"late")
        show(visit, 1)
        show(visit, 1, JPEG + b"twice")
        await visit.next()
        assert session.context.read(pictures) == (JPEG,)


@in_virtual_time
async def test_the_agent_stops_waiting_for_a_picture_when_the_camera_goes_off() -> None:
    async with watching() as (session, visit, _):
        camera = session.context.read(rawio.camera)
        assert camera is not None
        session.context.emit(glance)
        await visit.next()
        visit.tell("camera", on=False)
        await past(0.1)
        assert session.context.read(rawio.camera) is None
        assert session.context.read(pictures) == (None,)
        assert await camera.next() is None
        visit.tell("camera", on=True)
        await past(0.1)
        assert session.context.read(rawio.camera) not in (None, camera)


@in_virtual_time
async def test_a_lost_connection_turns_the_camera_off() -> None:
    async with watching() as (session, visit, app):
        await visit.drop()
        await past(0.1)
        assert session.context.read(rawio.camera) is None
        async with Visit(app) as again:
            await again.hello(session=visit.session)
            again.tell("camera", on=True)
            session.context.emit(glance)
            await past(0.1)
            session.context.emit(glance)
            assert await again.next() == {"type": "look", "n": 1}


@in_virtual_time
async def test_turning_the_camera_on_in_a_window_turns_it_off_in_the_other() -> None:
    async with watching() as (session, visit, app), Visit(app) as other:
        await other.hello(session=visit.session)
        other.tell("camera", on=True)
        assert await visit.next() == {"type": "unseen", "text": "the camera is on in another window"}
        session.context.emit(glance)
        assert await other.next() == {"type": "look", "n": 1}
        show(visit, 1, JPEG + b"from the wrong window")
        show(other, 1)
        await other.next()
        assert session.context.read(pictures) == (JPEG,)
        visit.tell("camera", on=False)  # the camera of this window is off already
        await past(0.1)
        assert session.context.read(rawio.camera) is not None


@in_virtual_time
async def test_an_agent_can_refuse_the_camera_and_use_it_again_later() -> None:
    async with watching() as (session, visit, _):
        first = session.context.read(rawio.camera)
        assert first is not None
        first.refuse("the agent cannot see at the moment")
        first.refuse("twice")
        assert await visit.next() == {"type": "unseen", "text": "the agent cannot see at the moment"}
        assert await first.next() is None
        first.mark([rawio.Face((0.0, 0.0, 1.0, 1.0))])
        visit.tell("camera", on=True)
        await past(0.1)
        assert visit.nothing_more()
        session.context.emit(glance)
        assert await visit.next() == {"type": "look", "n": 1}


@pytest.mark.parametrize("data", [b"", b"\x89PNG", JPEG + bytes(LONGEST_PICTURE)])
def test_data_that_is_not_a_small_jpeg_picture_is_refused(data: bytes) -> None:
    @in_virtual_time
    async def refused() -> None:
        async with watching() as (session, visit, _):
            session.context.emit(glance)
            await visit.next()
            show(visit, 1, data)
            assert (await visit.next())["code"] == "malformed"
            show(visit, 1)  # a correct picture is still accepted
            assert (await visit.next())["type"] == "faces"

    refused()


@in_virtual_time
async def test_a_page_whose_agent_cannot_see_answers_camera_frames_with_an_error() -> None:
    async with page() as app, Visit(app) as visit:
        assert "sight" not in await visit.hello()
        await visit.next()
        for kind, field in (("camera", {"on": True}), ("picture", {"n": 1})):
            visit.tell(kind, **field)
            assert (await visit.next())["code"] == "blind"


def test_only_the_page_of_an_agent_that_sees_may_use_the_camera() -> None:
    for modules, allowed in (((eyes,), "camera=(self)"), ((parrot,), "camera=()")):
        with TestClient(webio.app(Agent(*modules, webio)), base_url="http://127.0.0.1:8420") as client:
            assert allowed in client.get("/").headers["permissions-policy"]
