"""The web server: its answers, addresses and checks, its end, and the client in the documentation."""

import asyncio
import io
import json
import re
import signal
import socket
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidStatus

import ravestate as rs
from modules.platform.webio.served import Served, hello, talk
from modules.platform.webio.visit import parrot
from ravestate.modules import webio
from ravestate.modules.platform.webio.server import Server
from ravestate.runtime.agent import Agent
from repo.snippets import blocks_in
from runtime.on_loop import on_loop

TOKEN = "open sesame, please"
PROTOCOL = Path(__file__).parents[4] / "docs" / "reference" / "web-protocol.md"


@pytest.fixture(scope="module")
def served():
    with Served() as served:
        yield served


def test_the_server_serves_the_page_and_its_files(served: Served) -> None:
    with httpx.Client(base_url=f"http://{served.host}") as client:
        page = client.get("/")
        assert page.status_code == 200
        assert page.headers["content-type"] == "text/html; charset=utf-8"
        for name in ("assets/chat.js", "assets/chat.css", "widget.js", "assets/raven.svg"):
            file = client.get(f"/{name}")
            assert (file.status_code, file.headers["content-encoding"]) == (200, "gzip")
            assert client.get(f"/{name}", headers={"if-none-match": file.headers["etag"]}).status_code == 304
        assert "content-encoding" not in client.get("/", headers={"accept-encoding": "identity"}).headers
        assert client.head("/").status_code == 200


@pytest.mark.parametrize(
    "path", ["/nothing", "/../pyproject.toml", "/%2e%2e/rules.py", "/assets", "/assets/", "//", "/ws"]
)
def test_an_unknown_path_is_not_found(served: Served, path: str) -> None:
    assert httpx.get(f"http://{served.host}{path}").status_code == 404


def test_a_post_to_the_page_is_refused(served: Served) -> None:
    assert httpx.post(f"http://{served.host}/", content=b"x").status_code == 405


def test_headers_restrict_scripts_and_frames(served: Served) -> None:
    for path in ("/", "/nothing", "/assets/chat.js"):
        headers = httpx.get(f"http://{served.host}{path}").headers
        policy = headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "script-src 'self';" in policy
        assert "frame-ancestors 'self'" in policy
        assert "unsafe" not in policy
        assert headers["x-content-type-options"] == "nosniff"


def test_a_foreign_host_name_that_resolves_to_this_machine_is_refused(served: Served) -> None:
    answer = httpx.get(f"http://{served.host}/", headers={"host": "evil.example"})
    assert answer.status_code == 403
    assert "this page is not known as 'evil.example'" in answer.text


@on_loop
async def test_a_foreign_origin_is_refused() -> None:
    with Served() as served:
        with pytest.raises(InvalidStatus) as refused:
            async with served.connect(origin="https://evil.example"):
                pass
        assert refused.value.response.status_code == 403
        async with served.connect(origin=f"http://{served.host}") as visit:
            await hello(visit)
            await talk(visit, ["hello"])
        assert served.end() == 0
        assert served.errors == ""


@on_loop
async def test_when_the_server_ends_the_visitors_get_a_message_and_no_error_is_printed() -> None:
    with Served() as served:
        async with served.connect() as visit, served.connect() as silent:
            await hello(visit)
            assert json.loads(await visit.recv())["text"] == "Hello!"
            served.process.send_signal(signal.SIGINT)
            frames = [json.loads(text) async for text in visit]
            assert [frame.get("text") for frame in frames] == ["Bye!", "the agent has been switched off"]
            assert visit.close_code == 1000
            with pytest.raises(ConnectionClosed):
                await silent.recv()
        assert await asyncio.to_thread(served.process.wait) == 0
        served.errors = served.process.communicate()[1]
        assert served.errors == ""


def test_sigterm_ends_the_server_cleanly() -> None:
    with Served() as served:
        assert served.end(signal.SIGTERM) == 0
        assert served.errors == ""


