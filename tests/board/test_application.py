"""The board's routes: uploads of recordings, other sites, and mounting."""

import asyncio
import json
from collections.abc import AsyncGenerator, Callable
from pathlib import Path
from typing import Any

import httpx
import pytest
from starlette.applications import Starlette
from starlette.routing import Mount

from board.looking import Look, board, gossip, in_virtual_time, passing
from modules.platform.webio.visit import Visit, parrot
from ravestate.board import application
from ravestate.board.trace_file import save_trace
from ravestate.testing import simulate

HERE = "http://127.0.0.1:8420"


def client(app: Starlette) -> httpx.AsyncClient:
    return httpx.AsyncClient(transport=httpx.ASGITransport(app), base_url=HERE)


@pytest.fixture
def trace(tmp_path: Path) -> bytes:
    with simulate(gossip, parrot) as sim:
        sim.say("Really?")
        sim.advance(5.0)
        save_trace(tmp_path / "trace.json", sim.context.policy, sim.trace, title="Elske")
    return (tmp_path / "trace.json").read_bytes()


def test_an_uploaded_recording_can_be_opened(trace: bytes) -> None:
    @in_virtual_time
    async def test() -> None:
        async with board() as app, client(app) as browser:
            answer = await browser.post("/board/recordings", content=trace)
            assert answer.status_code == 201
            async with Look(app) as look:
                welcome = await look.begin(recording=answer.json()["recording"])
                assert (welcome["title"], welcome["live"]) == ("Elske", False)

    test()


