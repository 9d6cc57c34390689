"""Small talk by a causal model in the format of Hugging Face's transformers: GPT-2 and its many successors.

This backend is slower and ten times heavier than llama.cpp with a GGUF file. Use it for models that have no such file,
and for models that you have trained.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import logging
import threading
from collections.abc import AsyncGenerator, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any, ClassVar, cast
from weakref import WeakValueDictionary

from ravestate.errors import PlatformError
from ravestate.language.chat import Message, Progress
from ravestate.language.loading import LOADING

ANSWERS = "Agent:"
"""The beginning of a line in a transcript. A model that has no chat template writes the rest of the line."""

LOADER = "ravestate-model-loader"
"""The name of a thread that loads a model."""

SPEAKERS = {"user": "User:", "assistant": ANSWERS}


class TransformersBackend:
    """A causal model in a thread of this process; contexts with the same model share it."""

    def __init__(self, model: str, *, read_timeout: float = 60.0) -> None:
        """Take the settings. The model is not looked up or loaded yet.

        Args:
            model: A folder with a model, or a model's name on the hub of Hugging Face, from where it is downloaded once.
            read_timeout: Seconds without a word after which the model counts as stuck.
        """
        self._name = model
        self._read_timeout = read_timeout
        self._model: _Model | None = None

    async def load(self, progress: Progress | None = None) -> None:
        """See `Backend.load`. The library only reports the end, so `progress` is called once."""
        if self._model is None:
            self._model = await _loaded(self._name)
        if progress is not None:
            progress(1.0)

    async def close(self) -> None:
        """Release the model. Its memory is freed when no context uses it any more."""
        self._model = None

    async def stream(
        self,
        messages: Sequence[Message],
        *,
        max_tokens: int = 96,
        temperature: float = 0.7,
        seed: int | None = None,
        stop: Sequence[str] = (),
    ) -> AsyncGenerator[str, None]:
        """See `Backend.stream`. A model that has no chat template continues a transcript."""
        await self.load()
        model = self._model
        assert model is not None  # `load` has set it
        left = threading.Event()
        try:
            prompt, ends = await asyncio.to_thread(model.prompt, messages)
            pieces = model.streamer(self._read_timeout)
            writing = asyncio.create_task(
                asyncio.to_thread(model.write, prompt, max_tokens, temperature, seed, pieces, left)
            )
        except Exception as error:  # a template may refuse a conversation, e.g. one with a system's turn
            raise self._failed(error) from error

        def end(_: object) -> None:
            pieces.text_queue.put_nowait(None)
            _ = writing.cancelled() or writing.exception()  # otherwise, asyncio logs an error if the caller has left

        writing.add_done_callback(end)
        written, shown, over = "", 0, False
        try:
            while not over:
                try:
                    piece = await anext(pieces, None)
                except TimeoutError:
                    raise PlatformError(
                        f"wildtalk: the model {self._name!r} wrote nothing for {self._read_timeout:g} s: give it more time "
                        "(--set wildtalk.read_timeout=300) or take a smaller one"
                    ) from None
                if piece is None and (error := writing.done() and writing.exception()):
                    raise self._failed(error) from error
                written += piece or ""
                safe, over = cut(written, (*stop, *ends), last=piece is None)
                if safe[shown:]:
                    yield safe[shown:]
                    shown = len(safe)
                over = over or piece is None
        finally:
            left.set()

    def _failed(self, error: BaseException) -> PlatformError:
        return PlatformError(f"wildtalk: the model {self._name!r} failed: {_first_line(error)}")


async def _loaded(name: str) -> _Model:
    """Load a model in a daemon thread, because a download may take an hour and must not delay the end of the loop."""
    outcome: concurrent.futures.Future[_Model] = concurrent.futures.Future()
    outcome.set_running_or_notify_cancel()  # the thread cannot be cancelled, but its caller can

    def job() -> None:
        try:
            outcome.set_result(_Model.shared(name))
        except BaseException as error:  # the caller gets any exception
            outcome.set_exception(error)

    threading.Thread(target=job, name=LOADER, daemon=True).start()
    return await asyncio.wrap_future(outcome)


class _Model:
    """A model and its tokenizer, loaded once for all contexts."""

    _loaded: ClassVar[WeakValueDictionary[str, _Model]] = WeakValueDictionary()
    _loading = threading.Lock()

    def __init__(self, name: str) -> None:
        if missing := [package for package in ("torch", "transformers") if find_spec(package) is None]:
            raise PlatformError(
                f"wildtalk needs {' and '.join(missing)} for this model: pip install 'ravestate[transformers]'"
            )
        with LOADING:
            import torch
            import transformers

        self.library = cast("Any", transformers)
        self.library.utils.logging.disable_progress_bar()
        logging.getLogger("transformers").setLevel(logging.ERROR)
        folder = Path(name).expanduser()
        place = str(folder) if folder.is_dir() else name
        try:
            self.tokenizer: Any = self.library.AutoTokenizer.from_pretrained(place)
            self.model: Any = self.library.AutoModelForCausalLM.from_pretrained(place)
        except Exception as error:  # the library raises all kinds of exceptions
            raise PlatformError(
                f"wildtalk: the model {name!r} cannot be loaded: {_first_line(error)}. Name a folder that holds one, or "
                "a model's name on the hub: --set wildtalk.model=gpt2"
            ) from error
        self.model.eval().to("cuda" if torch.cuda.is_available() else "cpu")
        self._writing = threading.Lock()

    @classmethod
    def shared(cls, name: str) -> _Model:
        """Return the model with this name; load it if needed."""
        with cls._loading:
            found = cls._loaded.get(name)
            if found is None:
                found = cls._loaded[name] = cls(name)
            return found

    def prompt(self, messages: Sequence[Message]) -> tuple[str, tuple[str, ...]]:
        """Return the text to continue, and the texts that end the answer. This blocks while it compiles a template."""
        if self.tokenizer.chat_template is None:
            return transcript(messages), ("\n",)
        turns = [{"role": message.role, "content": message.text} for message in messages]
        return self.tokenizer.apply_chat_template(turns, add_generation_prompt=True, tokenize=False), ()

    def streamer(self, timeout: float) -> Any:
        """Return an iterator, for the running loop, over the pieces that `write` writes."""
        return self.library.AsyncTextIteratorStreamer(
            self.tokenizer, skip_prompt=True, timeout=timeout, skip_special_tokens=True
        )

    def write(
        self, prompt: str, max_tokens: int, temperature: float, seed: int | None, pieces: Any, left: threading.Event
    ) -> None:
        """Write an answer into the streamer `pieces`. Stop when `left` says that the caller has gone."""
        import torch as real_torch

        torch = cast("Any", real_torch)

        def ended(input_ids: Any, scores: Any, **_: Any) -> Any:
            return torch.full((input_ids.shape[0],), left.is_set(), dtype=torch.bool)

        tokens: Any = self.tokenizer(prompt, return_tensors="pt", add_special_tokens=False).to(self.model.device)
        room = getattr(self.model.config, "max_position_embeddings", 0) or 0
        if room:  # the number of tokens for the prompt and the answer together
            max_tokens = min(max_tokens, room - 1)
            tokens = {key: value[:, max_tokens - room :] for key, value in tokens.items()}
        # Write one answer at a time: two would be no faster, and they would share the random state of the process.
        with self._writing:
            if left.is_set():
                return
            if seed is not None:
                torch.manual_seed(seed)
            with torch.inference_mode():
                self.model.generate(
                    **tokens,
                    **({"do_sample": True, "temperature": temperature} if temperature > 0 else {"do_sample": False}),
                    max_new_tokens=max_tokens,
                    repetition_penalty=1.1,
                    pad_token_id=self.tokenizer.pad_token_id or self.tokenizer.eos_token_id,
                    streamer=pieces,
                    stopping_criteria=[ended],
                )


def transcript(messages: Sequence[Message]) -> str:
    """Return a conversation as text, for models that have no chat template."""
    lines: list[str] = []
    for message in messages:
        text = " ".join(message.text.split())
        lines.append(f"{SPEAKERS[message.role]} {text}" if message.role in SPEAKERS else f"{text}\n")
    return "\n".join([*lines, ANSWERS])


def cut(text: str, stops: Sequence[str], *, last: bool) -> tuple[str, bool]:
    """Return the part of a growing text that may be shown, and whether one of `stops` has ended the text.

    Unless the text is complete (`last`), hold back an end that may be the beginning of one of `stops`.

    Example:
        >>> cut("Hello.\\nUser", ["\\nUser:"], last=False)
        ('Hello.', False)
    """
    begun = len(text) - len(text.lstrip())  # models begin with a space, or with an empty line
    ends = [text.index(stop, begun) for stop in stops if stop in text[begun:]]
    if ends:
        return text[: min(ends)], True
    half = (size for stop in stops for size in range(1, len(stop)) if text.endswith(stop[:size]))
    return text[: len(text) - (0 if last else max(half, default=0))], False


def _first_line(error: BaseException) -> str:
    return (str(error).strip().splitlines() or [type(error).__name__])[0].rstrip(".")
