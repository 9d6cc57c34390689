"""Model servers on this machine are distinguished from other web servers, and list their chat models."""

import asyncio
import json
import logging
import threading
from typing import Any

import pytest

from modules.skill.wildtalk.stand_ins import Quiet, serving
from ravestate.language import openai
from ravestate.modules.skill.wildtalk import local_servers
from ravestate.modules.skill.wildtalk.local_servers import LocalServer, chat_models, find_servers


def listing(*names: str, **more: Any) -> dict[str, Any]:
    return {
        "object": "list",
        "data": [{"id": name, "object": "model", "owned_by": "library"} for name in names],
        **more,
    }


def answering(document: Any, status: int = 200) -> type[Quiet]:
    class Handler(Quiet):
        def do_GET(self) -> None:
            body = document if isinstance(document, bytes) else json.dumps(document).encode()
            self.reply(body, status if self.path == "/v1/models" else 404)

    return Handler


def found(*handlers: type[Quiet]) -> list[LocalServer]:
    if not handlers:
        return asyncio.run(find_servers({}))
    with serving(handlers[0]) as port:
        return asyncio.run(find_servers({port: "Ollama"}))


def test_a_server_is_found_with_the_chat_models_that_it_has() -> None:
    names = (
        "nomic-embed-text:latest",
        "qwen2.5-coder:7b",
        "llama3.2:latest",
        "smollm2:135m",
        "gpt-oss:120b-cloud",
        "qwen3:0.6b",
    )
    (server,) = found(answering(listing(*names)))
    assert server.models == ("llama3.2:latest", "qwen3:0.6b", "qwen2.5-coder:7b")
    assert server.base_url.startswith("http://127.0.0.1:") and server.base_url.endswith("/v1")


def test_a_number_of_parameters_that_the_server_states_decides_whether_a_model_is_listed() -> None:
    entry = {"id": "model.gguf", "object": "model", "meta": {"n_params": 134_515_008}}
    assert found(answering({"object": "list", "data": [entry]})) == []
    entry["meta"] = {"n_params": 1_543_714_304}
    assert found(answering({"object": "list", "data": [entry]}))[0].models == ("model.gguf",)


@pytest.mark.parametrize(
    "document",
    [
        b"<html>It works!</html>", b"", b"[]", b"{", {"models": ["a"]}, {"data": "a"}, {"object": "list", "data": []},
        {"data": [{"id": "fiesta", "name": "Ford Fiesta"}, "focus", 3]}, {"data": [{"id": 7, "object": "model"}]},
        listing("text-embedding-3-small", "bge-m3", "whisper-1"), {"data": [{"id": "a\x1b[2J", "object": "model"}]},
        b'{"data": "' + b"x" * (openai.LIMIT + 10) + b'"}', b"[" * 100_000,
    ],
)  # fmt: skip
def test_another_web_server_is_not_mistaken_for_a_model_server(document: Any) -> None:
    assert found(answering(document)) == []


@pytest.mark.parametrize("status", [301, 401, 404, 500])
def test_a_server_that_refuses_the_request_is_left_out(status: int) -> None:
    assert found(answering(listing("llama3.2"), status)) == []


def test_servers_are_asked_at_the_same_time_and_listed_in_the_given_order() -> None:
    meeting = threading.Barrier(2, timeout=10)

    class Waiting(Quiet):
        def do_GET(self) -> None:
            meeting.wait()  # each server answers only when both have a request
            self.reply(json.dumps(listing("llama3.2")).encode())

    with serving(Waiting) as first, serving(Waiting) as second:
        servers = asyncio.run(find_servers({first: "one", second: "two"}))
    assert [server.name for server in servers] == ["one", "two"]


def test_a_server_that_stalls_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(local_servers, "PATIENCE", 0.05)
    left = threading.Event()

    class Stalled(Quiet):
        def do_GET(self) -> None:
            left.wait()

    with serving(Stalled) as port:
        assert asyncio.run(find_servers({port: "slow"})) == []
        left.set()


def test_no_server_is_found_if_nothing_listens_or_the_web_client_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    assert found() == []
    with serving(Quiet) as port:
        pass
    assert asyncio.run(find_servers({port: "gone"})) == []
    monkeypatch.setattr(local_servers, "find_spec", lambda _: None)
    assert found(answering(listing("llama3.2"))) == []


def test_the_key_goes_to_the_server_and_not_to_the_log(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.DEBUG)
    seen: list[str | None] = []

    class Handler(Quiet):
        def do_GET(self) -> None:
            seen.append(self.headers.get("Authorization"))
            self.reply(json.dumps(listing("big")).encode())

    with serving(Handler) as port:
        assert asyncio.run(chat_models(f"http://127.0.0.1:{port}/v1/", "s3cret", 5.0)) == ("big",)
        asyncio.run(find_servers({port: "found"}))
    assert seen == ["Bearer s3cret", None]
    assert "s3cret" not in caplog.text