def test_simultaneous_uploads_are_read_one_at_a_time(trace: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    taken: list[str] = []

    async def slowly(work: Callable[..., Any], *arguments: Any) -> Any:
        taken.append("begins")
        await passing(5)
        taken.append("ends")
        return work(*arguments)

    @in_virtual_time
    async def test() -> None:
        async with board() as app, client(app) as browser:
            with monkeypatch.context() as patch:
                patch.setattr(asyncio, "to_thread", slowly)
                answers = await asyncio.gather(*(browser.post("/board/recordings", content=trace) for _ in range(2)))
            assert [answer.status_code for answer in answers] == [201, 201]

    test()
    assert taken == ["begins", "ends"] * 2


def test_a_conversation_is_answered_while_a_recording_is_read(trace: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    async def slowly(work: Callable[..., Any], *arguments: Any) -> Any:
        await passing(30)
        return work(*arguments)

    @in_virtual_time
    async def test() -> None:
        async with board() as app, client(app) as browser, Visit(app) as visit:
            await visit.hello()
            with monkeypatch.context() as patch:
                patch.setattr(asyncio, "to_thread", slowly)
                upload = asyncio.create_task(browser.post("/board/recordings", content=trace))
                await passing(1)
                visit.say("Is it raining?")
                while "agent: Yes." not in await visit.messages(1):
                    pass
                assert not upload.done()
                assert (await upload).status_code == 201

    test()


async def drops(data: bytes, every: float, each: int) -> AsyncGenerator[bytes]:
    """Yield parts of `each` bytes, with a pause of `every` seconds after each."""
    for start in range(0, len(data), each):
        yield data[start : start + each]
        await passing(every)


def test_a_slow_upload_does_not_delay_other_uploads(trace: bytes) -> None:
    @in_virtual_time
    async def test() -> None:
        clock = asyncio.get_running_loop().time
        async with board() as app, client(app) as browser:
            slow = asyncio.create_task(
                browser.post("/board/recordings", content=drops(trace, 60.0, 1 + len(trace) // 3))
            )
            await passing(1)
            before = clock()
            assert (await browser.post("/board/recordings", content=trace)).status_code == 201
            assert clock() - before < 1
            assert (await slow).status_code == 201

    test()


def test_too_many_simultaneous_uploads_are_refused(trace: bytes) -> None:
    @in_virtual_time
    async def test() -> None:
        async with board() as app, client(app) as browser:
            slow = [
                asyncio.create_task(browser.post("/board/recordings", content=drops(trace, 5.0, 1 + len(trace) // 3)))
                for _ in range(application.AT_ONCE)
            ]
            await passing(1)
            answer = await browser.post("/board/recordings", content=trace)
            assert (answer.status_code, answer.headers["retry-after"]) == (503, "10")
            assert "try again" in answer.text
            assert {answer.status_code for answer in await asyncio.gather(*slow)} == {201}
            assert (await browser.post("/board/recordings", content=trace)).status_code == 201

    test()


@in_virtual_time
async def test_an_upload_that_takes_too_long_is_refused() -> None:
    clock = asyncio.get_running_loop().time
    async with board() as app, client(app) as browser:
        for _ in range(2):
            before = clock()
            answers = await asyncio.gather(
                *(
                    browser.post("/board/recordings", content=drops(b" " * 1000, 1.0, 1))
                    for _ in range(application.AT_ONCE)
                )
            )
            assert {(answer.status_code, answer.text) for answer in answers} == {
                (408, "the upload took more than 300 s")
            }
            assert clock() - before == pytest.approx(application.LONGEST)  # pyright: ignore[reportUnknownMemberType]


def test_a_recording_that_is_too_large_is_refused(trace: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(application, "LARGEST", len(trace))

    @in_virtual_time
    async def test() -> None:
        async with board() as app, client(app) as browser:
            answer = await browser.post("/board/recordings", content=trace + b" ")
            assert (answer.status_code, answer.text) == (
                413,
                f"a recording has at most {len(trace):,} bytes",
            )
            assert (await browser.post("/board/recordings", content=b"{}")).status_code == 422
            assert (await browser.post("/board/recordings", content=trace)).status_code == 201

    test()


def test_the_largest_export_can_be_uploaded(trace: bytes) -> None:
    records = json.loads(trace)["records"]
    a_record = len(json.dumps(records)) / len(records)
    assert 1.5 * a_record * 125_000 < application.LARGEST  # other agents have longer names and payloads


@in_virtual_time
async def test_an_aborted_upload_does_not_delay_other_uploads() -> None:
    async with board() as app, client(app) as browser:
        scope = {
            "type": "http", "asgi": {"version": "3.0"}, "http_version": "1.1", "method": "POST", "scheme": "http",
            "path": "/board/recordings", "raw_path": b"/board/recordings", "root_path": "", "query_string": b"",
            "headers": [(b"host", b"127.0.0.1:8420")], "client": ("127.0.0.1", 50000), "server": None,
        }  # fmt: skip
        messages = [{"type": "http.request", "body": b"{", "more_body": True}, {"type": "http.disconnect"}]

        async def receive() -> dict[str, object]:
            return messages.pop(0)

        async def send(_: object) -> None: ...

        await app(scope, receive, send)
        assert messages == []
        assert (await browser.post("/board/recordings", content=json.dumps([]))).status_code == 422


@in_virtual_time
async def test_a_site_that_may_embed_the_chat_can_neither_embed_nor_use_the_board() -> None:
    site = "https://museum.example"
    async with board(origins=(site,)) as app, client(app) as browser:
        async with Visit(app, origin=site) as visit:
            assert (await visit.hello())["type"] == "welcome"
        async with Look(app, origin=site) as look:
            refused = await look.next()
            assert (look.accepted, refused["status"]) == (False, 403)
        async with Look(app, origin=HERE) as look:
            assert (await look.begin())["type"] == "welcome"
        assert (await browser.post("/board/recordings", content=b"{}", headers={"origin": site})).status_code == 403
        framing = {}
        for path in ("/", "/board", "/board/", "/board/index.html", "/board/nothing", "/board/recordings"):
            policy = (await browser.get(path)).headers["content-security-policy"]
            framing[path] = policy.rpartition("; ")[2]
        assert framing.pop("/") == f"frame-ancestors 'self' {site}"
        assert framing.pop("/board") == f"frame-ancestors 'self' {site}"  # only a redirect to /board/
        assert set(framing.values()) == {"frame-ancestors 'self'"}


@in_virtual_time
async def test_the_board_can_be_mounted_in_another_application() -> None:
    site = "https://museum.example"
    async with board(origins=(site,)) as chat:
        museum = Starlette(routes=[Mount("/guide", chat)])
        async with client(museum) as browser:
            answer = await browser.get("/guide/board/")
            assert answer.status_code == 200
            assert answer.headers["content-security-policy"].endswith("frame-ancestors 'self'")
            answer = await browser.get("/guide/board/", headers={"origin": site})
            assert answer.status_code == 403
