"""The download of a model, from a stand-in of the hub: whole, in parts, and every way to go wrong."""

import contextlib
import errno
import fcntl
import logging
import shutil
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from modules.skill.wildtalk.stand_ins import CONTENT, MODEL, PATH, Hub
from ravestate.errors import PlatformError
from ravestate.modules.skill.wildtalk import download as file
from ravestate.modules.skill.wildtalk import model_store
from ravestate.modules.skill.wildtalk.download import TRIES, download, interrupted, size_of


@pytest.fixture
def hub(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Hub]:
    monkeypatch.setattr(model_store, "folder", lambda: tmp_path / "models")
    for name in ("HF_TOKEN", "HF_HUB_OFFLINE"):
        monkeypatch.delenv(name, raising=False)
    with Hub().running() as running:
        monkeypatch.setenv("HF_ENDPOINT", f"{running.url}/")
        yield running


def fetch() -> tuple[list[float], list[float]]:
    """Fetch the model; return the fractions that were reported, and the waits."""
    shown: list[float] = []
    waits: list[float] = []
    download(MODEL, shown.append, waits.append)
    assert MODEL.path.read_bytes() == CONTENT
    assert not MODEL.part.exists()
    return shown, waits


def ranges(hub: Hub) -> list[str]:
    return [headers.get("range", "") for path, headers in hub.requests if path == PATH]


def test_a_file_is_fetched_from_its_revision_and_verified(hub: Hub) -> None:
    shown, waits = fetch()
    assert shown == sorted(shown) and shown[-1] == 1.0 and waits == []
    assert [path for path, _ in hub.requests] == [PATH, "/blob"]


def test_a_broken_connection_is_continued_where_it_broke(hub: Hub) -> None:
    hub.script = [("cut", 100_000), ("cut", 50_000)]
    _, waits = fetch()
    assert ranges(hub) == ["", "bytes=100000-", "bytes=150000-"]
    assert waits == [1.0, 1.0]


def test_an_interrupted_download_keeps_its_part_and_goes_on(hub: Hub) -> None:
    def stop(fraction: float) -> None:
        if fraction > 0.3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        download(MODEL, stop)
    have = MODEL.part.stat().st_size
    assert 0.3 < have / MODEL.size < 1.0
    assert not MODEL.path.exists()
    assert interrupted(MODEL) == (
        f"interrupted; {size_of(have)} of {size_of(MODEL.size)} are kept in {MODEL.part}, and the same command continues"
    )
    fetch()
    assert ranges(hub) == ["", f"bytes={have}-"]


def test_a_hub_without_ranges_sends_everything_again(hub: Hub) -> None:
    hub.script = [("cut", 1000), "whole"]
    fetch()


def test_a_part_that_is_complete_is_only_verified(hub: Hub) -> None:
    MODEL.part.parent.mkdir()
    MODEL.part.write_bytes(CONTENT)
    fetch()
    assert hub.requests == []


def test_a_part_that_is_too_long_is_fetched_anew(hub: Hub) -> None:
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


def test_a_busy_hub_is_asked_again_after_the_time_that_it_names(hub: Hub) -> None:
    hub.script = [429, (503, 7), 500, (429, "Sun, 06 Nov 1994 08:49:37 GMT")]
    assert fetch()[1] == [2.0, 7.0, 2.0, 2.0]


def test_a_hub_that_stays_busy_or_wants_too_much_time_is_named_with_the_mend(hub: Hub) -> None:
    hub.script = [503] * TRIES
    with pytest.raises(PlatformError, match=r"does not deliver tiny\.gguf \(it answers 503\).*HF_ENDPOINT"):
        fetch()
    hub.script = [(429, 3600)]
    with pytest.raises(PlatformError, match=r"answers 429 and asks to wait 3600 s\)\. Check"):
        fetch()