@on_loop
async def test_a_websocket_to_any_other_path_is_not_found_and_not_logged() -> None:
    with Served(token=TOKEN) as served:
        for path in ("/", "/nothing", "/ws/", "/ws/more", "/assets/chat.js"):
            with pytest.raises(InvalidStatus) as refused:
                async with connect(f"ws://{served.host}{path}"):
                    pass
            assert refused.value.response.status_code == 404
        assert served.end() == 0
        assert served.errors == ""


@on_loop
async def test_a_token_with_a_control_character_is_refused_and_not_logged() -> None:
    with Served(token=TOKEN) as served:
        for token in (f"{TOKEN}\0", f"\x1b[0m{TOKEN}", f"{TOKEN}\n", f"{TOKEN}\ud800"):
            async with served.connect() as visit:
                assert (await hello(visit, token=token))["code"] == "token"
                with pytest.raises(ConnectionClosed):
                    await visit.recv()
                assert visit.close_code == 4401
        reader, writer = await asyncio.open_connection("127.0.0.1", served.port)
        writer.write(f"GET /ws HTTP/1.1\r\nhost: {served.host}\r\nauthorization: Bearer {TOKEN}\0\r\n\r\n".encode())
        assert b"400 Bad Request" in await reader.read()
        writer.close()
        assert served.end() == 0
        assert served.errors == ""


def served_by(monkeypatch: pytest.MonkeyPatch, terminals: str) -> tuple[str, str]:
    """Return what a server with a token prints on both outputs. `terminals` names the outputs that are terminals."""
    written = {"stdout": io.StringIO(), "stderr": io.StringIO()}
    for name, output in written.items():
        output.isatty = lambda name=name: name in terminals  # type: ignore[method-assign]
        monkeypatch.setattr(sys, name, output)

    async def announce() -> None:
        agent = Agent(parrot, webio, settings={"webio": {"port": 0, "token": TOKEN}})
        async with Server(agent) as server:
            server.announce()

    asyncio.run(announce())
    out, err = (re.sub(r":\d+/", ":8420/", output.getvalue()) for output in written.values())
    return out, err


LINK = "The agent is at http://127.0.0.1:8420/#token=open%20sesame%2C%20please (Ctrl-C ends it)\n"


def test_a_terminal_shows_the_link_with_the_token(monkeypatch: pytest.MonkeyPatch) -> None:
    assert served_by(monkeypatch, "stdout stderr") == (LINK, "")


@pytest.mark.parametrize("terminal", ["", "stderr"])
def test_the_token_is_shown_only_on_a_terminal(monkeypatch: pytest.MonkeyPatch, terminal: str) -> None:
    out, err = served_by(monkeypatch, terminal)
    assert out == (
        "The agent is at http://127.0.0.1:8420/ (Ctrl-C ends it)\n"
        "To open it, add #token= and the token that you have set (webio.token).\n"
    )
    assert err == (LINK if terminal else "")


def test_a_server_on_all_addresses_shows_the_name_of_the_machine() -> None:
    with Served(token=TOKEN, host="0.0.0.0") as served:
        link = f"http://{socket.gethostname()}:{served.port}/"
        assert served.line == f"The agent is at {link} (Ctrl-C ends it)\n"


def test_a_server_that_other_machines_can_reach_needs_a_token() -> None:
    with pytest.raises(rs.PlatformError, match=r"other machines can reach '0\.0\.0\.0', so a token is needed"):
        rs.run(parrot, webio, settings={"webio": {"host": "0.0.0.0", "port": 0}})


def test_a_port_in_use_is_reported() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(rs.PlatformError, match=f"port {port} is in use: .* --set webio.port=0"):
            rs.run(parrot, webio, settings={"webio": {"port": port}})


@pytest.mark.parametrize("host", ["192.0.2.1", "nowhere.invalid", "127.0.0..1"])
def test_an_address_of_another_machine_is_reported(host: str) -> None:
    with pytest.raises(rs.PlatformError, match=host.replace(".", r"\.")):
        rs.run(parrot, webio, settings={"webio": {"host": host, "port": 0, "token": TOKEN}})


