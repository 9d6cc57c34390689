"""Small talk by a causal model in the format of Hugging Face's transformers: GPT-2 and its many successors.

It is slower and ten times heavier than llama.cpp with a GGUF file. Use it for models without such a file, and for your
own.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import logging
import threading
from collections.abc import AsyncGenerator, Callable, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any, ClassVar, TypeVar, cast
from weakref import WeakValueDictionary

from ravestate.errors import PlatformError
from ravestate.language.loading import LOADING

from .backend import Message, Progress

T = TypeVar("T")

ANSWERS = "Agent:"
"""The beginning of the line that a model without a chat template continues."""

LOADER = "ravestate-model-loader"
"""The name of a thread that loads a model."""

SPEAKERS = {"user": "User:", "assistant": ANSWERS}


class TransformersBackend:
    """A causal model in a thread of this process; contexts with the same model share it.

    Example:
        ```python
        backend = TransformersBackend("gpt2")
        async for piece in backend.stream([Message("user", "Hello!")]):
            print(piece, end="", flush=True)
        ```
    """

    def __init__(self, model: str, *, read_timeout: float = 60.0) -> None:
        """This does not look for or load anything yet.

        Args:
            model: A folder with a model, or a model's name on the hub; it is downloaded once.
            read_timeout: Seconds without a word after which the model counts as stuck.
        """
        self._name = model
        self._read_timeout = read_timeout
        self._model: _Model | None = None

    async def load(self, progress: Progress | None = None) -> None:
        """See `Backend.load`. The library reports no progress, only the end."""
        if self._model is None:
            self._model = await _in_background(_Model.shared, self._name)
        if progress is not None:
            progress(1.0)

    async def close(self) -> None:
        """Release the model; its last user frees it."""
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
        """See `Backend.stream`. A model without a chat template continues a transcript."""
        await self.load()
        model = self._model
        assert model is not None  # `load` has set it
        loop = asyncio.get_running_loop()
        pieces: asyncio.Queue[str | BaseException | None] = asyncio.Queue()
        left = threading.Event()

        def tell(piece: str | BaseException | None) -> None:
            try:
                loop.call_soon_threadsafe(pieces.put_nowait, piece)
            except RuntimeError:  # the loop is closed: no task is listening any more
                left.set()

        try:
            prompt, ends = await asyncio.to_thread(model.prompt, messages)
        except Exception as error:  # a template may refuse a conversation, e.g. one with a system's turn
            raise self._failed(error) from error

        def write() -> None:
            try:
                model.write(prompt, max_tokens, temperature, seed, tell, left)
                tell(None)
            except Exception as error:  # any exception goes to the caller
                tell(error)

        threading.Thread(target=write, name="ravestate-model").start()
        stops = (*stop, *ends)
        written, shown = "", 0
        try:
            while True:
                try:
                    piece = await asyncio.wait_for(pieces.get(), self._read_timeout)
                except TimeoutError:
                    raise PlatformError(
                        f"wildtalk: the model {self._name!r} wrote nothing for {self._read_timeout:g} s: give it more time "
                        "(--set wildtalk.read_timeout=300) or take a smaller one"
                    ) from None
                if isinstance(piece, BaseException):
                    raise self._failed(piece) from piece
                written += piece or ""
                safe, over = cut(written, stops, last=piece is None)
                if safe[shown:]:
                    yield safe[shown:]
                    shown = len(safe)
                if over or piece is None:
                    return
        finally:
            left.set()

    def _failed(self, error: BaseException) -> PlatformError:
        return PlatformError(f"wildtalk: the model {self._name!r} failed: {_first_line(error)}")


async def _in_background(work: Callable[[str], T], argument: str) -> T:
    """Run `work` in a thread that the end of the loop does not wait for: a download may take an hour."""
    outcome: concurrent.futures.Future[T] = concurrent.futures.Future()
    outcome.set_running_or_notify_cancel()  # the thread cannot be cancelled, but its caller can

    def job() -> None:
        try:
            outcome.set_result(work(argument))
        except BaseException as error:  # any exception belongs to the caller
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
            import transformers

        library = cast("Any", transformers)
        library.utils.logging.disable_progress_bar()
        logging.getLogger("transformers").setLevel(logging.ERROR)
        folder = Path(name).expanduser()
        place = str(folder) if folder.is_dir() else name
        try:
            self.tokenizer: Any = library.AutoTokenizer.from_pretrained(place)
            self.model: Any = library.AutoModelForCausalLM.from_pretrained(place)
        except Exception as error:  # the library raises all kinds of exceptions
            raise PlatformError(
                f"wildtalk: the model {name!r} cannot be loaded: {_first_line(error)}. Name a folder that holds one, or "
                "a model's name on the hub: --set wildtalk.model=gpt2"
            ) from error
        import torch

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
        """Return the text to continue, and the texts that end the answer. It blocks: a template must be compiled."""
        if self.tokenizer.chat_template is None:
            return transcript(messages), ("\n",)
        turns = [{"role": message.role, "content": message.text} for message in messages]
        return self.tokenizer.apply_chat_template(turns, add_generation_prompt=True, tokenize=False), ()

    def write(
        self,
        prompt: str,
        max_tokens: int,
        temperature: float,
        seed: int | None,
        tell: Callable[[str], None],
        left: threading.Event,
    ) -> None:
        """Write an answer, and report each piece; stop when it is `left`."""
        import torch as real_torch
        import transformers

        library, torch = cast("Any", transformers), cast("Any", real_torch)

        class Teller(library.TextStreamer):
            def on_finalized_text(self, text: str, stream_end: bool = False) -> None:
                tell(text)

        class Left(library.StoppingCriteria):
            def __call__(self, input_ids: Any, scores: Any, **_: Any) -> Any:
                return torch.full((input_ids.shape[0],), left.is_set(), dtype=torch.bool)

        tokens: Any = self.tokenizer(prompt, return_tensors="pt", add_special_tokens=False).to(self.model.device)
        room = getattr(self.model.config, "max_position_embeddings", 0) or 0
        if room:  # for the prompt and the answer together
            max_tokens = min(max_tokens, room - 1)
            tokens = {key: value[:, max_tokens - room :] for key, value in tokens.items()}
        sampling = {"do_sample": True, "temperature": temperature} if temperature > 0 else {"do_sample": False}
        # One answer at a time: two would be no faster, and the library's random numbers belong to the whole process.
        with self._writing:
            if left.is_set():
                return
            if seed is not None:
                torch.manual_seed(seed)
            with torch.inference_mode():
                self.model.generate(
                    **tokens,
                    **sampling,
                    max_new_tokens=max_tokens,
                    repetition_penalty=1.1,
                    pad_token_id=self.tokenizer.pad_token_id or self.tokenizer.eos_token_id,
                    streamer=Teller(self.tokenizer, skip_prompt=True, skip_special_tokens=True),
                    stopping_criteria=library.StoppingCriteriaList([Left()]),
                )


def transcript(messages: Sequence[Message]) -> str:
    """Return a conversation as text, for models without turns.

    Example:
        >>> print(transcript([Message("system", "A talk."), Message("user", "Hello!")]))
        A talk.
        <BLANKLINE>
        User: Hello!
        Agent:
    """
    lines: list[str] = []
    for message in messages:
        text = " ".join(message.text.split())
        lines.append(f"{SPEAKERS[message.role]} {text}" if message.role in SPEAKERS else f"{text}\n")
    return "\n".join([*lines, ANSWERS])


def cut(text: str, stops: Sequence[str], *, last: bool) -> tuple[str, bool]:
    """Return the part of a growing text to show, and whether one of `stops` has ended it.

    Unless it is the `last`, an end that might become a stop is held back.

    Example:
        >>> cut("Hello.\\nUser", ["\\nUser:"], last=False)
        ('Hello.', False)
        >>> cut("Hello.\\nUser: Hm", ["\\nUser:"], last=False)
        ('Hello.', True)
    """
    begun = len(text) - len(text.lstrip())  # models begin with a space, or with an empty line
    ends = [text.index(stop, begun) for stop in stops if stop in text[begun:]]
    if ends:
        return text[: min(ends)], True
    held = 0
    if not last:
        for stop in stops:
            held = max([held, *(size for size in range(1, len(stop)) if text.endswith(stop[:size]))])
    return text[: len(text) - held], False


def _first_line(error: BaseException) -> str:
    return (str(error).strip().splitlines() or [type(error).__name__])[0].rstrip(".")