@pytest.mark.parametrize(
    ("status", "mend"),
    [(404, "take another model"), (401, "HF_TOKEN"), (403, "HF_TOKEN"), (400, "is HF_ENDPOINT right")],
)
def test_a_refusal_is_final_and_says_what_to_do(hub: Hub, status: int, mend: str) -> None:
    hub.script = [status]
    with pytest.raises(PlatformError, match=mend):
        fetch()
    assert len(hub.requests) == 1


def test_without_a_network_the_message_says_what_to_do(hub: Hub, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HF_ENDPOINT", "http://ada:pw@127.0.0.1:9")
    monkeypatch.setattr(file, "TRIES", 10**6)  # it is tried once
    with pytest.raises(
        PlatformError, match=r"^http://127.0.0.1:9 does not deliver .*refused.*Check the network"
    ) as failure:
        fetch()
    assert "copy any chat model in GGUF format into" in str(failure.value)


@pytest.mark.parametrize("address", ["http://here:port", "here", "ftp://here"])
def test_an_endpoint_that_is_no_web_address_is_named(hub: Hub, monkeypatch: pytest.MonkeyPatch, address: str) -> None:
    monkeypatch.setenv("HF_ENDPOINT", address)
    with pytest.raises(PlatformError, match="HF_ENDPOINT is not a web address"):
        fetch()


def test_a_download_that_never_began_leaves_no_file(hub: Hub) -> None:
    hub.script = [404]
    with pytest.raises(PlatformError):
        fetch()
    assert list(MODEL.part.parent.iterdir()) == []
    assert interrupted(MODEL) == "interrupted; nothing had arrived yet"


def test_offline_mode_forbids_it(hub: Hub, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HF_HUB_OFFLINE", "1")
    with pytest.raises(PlatformError, match="HF_HUB_OFFLINE"):
        fetch()
    assert hub.requests == []


def test_a_disk_without_room_is_noticed_before_the_first_byte(hub: Hub, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=1000))
    with pytest.raises(PlatformError, match=r"tiny needs \d+ MB at .*, where 0 MB are free"):
        fetch()
    assert hub.requests == []


@pytest.mark.parametrize(("code", "message"), [(errno.ENOSPC, "the disk is full"), (errno.EROFS, "cannot be written")])
def test_a_disk_that_fails_on_the_way_keeps_the_part(
    hub: Hub, monkeypatch: pytest.MonkeyPatch, code: int, message: str
) -> None:
    real = file._attempt

    def attempt(model: Any, part: Any, *rest: Any) -> Any:
        part.write(CONTENT[:1000])
        raise OSError(code, "Failure")

    monkeypatch.setattr(file, "_attempt", attempt)
    with pytest.raises(PlatformError, match=message):
        fetch()
    assert MODEL.part.stat().st_size == 1000
    monkeypatch.setattr(file, "_attempt", real)
    fetch()
    assert ranges(hub) == ["bytes=1000-"]


def test_a_second_process_is_refused(hub: Hub) -> None:

    def locked(*_: Any) -> None:
        raise BlockingIOError

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fcntl, "lockf", locked)
        with pytest.raises(PlatformError, match="another process fetches tiny"):
            fetch()


def test_a_token_goes_to_the_hub_alone_and_never_to_the_log(
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
    assert "Authorization" not in file._headers("http://mirror.example")


def test_without_httpx_the_message_says_what_to_type(hub: Hub, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "httpx", None)
    with pytest.raises(PlatformError, match=r"pip install 'ravestate\[wildtalk\]'"):
        fetch()


def test_another_part_than_asked_for_is_refused(hub: Hub, monkeypatch: pytest.MonkeyPatch) -> None:
    MODEL.part.parent.mkdir()
    MODEL.part.write_bytes(CONTENT[:10])
    real = hub.send

    def shifted(request: Any) -> None:
        with contextlib.suppress(KeyError):
            del request.headers["Range"]
        request.headers["Range"] = "bytes=5-"
        real(request)

    monkeypatch.setattr(hub, "send", shifted)
    with pytest.raises(PlatformError, match="another part"):
        fetch()