def test_the_page_can_be_mounted_in_an_application() -> None:
    from starlette.applications import Starlette
    from starlette.routing import Mount
    from starlette.testclient import TestClient

    chat = webio.app(Agent(parrot, webio))
    whole = Starlette(routes=[Mount("/talk", chat)], lifespan=lambda _: chat.router.lifespan_context(chat))
    with TestClient(whole, base_url="http://127.0.0.1") as client:
        assert "<title>" in client.get("/talk/").text
        assert client.get("/talk/assets/chat.js").status_code == 200
        with client.websocket_connect("ws://127.0.0.1/talk/ws") as visit:
            visit.send_json({"type": "hello", "v": 1})
            assert visit.receive_json()["type"] == "welcome"
            assert visit.receive_json()["text"] == "Hello!"
            visit.send_json({"type": "bye"})
            assert [visit.receive_json()["text"] for _ in range(2)] == ["Bye!", "you left"]
            assert visit.receive()["type"] == "websocket.close"
    assert len(chat.state.sessions) == 0


@pytest.mark.parametrize(("path", "host"), [("/else", b"localhost"), ("/ws", b"evil.example")])
def test_without_denial_responses_a_websocket_is_refused_by_closing_it(path: str, host: bytes) -> None:
    """Some servers, e.g. daphne, lack this ASGI extension."""
    chat = webio.app(Agent(parrot, webio))
    sent: list[Any] = []

    async def receive() -> dict[str, str]:
        return {"type": "websocket.connect"}

    async def send(message: Any) -> None:
        sent.append(message)

    scope = {"type": "websocket", "path": path, "root_path": "", "headers": [(b"host", host)], "subprotocols": []}
    asyncio.run(chat(scope, receive, send))
    assert [message["type"] for message in sent] == ["websocket.close"]


def test_additional_routes_have_the_same_access_checks() -> None:
    from starlette.requests import Request
    from starlette.responses import PlainTextResponse
    from starlette.routing import Route
    from starlette.testclient import TestClient

    def look(request: Request) -> PlainTextResponse:
        return PlainTextResponse(f"{len(request.app.state.sessions)} conversations")

    chat = webio.app(Agent(parrot, webio), [Route("/look", look)])
    with TestClient(chat, base_url="http://127.0.0.1") as client:
        assert client.get("/look").text == "0 conversations"
        assert client.get("/look", headers={"host": "evil.example"}).status_code == 403


@pytest.fixture
def ask(tmp_path: Path) -> Callable[[str], subprocess.CompletedProcess[str]]:
    """Return a function that runs the example client of the protocol's page. It connects the client with a host."""

    def run(host: str) -> subprocess.CompletedProcess[str]:
        [client] = [block for block in blocks_in(PROTOCOL) if block.title == "ask.py"]
        script = tmp_path / "ask.py"
        script.write_text(client.code.replace("127.0.0.1:8420", host), encoding="utf-8")
        return subprocess.run([sys.executable, script, "hi"], capture_output=True, text=True, timeout=20)

    return run


def test_the_documented_client_gets_an_answer(
    served: Served, ask: Callable[[str], subprocess.CompletedProcess[str]]
) -> None:
    said = ask(served.host).stdout.splitlines()
    assert "hi" in said
    assert set(said) <= {"hi", "Hello!"}  # the greeting can come before the answer


def test_the_documented_client_says_when_no_server_listens(
    ask: Callable[[str], subprocess.CompletedProcess[str]],
) -> None:
    with socket.socket() as nobody:  # the port is bound, but nothing listens on it
        nobody.bind(("127.0.0.1", 0))
        done = ask(f"127.0.0.1:{nobody.getsockname()[1]}")
    assert done.returncode == 1
    assert done.stderr == "No agent answers: start one, e.g. ravestate run webio hibye\n"
