"""The client of OpenAI-compatible servers, tested with a server that can make every mistake."""

import asyncio
import json
import subprocess
import sys
from collections.abc import Awaitable, Callable
from contextlib import aclosing
from typing import Any

import pytest
from pydantic import SecretStr

from ravestate.errors import PlatformError
from ravestate.language.chat import Message
from ravestate.language.openai import OpenAIBackend

HELLO = [Message("system", "Be kind."), Message("user", "Hello!")]
Conversation = Callable[..., list[str]]


@pytest.fixture
def converse(chat_server: Any) -> Conversation:
    """Return a function that asks a stand-in server for a chosen answer, and returns the pieces of this answer."""

    def run(answer: Callable[[Any], Awaitable[None]], *, seen: list[Any] | None = None, **options: Any) -> list[str]:
        async def main() -> list[str]:
            ask = {k: options.pop(k) for k in ("max_tokens", "temperature", "seed", "stop") if k in options}
            async with chat_server(answer).running() as server:
                backend = OpenAIBackend(options.pop("base_url", server.url), "tiny", **options)
                try:
                    return [piece async for piece in backend.stream(HELLO, **ask)]
                finally:
                    await backend.close()
                    if seen is not None:
                        seen.extend(server.talks)

        return asyncio.run(main())

    return run


async def hello(talk: Any) -> None:
    await talk.head()
    for piece in ("", "Hi", " there", "\u2028", " 😊"):
        await talk.piece(piece)
    await talk.piece(None, "stop")
    await talk.event("[DONE]")


FIRST_REQUEST = """
import asyncio, sys
from ravestate.errors import PlatformError
from ravestate.language.chat import Message
from ravestate.language.openai import OpenAIBackend

async def main():
    backend = OpenAIBackend("http://127.0.0.1:9/v1", "x")
    await backend.load()
    before = set(sys.modules)
    try:
        await anext(backend.stream([Message("user", "Hello!")]))
    except PlatformError:
        print(*sorted(set(sys.modules) - before))

asyncio.run(main())
"""


