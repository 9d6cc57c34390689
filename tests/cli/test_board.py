"""``ravestate board``: the pages that it serves, and its messages for wrong use."""

import json
import re
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.sync.client import connect

from board.test_trace_file import recorded
from ravestate.cli import main
from ravestate.errors import PlatformError
from ravestate.modules.modality.visionio import places
from ravestate.modules.platform.voiceio import models as speech_models
from ravestate.modules.platform.webio import server
from ravestate.modules.skill.wildtalk import found_models, local_servers
from ravestate.runtime.agent import Agent

AGENT = """
import ravestate as rs
from ravestate.modules import rawio

echo = rs.Module("echo", requires=(rawio,))

@echo.rule(when=rawio.input.changed, writes=rawio.output)
async def repeat(ctx):
    ctx[rawio.output] = ctx.payload(rawio.input.changed)
"""


class Command:
    """``ravestate board`` in a separate process, on a free port."""

    def __init__(self, *arguments: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "ravestate", "board", *arguments, "--set", "webio.port=0"],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip

    def address(self, what: str) -> str:
        """Return the printed address of the agent, or of the board."""
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        found = re.match(rf"The {what} is at (http://\S+)", line)
        if found is None:
            raise AssertionError(line + self.process.communicate()[1])
        return found[1]

    def end(self) -> int:
        """End the process as Ctrl-C does; return its exit code."""
        self.process.send_signal(signal.SIGINT)
        self.process.communicate(timeout=20)
        return self.process.returncode


def test_the_printed_addresses_lead_to_the_agent_and_the_board(tmp_path: Path) -> None:
    (tmp_path / "echo.py").write_text(AGENT, "utf-8")
    command = Command(str(tmp_path / "echo.py"), "--set", "webio.token=open-sesame-please")
    try:
        agent, board = command.address("agent"), command.address("board")
        assert board == f"{agent}board/"  # no token, because the output is not a terminal
        page = httpx.get(board)
        assert "board.js" in page.text
        assert "script-src 'self'" in page.headers["content-security-policy"]
        assert httpx.get(agent).status_code == 200
        sent = f"{board}recordings"
        assert httpx.post(sent, content=b"{}").status_code == 401
        authorised = {"authorization": "Bearer open-sesame-please"}
        assert httpx.post(sent, content=b"{}", headers=authorised).status_code == 422
        assert httpx.post(sent, content=b"{}", headers={**authorised, "origin": "https://x.example"}).status_code == 403
    finally:
        assert command.end() == 0


def test_without_modules_the_command_serves_the_complete_agent(tmp_path: Path) -> None:
    command = Command("--without", "wildtalk")
    try:
        agent = command.address("agent")
        command.address("board")
        with connect(agent.replace("http", "ws", 1) + "ws") as socket:
            socket.send(json.dumps({"type": "hello", "v": 1}))
            socket.send(json.dumps({"type": "say", "id": "1", "text": "Hello"}))
            frames = (json.loads(frame) for frame in socket)
            answer = next(f for f in frames if f["type"] == "message" and f["from"] == "agent")
            assert answer["text"]
    finally:
        assert command.end() == 0


@pytest.fixture
def served(monkeypatch: pytest.MonkeyPatch) -> list[Agent]:
    """Return a list to which each command adds the agent that it serves. The server ends immediately."""
    agents: list[Agent] = []

    class Stub:
        def __init__(self, agent: Agent, *_: Any) -> None:
            agents.append(agent)

        async def __aenter__(self) -> "Stub":
            return self

        async def __aexit__(self, *_: object) -> None: ...

        def announce(self, _: object) -> None: ...

        def link(self, _: str) -> str:
            return "http://127.0.0.1"

        async def until_failed(self) -> None: ...

    monkeypatch.setattr(server, "Server", Stub)
    return agents


def test_without_a_language_model_the_page_says_how_to_get_one(
    served: list[Agent], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("RAVESTATE_WILDTALK_SEARCH", "true")
    monkeypatch.setattr(local_servers, "PORTS", {})
    monkeypatch.setattr(found_models, "folders", list)
    note = "Small talk with authored replies. To talk with a language model: ravestate model get."
    assert main(["board", "wildtalk"]) == 0
    assert served[0].settings["webio"].note == note
    assert capsys.readouterr().err == f"ravestate board: s{note[1:-1]}\n"
    assert main(["board", "wildtalk", "--set", "wildtalk.base_url=http://here/v1", "--set", "wildtalk.model=big"]) == 0
    assert served[1].settings["webio"].note is None


@pytest.mark.parametrize(
    ("arguments", "models", "has"),
    [([], True, True), ([], False, False), (["--without", "voiceio"], True, False), (["hibye"], True, False)],
)
def test_the_complete_agent_has_voiceio_only_if_speech_is_set_up(
    served: list[Agent], monkeypatch: pytest.MonkeyPatch, arguments: list[str], models: bool, has: bool
) -> None:
    monkeypatch.setattr(speech_models, "whisper_models", lambda: iter([("base", Path())] if models else []))
    assert main(["board", *arguments]) == 0
    assert ("voiceio" in [module.name for module in served[0].policy.modules]) is has


@pytest.mark.parametrize(
    ("arguments", "there", "seen"),
    [
        ([], True, {"visionio", "charades"}),
        ([], False, set()),
        (["--without", "visionio"], True, set()),
        (["--without", "charades"], True, {"visionio"}),
    ],
)
def test_the_complete_agent_has_visionio_only_if_the_eyes_are_set_up(
    served: list[Agent], monkeypatch: pytest.MonkeyPatch, arguments: list[str], there: bool, seen: set[str]
) -> None:
    def eyes(_: object = None) -> str:
        if not there:
            raise PlatformError("visionio needs the packages of the eyes")
        return "python"

    monkeypatch.setattr(places, "eyes_python", eyes)
    assert main(["board", *arguments]) == 0
    assert {module.name for module in served[0].policy.modules} & {"visionio", "charades"} == seen


def test_the_option_open_shows_a_recorded_trace_without_an_agent(tmp_path: Path) -> None:
    recorded(tmp_path / "trace.json")
    command = Command("--open", str(tmp_path / "trace.json"))
    try:
        board = command.address("board")
        assert httpx.get(board).status_code == 200
        there = httpx.get(board.removesuffix("board/"), follow_redirects=True)
        assert str(there.url) == board  # a recording has no agent to talk with
        sent = httpx.post(f"{board}recordings", content=(tmp_path / "trace.json").read_bytes())
        assert sent.status_code == 201
        assert sent.json()["recording"]
        assert httpx.get(f"{board}recordings").status_code in (404, 405)
    finally:
        assert command.end() == 0


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["--without", "nlpp"], 2, "the agent has no such module; did you mean 'nlp'?"),
        (["hibye", "--without", "nlp"], 2, "--without works only on the complete agent"),
        (["hibye", "--open", "trace.json"], 2, "leave the modules out"),
        (["--open", "gone.json"], 1, "cannot read gone.json"),
        (["nothing_like_it"], 2, "there is no module 'nothing_like_it'"),
        (["hibye", "conio"], 1, "webio has many users, conio has one"),
        (["hibye", "--set", "webio.host=0.0.0.0"], 1, "a token is needed"),
    ],
)  # fmt: skip
def test_wrong_arguments_give_a_message(
    arguments: list[str], code: int, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["board", *arguments]) == code
    assert words in capsys.readouterr().err
