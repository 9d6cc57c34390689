"""Small talk by a tiny causal model with random weights. The library transformers and its client of the hub are real."""

from __future__ import annotations

import asyncio
import contextlib
import json
import shutil
import threading
from collections.abc import Iterator
from contextlib import aclosing
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest

from ravestate.errors import PlatformError
from ravestate.language.chat import Message
from ravestate.modules.skill.wildtalk import transformers as file
from ravestate.modules.skill.wildtalk.transformers import TransformersBackend, cut, transcript

TALK = [Message("system", "You are a robot."), Message("user", "Hello!\nHow are you?")]
TEMPLATE = "{% for m in messages %}[{{ m.role }}]{{ m.content }}{% endfor %}[assistant]"


@pytest.fixture(scope="session")
def tiny(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a GPT-2 of two small layers and a tokenizer of bytes, as the library saves them."""
    from tokenizers import Tokenizer, decoders, models, pre_tokenizers
    from transformers import GPT2Config, GPT2LMHeadModel, PreTrainedTokenizerFast

    folder = tmp_path_factory.mktemp("models") / "tiny"
    alphabet = sorted(pre_tokenizers.ByteLevel.alphabet())
    vocabulary = {token: number for number, token in enumerate(["<end>", *alphabet])}
    tokenizer = Tokenizer(models.BPE(vocab=vocabulary, merges=[]))
    tokenizer.pre_tokenizer = pre_tokenizers.ByteLevel(add_prefix_space=False)
    tokenizer.decoder = decoders.ByteLevel()
    PreTrainedTokenizerFast(tokenizer_object=tokenizer, eos_token="<end>").save_pretrained(folder)
    sizes: dict[str, Any] = {
        "vocab_size": len(vocabulary),
        "n_positions": 128,
        "n_embd": 32,
        "n_layer": 2,
        "n_head": 2,
    }
    GPT2LMHeadModel(GPT2Config(**sizes, bos_token_id=0, eos_token_id=0)).save_pretrained(folder)
    return folder


async def answer(backend: TransformersBackend, **options: Any) -> list[str]:
    async with aclosing(backend.stream(TALK, **{"max_tokens": 24, "seed": 1, **options})) as pieces:
        return [piece async for piece in pieces]


def test_the_answer_comes_in_pieces_and_the_same_seed_gives_the_same_answer(tiny: Path) -> None:
    async def story() -> tuple[list[str], list[str], list[str]]:
        backend = TransformersBackend(str(tiny))
        return await answer(backend), await answer(backend), await answer(backend, seed=2)

    first, again, other = asyncio.run(story())
    assert "".join(first) == "".join(again) != "".join(other)
    assert "\n" not in "".join(first).strip()


def copy_of(tiny: Path, folder: Path, template: str | None = None) -> str:
    """Copy the model to a new folder, perhaps with a chat template. Return the folder's name."""
    shutil.copytree(tiny, folder)
    if template is not None:
        (folder / "chat_template.jinja").write_text(template)
    return str(folder)


def test_only_a_model_without_a_chat_template_continues_a_line_of_a_transcript(
    tiny: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from transformers import AutoTokenizer, GPT2LMHeadModel

    prompts: list[str] = []
    tokenizer = AutoTokenizer.from_pretrained(str(tiny))

    def generate(_: Any, *, input_ids: Any, streamer: Any, **options: Any) -> None:
        prompts.append(tokenizer.decode(input_ids[0]))
        streamer.on_finalized_text("Fine.\nUser: Good.", stream_end=True)

    monkeypatch.setattr(GPT2LMHeadModel, "generate", generate)
    chatty = copy_of(tiny, tmp_path / "chatty", TEMPLATE)
    assert asyncio.run(answer(TransformersBackend(str(tiny)))) == ["Fine."]
    assert "".join(asyncio.run(answer(TransformersBackend(chatty)))) == "Fine.\nUser: Good."
    assert prompts == [
        "You are a robot.\n\nUser: Hello! How are you?\nAgent:",
        "[system]You are a robot.[user]Hello!\nHow are you?[assistant]",
    ]


def test_a_chat_template_that_refuses_the_conversation_is_reported(tiny: Path, tmp_path: Path) -> None:
    strict = copy_of(tiny, tmp_path / "strict", "{{ raise_exception('System role not supported') }}")
    with pytest.raises(PlatformError, match=r"the model '.*strict' failed: System role not supported"):
        asyncio.run(answer(TransformersBackend(strict)))


@pytest.fixture
def loads(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """A list to which the library adds the name of each model that it loads."""
    from transformers import AutoModelForCausalLM

    names: list[str] = []
    load = AutoModelForCausalLM.from_pretrained

    def note(name: str) -> Any:
        names.append(name)
        return load(name)

    monkeypatch.setattr(AutoModelForCausalLM, "from_pretrained", note)
    return names


def end_loaders() -> None:
    """Wait for the end of the threads that load models, because such a thread still holds its model."""
    for thread in threading.enumerate():
        if thread.name == file.LOADER:
            thread.join()


def test_contexts_share_a_model_until_the_last_context_releases_it(
    tiny: Path, tmp_path: Path, loads: list[str]
) -> None:
    name = copy_of(tiny, tmp_path / "shared")

    async def story() -> None:
        one, other, late = (TransformersBackend(name) for _ in range(3))
        done: list[float] = []
        await one.load(done.append)
        await other.load()
        assert done == [1.0]
        await one.close()
        await late.load()
        assert loads == [name]
        await late.close()
        await other.close()
        await other.close()

    asyncio.run(story())
    end_loaders()
    asyncio.run(TransformersBackend(name).load())
    assert loads == [name, name]


def test_a_conversation_longer_than_the_models_context_loses_its_beginning(tiny: Path) -> None:
    long = [Message("user", "word " * 4000)]

    async def story() -> str:
        backend = TransformersBackend(str(tiny))
        return "".join([piece async for piece in backend.stream(long, max_tokens=16, seed=1)])

    assert len(asyncio.run(story())) <= 16


def test_an_answer_is_no_longer_than_the_models_context(tiny: Path) -> None:
    async def story() -> list[str]:
        return await answer(TransformersBackend(str(tiny)), max_tokens=100_000, temperature=2.0)

    assert asyncio.run(story())  # there is an answer


def test_closing_an_answer_stops_the_model(tiny: Path) -> None:
    async def story() -> list[str]:
        backend = TransformersBackend(str(tiny))
        pieces = backend.stream(TALK, max_tokens=100_000, temperature=1.0, seed=1)
        with contextlib.suppress(StopAsyncIteration):
            await anext(pieces)
        await pieces.aclose()
        return await answer(backend)  # this would wait if the first answer still used the model

    asyncio.run(story())
    for thread in threading.enumerate():
        if thread.name == "ravestate-model":
            thread.join(timeout=20)
            assert not thread.is_alive()


def test_the_agent_ends_while_a_model_is_still_being_fetched(monkeypatch: pytest.MonkeyPatch) -> None:
    from transformers import AutoTokenizer

    fetched = threading.Event()

    async def story() -> None:
        begun, loop = asyncio.Event(), asyncio.get_running_loop()

        def fetch(name: str) -> None:
            loop.call_soon_threadsafe(begun.set)
            fetched.wait()
            raise OSError("there is no network")

        monkeypatch.setattr(AutoTokenizer, "from_pretrained", fetch)
        loading = asyncio.create_task(TransformersBackend("large").load())
        await begun.wait()
        loading.cancel()

    asyncio.run(story())
    assert not fetched.is_set()
    assert all(thread.daemon for thread in threading.enumerate() if thread.name == file.LOADER)
    fetched.set()
    end_loaders()


@pytest.mark.parametrize("name", ["/no/such/folder", "no such name"])
def test_the_error_names_a_model_that_cannot_be_loaded_and_the_remedy(name: str) -> None:
    with pytest.raises(PlatformError, match=r"cannot be loaded.*--set wildtalk\.model=gpt2"):
        asyncio.run(TransformersBackend(name).load())


def test_the_error_names_a_broken_model(tiny: Path, tmp_path: Path) -> None:
    for part in tiny.iterdir():
        (tmp_path / part.name).write_bytes(part.read_bytes())
    (tmp_path / "model.safetensors").write_bytes(b"nonsense")
    with pytest.raises(PlatformError, match="cannot be loaded"):
        asyncio.run(TransformersBackend(str(tmp_path)).load())


def test_the_error_names_the_missing_packages(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(file, "find_spec", lambda _: None)
    with pytest.raises(PlatformError, match=r"needs torch and transformers.*ravestate\[transformers\]"):
        asyncio.run(TransformersBackend("gpt2").load())


def test_a_model_that_stalls_or_fails_is_reported(tiny: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from transformers import GPT2LMHeadModel

    async def story() -> None:
        backend = TransformersBackend(str(tiny), read_timeout=0.05)
        await backend.load()
        stalled = threading.Event()
        monkeypatch.setattr(GPT2LMHeadModel, "generate", lambda *_, **__: stalled.wait())
        with pytest.raises(PlatformError, match=r"wrote nothing for 0\.05 s"):
            await answer(backend)
        stalled.set()

        def fail(*_: Any, **__: Any) -> None:
            raise RuntimeError("out of memory")

        monkeypatch.setattr(GPT2LMHeadModel, "generate", fail)
        with pytest.raises(PlatformError, match="failed: out of memory"):
            await answer(backend)

    asyncio.run(story())


@contextlib.contextmanager
def hub(folder: Path) -> Iterator[str]:
    """A hub with one model, ``someone/tiny``."""
    commit = "0" * 40

    class Handler(BaseHTTPRequestHandler):
        def do_HEAD(self) -> None:
            self.give(body=False)

        def do_GET(self) -> None:
            self.give(body=True)

        def give(self, *, body: bool) -> None:
            path = self.path.split("?")[0]
            names = sorted(part.name for part in folder.iterdir())
            if path.startswith("/api/models/someone/tiny/tree"):
                listed = [{"type": "file", "path": n, "size": (folder / n).stat().st_size, "oid": n} for n in names]
                return self.send(json.dumps(listed).encode(), body=body)
            if path.startswith("/api/models/someone/tiny"):
                told = {"id": "someone/tiny", "sha": commit, "siblings": [{"rfilename": n} for n in names]}
                return self.send(json.dumps(told).encode(), body=body)
            name = path.rsplit("/", 1)[-1]
            if path.startswith("/someone/tiny/resolve/") and name in names:
                return self.send((folder / name).read_bytes(), body=body, etag=f'"{name}"')
            return self.send(b"", body=body, status=404)

        def send(self, content: bytes, *, body: bool, status: int = 200, etag: str = "") -> None:
            self.send_response(status)
            self.send_header("Content-Length", str(len(content)))
            self.send_header("X-Repo-Commit", commit)
            if etag:
                self.send_header("ETag", etag)
            elif status == 404:
                self.send_header("X-Error-Code", "EntryNotFound")
            self.end_headers()
            if body:
                self.wfile.write(content)

        def log_message(self, *_: Any) -> None:
            """Say nothing."""

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}"
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


def test_a_model_is_fetched_from_a_hub_once(
    tiny: Path, tmp_path: Path, loads: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from huggingface_hub import HfApi, constants
    from transformers.utils import hub as library

    def load() -> None:
        asyncio.run(TransformersBackend("someone/tiny").load())
        end_loaders()

    monkeypatch.setattr(constants, "HF_HUB_CACHE", str(tmp_path))  # the library reads the environment only once
    with hub(tiny) as address:
        monkeypatch.setattr(constants, "ENDPOINT", address)
        monkeypatch.setattr(
            constants, "HUGGINGFACE_CO_URL_TEMPLATE", address + constants.HUGGINGFACE_CO_URL_TEMPLATE[22:]
        )
        monkeypatch.setattr(library, "_hf_api", HfApi(endpoint=address))
        load()
    monkeypatch.setattr(constants, "HF_HUB_OFFLINE", True)
    load()
    assert loads == ["someone/tiny"] * 2


def test_a_transcript_has_a_line_for_each_turn() -> None:
    past = [*TALK, Message("assistant", "Fine."), Message("user", "Good.")]
    assert transcript(past) == "You are a robot.\n\nUser: Hello! How are you?\nAgent: Fine.\nUser: Good.\nAgent:"


@pytest.mark.parametrize(
    ("text", "last", "expected"),
    [
        ("Hello", False, ("Hello", False)),
        ("Hello\n", False, ("Hello", True)),
        ("\n Hello", False, ("\n Hello", False)),  # an empty line before the answer does not end it
        ("Hello [e", False, ("Hello ", False)),
        ("Hello [e", True, ("Hello [e", False)),
        ("Hello [end] you", False, ("Hello ", True)),
        ("", True, ("", False)),
    ],
)
def test_an_answer_is_cut_where_it_ends(text: str, last: bool, expected: tuple[str, bool]) -> None:
    assert cut(text, ["\n", "[end]"], last=last) == expected