def test_load_imports_everything_that_the_first_request_needs() -> None:
    done = subprocess.run([sys.executable, "-c", FIRST_REQUEST], capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("\n", "")


def test_the_request_has_all_options_and_the_pieces_of_the_answer_are_yielded(converse: Conversation) -> None:
    seen: list[Any] = []
    pieces = converse(
        hello, seen=seen, api_key=SecretStr("k3y"), max_tokens=7, temperature=0.5, seed=3, stop=["\n"], extra={"a": 1}
    )  # fmt: skip
    assert pieces == ["Hi", " there", "\u2028", " 😊"]
    [talk] = seen
    assert talk.path == "/v1/chat/completions"
    assert talk.headers["authorization"] == "Bearer k3y"
    assert talk.body == {
        "model": "tiny",
        "messages": [{"role": "system", "content": "Be kind."}, {"role": "user", "content": "Hello!"}],
        "stream": True,
        "max_tokens": 7,
        "temperature": 0.5,
        "seed": 3,
        "stop": ["\n"],
        "a": 1,
    }


def test_options_that_are_not_set_are_not_sent(converse: Conversation) -> None:
    seen: list[Any] = []
    converse(hello, seen=seen)
    assert "authorization" not in seen[0].headers
    assert "seed" not in seen[0].body
    assert "stop" not in seen[0].body


def test_each_piece_is_yielded_as_soon_as_it_arrives(chat_server: Any) -> None:
    async def main() -> None:
        go_on = asyncio.Event()

        async def answer(talk: Any) -> None:
            await talk.head()
            await talk.piece("first")
            await go_on.wait()
            await talk.piece("last", "stop")

        async with chat_server(answer).running() as server:
            backend = OpenAIBackend(server.url, "tiny")
            pieces = backend.stream(HELLO)
            assert await anext(pieces) == "first"
            go_on.set()
            assert [piece async for piece in pieces] == ["last"]
            await backend.close()

    asyncio.run(main())


@pytest.mark.parametrize("how", ["close", "cancel", "cancel before the first word"])
def test_leaving_the_stream_closes_the_connection(chat_server: Any, how: str) -> None:
    async def main() -> None:
        asked, hung_up = asyncio.Event(), asyncio.Event()

        async def answer(talk: Any) -> None:
            asked.set()
            await talk.head()
            if how != "cancel before the first word":
                await talk.piece("first")
            await talk.gone()
            hung_up.set()

        async with chat_server(answer).running() as server:
            backend = OpenAIBackend(server.url, "tiny")
            got = asyncio.Event()

            async def listen() -> None:
                async with aclosing(backend.stream(HELLO)) as pieces:
                    async for _ in pieces:
                        got.set()
                        if how == "close":
                            return

            task = asyncio.create_task(listen())
            await (asked if how.endswith("word") else got).wait()
            if how != "close":
                task.cancel()
            await asyncio.gather(task, return_exceptions=True)
            await hung_up.wait()
            await backend.close()

    asyncio.run(main())


def test_a_backend_can_be_used_again_even_after_close(chat_server: Any) -> None:
    async def main() -> None:
        async with chat_server(hello).running() as server:
            backend = OpenAIBackend(server.url + "/", "tiny")
            for _ in range(2):
                assert "".join([p async for p in backend.stream(HELLO)]).startswith("Hi")
            await backend.close()
            await backend.close()
            progress: list[float] = []
            await backend.load(progress.append)
            assert progress == [1.0]
            await backend.close()

    asyncio.run(main())


def test_an_answer_from_a_server_that_does_not_stream_is_understood(converse: Conversation) -> None:
    async def answer(talk: Any) -> None:
        await talk.head(kind="application/json; charset=utf-8")
        await talk.raw(json.dumps({"choices": [{"message": {"content": "Hi there"}}]}))

    assert converse(answer) == ["Hi there"]


def test_events_are_understood_in_every_form_that_servers_send(converse: Conversation) -> None:
    async def answer(talk: Any) -> None:
        await talk.head()
        event = b'data:{"choices":[{"delta":{"content":"\xc3\xa4","reasoning":"hm"}}]}\r\n\r\n'
        await talk.raw(b": ping\r\n\r\n" + event[:40])
        await talk.raw(event[40:] + b'event: x\ndata: {"choices": [],\ndata: "usage": {}}\n\n')
        await talk.raw(b'data: {"choices":[{"delta":{"content":null},"finish_reason":"length"}]}\n\n')

    assert converse(answer) == ["ä"]


@pytest.mark.parametrize(("parameter", "renamed"), [("max_tokens", "max_completion_tokens"), ("temperature", None)])
def test_a_parameter_that_the_server_does_not_support_is_left_out(
    converse: Conversation, parameter: str, renamed: str | None
) -> None:
    async def answer(talk: Any) -> None:
        if parameter in talk.body:
            await talk.head("400 Bad Request", "application/json")
            error = {"message": "no", "param": parameter, "code": "unsupported_parameter"}
            await talk.raw(json.dumps({"error": error}))
        else:
            await hello(talk)

    seen: list[Any] = []
    assert converse(answer, seen=seen, max_tokens=7)[0] == "Hi"
    assert len(seen) == 2
    assert parameter not in seen[1].body
    if renamed:
        assert seen[1].body[renamed] == 7


# ---------------------------------------------------------------------------------- errors


def refusing(status: str, body: str = "", kind: str = "application/json", **headers: str) -> Any:
    async def answer(talk: Any) -> None:
        await talk.head(status, kind, **headers)
        await talk.raw(body)

    return answer


def sending(*lines: str) -> Any:
    async def answer(talk: Any) -> None:
        await talk.head()
        for line in lines:
            await talk.raw(line)

    return answer


PIECE = 'data: {"choices":[{"delta":{"content":"Hi"}}]}\n\n'


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (refusing("401 Unauthorized", '{"error": {"message": "bad key"}}'), r"answers 401 \(bad key\): set wildtalk.api_key"),
        (refusing("403 Forbidden", ""), r"answers 403 \(no reason\): set wildtalk.api_key"),
        (refusing("404 Not Found", '{"error": "model not found"}'), r"404 \(model not found\): does it know the model 'tiny'.*/v1"),
        (refusing("404 Not Found", "<h1>Nothing</h1>", "text/html"), r"404 \(<h1>Nothing</h1>\)"),
        (refusing("307 Moved", "", Location="http://there/v1"), "moved to 'http://there/v1': change wildtalk.base_url"),
        (refusing("400 Bad Request", '{"detail": "too long"}'), r"400 \(too long\): check wildtalk.model"),
        (refusing("400 Bad Request", '{"error": {"code": "unsupported_value", "param": "model"}}'), "400"),
        (refusing("429 Too Many", "{}"), "quota"),
        (refusing("500 Oops", '["odd"]'), "500.*check its log"),
        (refusing("503 Busy", "x" * (2 << 20)), r"503 .*x\.\.\."),
        (refusing("200 OK", "<html>", "text/html"), "sends no stream of events .*ends in /v1"),
        (refusing("200 OK", "[1]"), r"another form than OpenAI's: \[1\]"),
        (refusing("200 OK", '{"choices": [{"message": {"content": ["x"]}}]}'), "another form than OpenAI's"),
        (sending(PIECE, "data: {oops\n\n"), "another form than OpenAI's: {oops"),
        (sending(PIECE, 'data: {"error": {"message": "out of memory"}}\n\n'), "failed: out of memory"),
        (sending('data: {"choices": "x"}\n\n'), "another form than OpenAI's"),
        (sending('data: {"choices": [{"delta": "x"}]}\n\n'), "another form than OpenAI's"),
        (sending(PIECE), "broke off before its end"),
        (sending(), "broke off before its end"),
        (sending("x" * (3 << 20)), "sends no stream of events"),
    ],
)  # fmt: skip
def test_the_error_about_a_faulty_answer_says_what_to_check(converse: Conversation, answer: Any, message: str) -> None:
    with pytest.raises(PlatformError, match=f"(?s)^wildtalk: .*{message}"):
        converse(answer)


