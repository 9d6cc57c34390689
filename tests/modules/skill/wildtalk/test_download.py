"""The download of a model from a stand-in for the hub: in one piece, in parts, and with all kinds of errors."""

import errno
import fcntl
import io
import logging
import shutil
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from huggingface_hub import constants, file_download
from huggingface_hub.utils import enable_progress_bars

from modules.skill.wildtalk.stand_ins import CONTENT, MODEL, PATH, Hub
from ravestate.errors import PlatformError
from ravestate.modules.skill.wildtalk import model_store
from ravestate.modules.skill.wildtalk.download import download, interrupted, size_of


@pytest.fixture
def hub(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Hub]:
    monkeypatch.setattr(model_store, "folder", lambda: tmp_path / "models")
    monkeypatch.setattr(time, "sleep", lambda _: None)
    monkeypatch.setattr(constants, "DOWNLOAD_CHUNK_SIZE", 10_000)  # a broken connection loses the last chunk
    enable_progress_bars()
    for name in ("HF_TOKEN", "HF_HUB_OFFLINE"):
        monkeypatch.delenv(name, raising=False)
    with Hub().running() as running:
        monkeypatch.setenv("HF_ENDPOINT", f"{running.url}/")
        yield running


def fetch() -> None:
    """Fetch the model."""
    download(MODEL)
    assert MODEL.path.read_bytes() == CONTENT
    assert not MODEL.part.exists()


def ranges(hub: Hub) -> list[str]:
    return [headers.get("range", "") for path, headers in hub.requests if path == PATH]


def test_a_file_is_fetched_from_its_revision_and_verified(hub: Hub) -> None:
    fetch()
    assert [path for path, _ in hub.requests] == [PATH, "/blob"]


@pytest.mark.parametrize("terminal", [True, False])
def test_the_progress_is_shown_only_on_a_terminal(hub: Hub, monkeypatch: pytest.MonkeyPatch, terminal: bool) -> None:
    screen = io.StringIO()
    monkeypatch.setattr(screen, "isatty", lambda: terminal)
    monkeypatch.setattr("sys.stderr", screen)
    fetch()
    assert ("Fetching tiny" in screen.getvalue(), "100%" in screen.getvalue()) == (terminal, terminal)


def test_a_download_continues_where_the_connection_broke(hub: Hub) -> None:
    hub.script = [("cut", 100_000), ("cut", 50_000)]
    fetch()
    assert ranges(hub) == ["", "bytes=100000-", "bytes=150000-"]


