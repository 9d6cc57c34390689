"""``ravestate model`` lists, fetches and removes models. A stand-in for the model hub serves the downloads."""

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from huggingface_hub import file_download

from cli.examples import call
from modules.skill.wildtalk.stand_ins import CONTENT, MODEL, Hub, Quiet, serving, write_gguf
from ravestate.modules.skill.wildtalk import found_models, local_servers, model_store
from ravestate.modules.skill.wildtalk.download import size_of

Capture = pytest.CaptureFixture[str]


@pytest.fixture(autouse=True)
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder for models. The catalogue has one small model, and the machine has no other."""
    folder = tmp_path / "models"
    monkeypatch.setattr(model_store, "folder", lambda: folder)
    monkeypatch.setattr(model_store, "catalogue", lambda: {MODEL.name: MODEL})
    monkeypatch.setattr(model_store, "RECOMMENDED", MODEL.name)
    return folder


@pytest.fixture
def hub(monkeypatch: pytest.MonkeyPatch) -> Iterator[Hub]:
    with Hub().running() as running:
        monkeypatch.setenv("HF_ENDPOINT", running.url)
        yield running


def test_a_model_is_fetched_listed_used_and_removed(hub: Hub, place: Path, capsys: Capture) -> None:
    assert call(capsys, "model", "get") == (
        0,
        f"tiny is installed, and is now the default for small talk: {place / 'tiny.gguf'}\n",
        "tiny: 1 MB, Apache-2.0, from someone/tiny-GGUF\n",
    )
    assert (place / "tiny.gguf").read_bytes() == CONTENT
    code, out, _ = call(capsys, "model", "list")
    assert code == 0 and "tiny  1.0 billion  1 MB  Apache-2.0  default  tests\n" in out
    assert "Now: small talk by tiny.gguf (1.0 billion parameters)" in out
    asked = len(hub.requests)
    assert call(capsys, "model", "get", "tiny")[::2] == (0, "")
    assert len(hub.requests) == asked
    assert call(capsys, "model", "remove", "tiny") == (
        0,
        f"removed {place / 'tiny.gguf'}\nthere is no longer a default model\n",
        "",
    )
    assert "Now: small talk with authored replies" in call(capsys, "model", "list")[1]
    code, _, errors = call(capsys, "model", "remove", "tiny")
    assert (code, errors) == (1, f"ravestate model: tiny is not installed in {place}\n")


def test_an_interrupted_download_is_kept_and_the_message_says_how_to_continue(
    hub: Hub, place: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = file_download.http_get

    def stop(url: str, part: Any, **_: Any) -> None:
        part.write(CONTENT[:200_000])
        raise KeyboardInterrupt

    monkeypatch.setattr(file_download, "http_get", stop)
    code, out, errors = call(capsys, "model", "get")
    assert (code, out) == (130, "")
    kept = f"{size_of(200_000)} of {size_of(MODEL.size)} are kept in {MODEL.part}"
    assert errors.endswith(f"ravestate model: interrupted; {kept}, and the same command continues\n")
    assert "39% fetched" in call(capsys, "model", "list")[1]
    monkeypatch.setattr(file_download, "http_get", real)
    assert call(capsys, "model", "get")[0] == 0
    assert hub.requests[0][1]["range"] == "bytes=200000-"


def test_an_unfinished_download_can_be_removed(place: Path, capsys: Capture) -> None:
    place.mkdir()
    MODEL.part.touch()
    assert call(capsys, "model", "remove", "tiny") == (0, f"removed {MODEL.part}\n", "")


def test_an_installed_model_that_was_cut_off_is_fetched_again(hub: Hub, place: Path, capsys: Capture) -> None:
    place.mkdir()
    (place / "tiny.gguf").write_bytes(CONTENT[:1000])
    assert "installed" not in call(capsys, "model", "list")[1]
    assert call(capsys, "model", "get")[0] == 0
    assert (place / "tiny.gguf").read_bytes() == CONTENT


def test_a_default_that_cannot_be_written_gives_a_message(hub: Hub, place: Path, capsys: Capture) -> None:
    (place / "default").mkdir(parents=True)
    code, _, errors = call(capsys, "model", "get")
    assert code == 1 and "Traceback" not in errors
    assert f"the default model stays as it was, because {place / 'default'} cannot be written: Is a directory" in errors
    assert MODEL.installed


def test_a_model_that_another_process_fetches_is_not_removed(place: Path, capsys: Capture) -> None:
    place.mkdir()
    MODEL.part.write_bytes(CONTENT[:1000])
    code = f"import fcntl; part = open({str(MODEL.part)!r}, 'ab'); fcntl.lockf(part, fcntl.LOCK_EX); print(1, flush=True); input()"
    pipe = subprocess.PIPE
    with subprocess.Popen([sys.executable, "-c", code], stdin=pipe, stdout=pipe) as other:
        assert other.stdout is not None and other.stdout.readline()
        found = call(capsys, "model", "remove", "tiny")
        other.communicate(b"\n")
    assert found == (1, "", "ravestate model: another process is fetching tiny: wait until it has finished\n")
    assert MODEL.part.read_bytes() == CONTENT[:1000]
    assert call(capsys, "model", "remove", "tiny")[0] == 0
    assert not MODEL.part.exists()


def test_failures_and_wrong_use_give_messages(hub: Hub, capsys: Capture) -> None:
    hub.script = [404]
    code, _, errors = call(capsys, "model", "get")
    assert code == 1 and "ravestate model: http://127.0.0.1:" in errors and "take another model" in errors
    code, _, errors = call(capsys, "model", "get", "tinny")
    assert code == 2 and "there is no model 'tinny'; did you mean 'tiny'?; there are: tiny" in errors
    assert call(capsys, "model")[0] == 2


def test_the_list_has_other_models_and_servers_on_this_machine(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Server(Quiet):
        def do_GET(self) -> None:
            self.reply(json.dumps({"object": "list", "data": [{"id": "llama3.2", "object": "model"}]}).encode())

    monkeypatch.setenv("RAVESTATE_WILDTALK_SEARCH", "true")
    file = write_gguf(tmp_path / "other" / "chat.gguf", 1_200_000_000)
    monkeypatch.setattr(found_models, "folders", lambda: [tmp_path])
    with serving(Server) as port:
        monkeypatch.setattr(local_servers, "PORTS", {port: "Ollama"})
        out = call(capsys, "model", "list")[1]
    assert f"{file}  (1.2 billion, 0 MB)" in out
    assert f"Ollama at http://127.0.0.1:{port}/v1: llama3.2" in out
    assert f"Now: small talk by llama3.2 (Ollama at http://127.0.0.1:{port}/v1)" in out