def test_a_server_that_does_not_speak_http_raises_an_error(converse: Conversation) -> None:
    async def answer(talk: Any) -> None:
        await talk.raw("SSH-2.0-OpenSSH\r\n")

    with pytest.raises(PlatformError, match=r"the connection to http://127.0.0.1:\d+/v1 broke off"):
        converse(answer)


def test_an_answer_shorter_than_its_content_length_raises_an_error(converse: Conversation) -> None:
    async def answer(talk: Any) -> None:
        await talk.head(**{"Content-Length": "9999"})
        await talk.piece("Hi")

    with pytest.raises(PlatformError, match="broke off"):
        converse(answer)


@pytest.mark.parametrize("spoken", [True, False])
def test_a_server_that_sends_nothing_for_too_long_raises_an_error(converse: Conversation, spoken: bool) -> None:
    async def answer(talk: Any) -> None:
        if spoken:
            await talk.head()
            await talk.piece("Hi")
        await talk.stall()

    with pytest.raises(PlatformError, match=r"stalled: nothing for 0.05 s.*wildtalk.read_timeout=0.1"):
        converse(answer, read_timeout=0.05)


def test_a_server_that_sends_only_comments_counts_as_stalled(converse: Conversation) -> None:
    async def answer(talk: Any) -> None:
        await talk.head()
        await talk.gone()  # sends comments for ever

    with pytest.raises(PlatformError, match=r"stalled: nothing for 0\.05 s"):
        converse(answer, read_timeout=0.05)


def test_the_error_about_a_server_that_does_not_run_says_how_to_start_it(converse: Conversation) -> None:
    with pytest.raises(PlatformError, match=r"no server answers at http://127.0.0.1:1/v1 .*ollama serve"):
        converse(hello, base_url="http://127.0.0.1:1/v1")


@pytest.mark.parametrize("url", ["", "localhost:11434/v1", "http://", "ftp://x/v1"])
def test_a_text_that_is_not_a_web_address_is_refused(url: str) -> None:
    with pytest.raises(PlatformError, match=f"base_url '{url}' is not a web address: write for example"):
        OpenAIBackend(url, "tiny")


def test_an_address_with_an_impossible_port_is_refused(converse: Conversation) -> None:
    with pytest.raises(PlatformError, match="is not a web address"):
        converse(hello, base_url="http://127.0.0.1:port/v1")


def test_errors_do_not_show_secrets(converse: Conversation) -> None:
    refusal = refusing("401 Unauthorized", '{"error": {"message": "no such key: s3cret"}}')
    with pytest.raises(PlatformError, match=r"no such key: \*\*\*\): check wildtalk.api_key") as failure:
        converse(refusal, api_key=SecretStr("s3cret"))
    assert "s3cret" not in str(failure.value)
    with pytest.raises(PlatformError, match=r"no server answers at http://127\.0\.0\.1:1/v1"):
        converse(refusal, base_url="http://me:s3cret@127.0.0.1:1/v1")


def test_a_long_error_message_shows_no_part_of_the_key(converse: Conversation) -> None:
    for before in range(280, 300):
        with pytest.raises(PlatformError) as failure:
            converse(refusing("401 Unauthorized", "-" * before + "s3cret"), api_key=SecretStr("s3cret"))
        assert "s3" not in str(failure.value)


def test_a_key_with_impossible_characters_is_refused(converse: Conversation) -> None:
    with pytest.raises(PlatformError, match="api_key has characters that no key has"):
        converse(hello, api_key=SecretStr("a\nb"))


def test_without_httpx2_the_error_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "httpx2", None)
    with pytest.raises(PlatformError, match=r"needs httpx2: pip install 'ravestate\[wildtalk\]'"):
        asyncio.run(OpenAIBackend("http://localhost/v1", "tiny").load())