def test_an_interrupted_download_keeps_the_finished_part_and_is_continued_later(
    hub: Hub, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(_: float) -> None:
        raise KeyboardInterrupt

    hub.script = [("cut", 200_000)]
    with monkeypatch.context() as patch:
        patch.setattr(time, "sleep", stop)
        with pytest.raises(KeyboardInterrupt):
            download(MODEL)
    assert MODEL.part.read_bytes() == CONTENT[:200_000]
    assert not MODEL.path.exists()
    assert interrupted(MODEL) == (
        f"interrupted; {size_of(200_000)} of {size_of(MODEL.size)} are kept in {MODEL.part}, and the same command continues"
    )
    fetch()
    assert ranges(hub) == ["", "bytes=200000-"]


def test_if_the_hub_ignores_the_range_the_download_begins_again(hub: Hub) -> None:
    hub.script = [("cut", 1000), "whole"]
    fetch()


def test_a_complete_part_is_only_verified(hub: Hub) -> None:
    MODEL.part.parent.mkdir()
    MODEL.part.write_bytes(CONTENT)
    fetch()
    assert hub.requests == []


def test_a_part_that_is_too_long_is_fetched_again(hub: Hub) -> None:
    MODEL.part.parent.mkdir()
    MODEL.part.write_bytes(CONTENT + b"more")
    fetch()
    assert ranges(hub) == [""]


@pytest.mark.parametrize("content", [b"x" * MODEL.size, CONTENT + b"more", CONTENT[:-1] + b"x"])
def test_a_file_with_another_checksum_is_removed(hub: Hub, content: bytes) -> None:
    hub.content = content
    with pytest.raises(
        PlatformError, match=rf"is not tiny\.gguf: its SHA-256 is \w{{64}}, not {MODEL.sha256}.*removed"
    ):
        fetch()
    assert not MODEL.path.exists() and not MODEL.part.exists()


def test_a_request_that_a_busy_hub_refuses_is_repeated(hub: Hub) -> None:
    hub.script = [429, 408]
    fetch()
    assert len(ranges(hub)) == 3


@pytest.mark.parametrize(
    ("status", "mend"),
    [
        (404, "take another model"),
        (401, "HF_TOKEN"),
        (403, "HF_TOKEN"),
        (400, "is HF_ENDPOINT right"),
        (503, "wait, and repeat the command"),
    ],
)
def test_a_refusal_is_final_and_says_what_to_do(hub: Hub, status: int, mend: str) -> None:
    hub.script = [status]
    with pytest.raises(PlatformError, match=mend):
        fetch()
    assert len(hub.requests) == 1


def test_without_a_network_the_message_says_what_to_do(hub: Hub, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HF_ENDPOINT", "http://ada:pw@127.0.0.1:9")
    with pytest.raises(PlatformError, match=r"^127.0.0.1:9 does not deliver .*refused.*Check the network") as failure:
        fetch()
    assert "copy any chat model in GGUF format into" in str(failure.value)
    assert list(MODEL.part.parent.iterdir()) == []


@pytest.mark.parametrize("address", ["http://here:port", "here", "ftp://here"])
def test_an_endpoint_that_is_not_a_web_address_is_reported(
    hub: Hub, monkeypatch: pytest.MonkeyPatch, address: str
) -> None:
    monkeypatch.setenv("HF_ENDPOINT", address)
    with pytest.raises(PlatformError, match="HF_ENDPOINT is not a web address"):
        fetch()


def test_a_download_that_never_began_leaves_no_file(hub: Hub) -> None:
    hub.script = [404]
    with pytest.raises(PlatformError):
        fetch()
    assert list(MODEL.part.parent.iterdir()) == []
    assert interrupted(MODEL) == "interrupted; nothing had arrived yet"


def test_offline_mode_forbids_a_download(hub: Hub, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HF_HUB_OFFLINE", "1")
    with pytest.raises(PlatformError, match="HF_HUB_OFFLINE"):
        fetch()
    assert hub.requests == []


def test_a_full_disk_is_reported_before_the_first_byte(hub: Hub, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=1000))
    with pytest.raises(PlatformError, match=r"tiny needs \d+ MB at .*, where 0 MB are free"):
        fetch()
    assert hub.requests == []


@pytest.mark.parametrize(("code", "message"), [(errno.ENOSPC, "the disk is full"), (errno.EROFS, "cannot be written")])
def test_a_disk_error_during_the_download_keeps_the_part(
    hub: Hub, monkeypatch: pytest.MonkeyPatch, code: int, message: str
) -> None:
    def fail(url: str, part: Any, **_: Any) -> None:
        part.write(CONTENT[:1000])
        raise OSError(code, "Failure")

    with monkeypatch.context() as patch, pytest.raises(PlatformError, match=message):
        patch.setattr(file_download, "http_get", fail)
        fetch()
    assert MODEL.part.stat().st_size == 1000
    fetch()
    assert ranges(hub) == ["bytes=1000-"]


def test_two_processes_cannot_fetch_the_same_model_at_the_same_time(hub: Hub) -> None:

    def locked(*_: Any) -> None:
        raise BlockingIOError

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fcntl, "lockf", locked)
        with pytest.raises(PlatformError, match="another process is fetching tiny"):
            fetch()


def test_the_token_goes_only_to_the_hub_and_never_to_the_log(
    hub: Hub, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.DEBUG)
    monkeypatch.setenv("HF_TOKEN", "hf_s3cret\n")
    fetch()
    assert [headers.get("authorization") for _, headers in hub.requests] == ["Bearer hf_s3cret", None]
    hub.script = [403]
    MODEL.path.unlink()
    with pytest.raises(PlatformError) as failure:
        fetch()
    assert "s3cret" not in caplog.text + str(failure.value)


def test_the_token_does_not_go_to_an_unencrypted_mirror(hub: Hub, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[dict[str, str]] = []
    monkeypatch.setenv("HF_TOKEN", "hf_s3cret")
    monkeypatch.setattr(file_download, "http_get", lambda *_, headers, **__: seen.append(headers))
    for address in ("http://mirror.example", "https://mirror.example"):
        monkeypatch.setenv("HF_ENDPOINT", address)
        with pytest.raises(PlatformError, match="is not tiny"):
            fetch()
    assert ["Authorization" in headers for headers in seen] == [False, True]


def test_without_huggingface_hub_the_message_names_the_command_that_installs_it(
    hub: Hub, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "huggingface_hub", None)
    with pytest.raises(PlatformError, match=r"pip install 'ravestate\[wildtalk\]'"):
        fetch()
