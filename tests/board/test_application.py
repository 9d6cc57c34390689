"""The board's routes: recordings that are sent to be looked at."""

import asyncio
import json
from collections.abc import AsyncGenerator
from pathlib import Path

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


def test_a_recording_that_was_sent_is_looked_at(trace: bytes) -> None:
    @in_virtual_time
    async def test() -> None:
        async with board() as app, client(app) as browser:
            answer = await browser.post("/board/recordings", content=trace)
            assert answer.status_code == 201
            async with Look(app) as look:
                welcome = await look.begin(recording=answer.json()["recording"])
                assert (welcome["title"], welcome["live"]) == ("Elske", False)

    test()


def test_of_recordings_that_come_together_one_is_read_at_a_time(
    trace: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    taken: list[str] = []

    @in_virtual_time
    async def test() -> None:
        async def slowly(name: str) -> AsyncGenerator[bytes]:
            taken.append(f"{name} begins")
            yield trace[:100]
            await passing(5)
            yield trace[100:]
            taken.append(f"{name} ends")

        async with board() as app, client(app) as browser:
            answers = await asyncio.gather(
                *(browser.post("/board/recordings", content=slowly(name)) for name in ("one", "other"))
            )
            assert [answer.status_code for answer in answers] == [201, 201]

    test()
    assert taken == ["one begins", "one ends", "other begins", "other ends"]


def test_what_is_too_large_is_refused_and_the_next_one_is_taken(
    trace: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
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


def test_what_the_page_exports_at_most_can_be_sent_back(trace: bytes) -> None:
    records = json.loads(trace)["records"]
    a_record = len(json.dumps(records)) / len(records)
    assert 1.5 * a_record * 125_000 < application.LARGEST  # names and payloads are longer elsewhere


@in_virtual_time
async def test_who_goes_away_in_the_middle_leaves_the_way_free() -> None:
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
async def test_a_site_that_may_embed_the_chat_may_not_connect_to_the_board_nor_show_it() -> None:
    site = "https://museum.example"
    async with board(origins=(site,)) as app, client(app) as browser:
        async with Visit(app, origin=site) as visit:
            assert (await visit.hello())["type"] == "welcome"
        async with Look(app, origin=site) as look:
            refused = await look.next()
            assert (look.accepted, refused["status"]) == (False, 403)
        async with Look(app, origin=HERE) as look:
            assert (await look.begin())["type"] == "welcome"
        assert (
            await browser.post("/board/recordings", content=b"{}", headers={"origin": site})
        ).status_code == 403
        framing = {}
        for path in ("/", "/board", "/board/", "/board/index.html", "/board/nothing", "/board/recordings"):
            policy = (await browser.get(path)).headers["content-security-policy"]
            framing[path] = policy.rpartition("; ")[2]
        assert framing.pop("/") == f"frame-ancestors 'self' {site}"
        assert framing.pop("/board") == f"frame-ancestors 'self' {site}"  # it leads there
        assert set(framing.values()) == {"frame-ancestors 'self'"}


@in_virtual_time
async def test_mounted_in_another_application_too() -> None:
    site = "https://museum.example"
    async with board(origins=(site,)) as chat:
        museum = Starlette(routes=[Mount("/guide", chat)])
        async with client(museum) as browser:
            answer = await browser.get("/guide/board/")
            assert answer.status_code == 200
            assert answer.headers["content-security-policy"].endswith("frame-ancestors 'self'")
            answer = await browser.get("/guide/board/", headers={"origin": site})
            assert answer.status_code == 403
