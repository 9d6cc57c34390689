"""The rules: when the model talks, and with which prompt."""

from __future__ import annotations

import asyncio
from contextlib import aclosing
from typing import cast

import ravestate as rs
from ravestate.errors import PlatformError
from ravestate.modules import interloc, rawio

from .backend import Backend, Message, Role
from .choosing import choose
from .facts import asks_for_fact
from .history import History
from .listening import ListeningBackend
from .llama import LlamaBackend, checked_model
from .names import OLLAMA, Settings, chosen, history, model, module, trouble
from .openai import OpenAIBackend
from .pending import PendingBackend
from .progress import ProgressBar
from .transformers import TransformersBackend
from .utterance import Utterance

INTERRUPTED = "…"
"""The end of an interrupted utterance."""

KEPT = 64
"""The number of messages in the history; the settings say how many of them go into a prompt."""

LONGEST = 20_000
"""Characters of a message in the history; longer ones are cut."""


@module.rule(when=rs.startup, writes=(model, trouble), emits=chosen)
async def choose_model(ctx: rs.RuleContext) -> None:
    """Choose the backend. Early answers wait for the choice; a model is loaded at the first question."""
    pending, backend, fault = PendingBackend(), None, None
    ctx[model] = pending
    try:
        choice = await asyncio.to_thread(choose, ctx.settings)
        ctx.log.info("%s", choice.text)
        backend = make_backend(choice.settings)
        if choice.settings.backend == "gguf" and choice.settings.model_path is not None:
            await asyncio.to_thread(checked_model, choice.settings.model_path)
    except PlatformError as error:
        fault = error
        tell(ctx, error)
    finally:
        ctx.emit(chosen, backend)
        pending.resolve(backend, fault)


@module.rule(when=chosen.max_age(None).detached(), writes=model)
async def use(ctx: rs.RuleContext) -> rs.Resign | None:
    """Replace the stand-in by the chosen backend, unless the designer has written one of their own."""
    if not isinstance(ctx[model], PendingBackend):
        return rs.Resign("there is another backend already")
    ctx[model] = cast("Backend | None", ctx.payload(chosen))
    return None


@module.rule(when=rs.shutdown, reads=model)
async def let_go(ctx: rs.RuleContext) -> None:
    """Close the backend."""
    backend = ctx[model]
    if backend is not None:
        await backend.close()


@module.rule(when=rawio.input.changed.max_age(None).detached(), writes=history, background=True)
async def hear(ctx: rs.RuleContext) -> None:
    """Add the user's words to the history."""
    remember(ctx, "user", ctx.payload(rawio.input.changed))


@module.rule(when=rawio.output.changed.max_age(None).detached(), writes=history, background=True)
async def note(ctx: rs.RuleContext) -> None:
    """Add the agent's words to the history, from any rule."""
    said = ctx.payload(rawio.output.changed)
    lately = list(ctx[history].values())[-2:]
    if not (said.endswith(INTERRUPTED) and Message("assistant", said) in lately):  # `chat` was first
        remember(ctx, "assistant", said)


@module.rule(
    when=rawio.input.changed,
    reads=(model, interloc.agent),
    writes=(rawio.output, rawio.speaking, history, trouble),
    emits=rawio.piece,
    until=rawio.input.changed | rs.shutdown,  # a model that is still loading would delay the end
)
async def chat(ctx: rs.RuleContext) -> rs.Resign | None:
    """Answer with small talk, piece by piece; a new utterance interrupts it."""
    settings: Settings = ctx.settings
    heard, backend = ctx.payload(rawio.input.changed), ctx[model]
    if not heard.strip():
        return rs.Resign("nothing was said")
    if backend is None and not ctx[trouble]:
        return rs.Resign("there is no model")
    if not settings.facts and asks_for_fact(heard):
        ctx[rawio.output] = settings.no_facts
        return None
    if backend is None:
        ctx[rawio.output] = settings.no_model
        return None

    past = History(turns=settings.history_turns, characters=settings.history_characters)
    newest = Message("user", heard[:LONGEST])
    for message in ctx[history].values():
        past.add(message)
    if list(ctx[history].values())[-1:] != [newest]:  # `hear` may run later
        past.add(newest)
    name = settings.name or ctx[interloc.agent]
    told = past.prompt(settings.persona, name, settings.examples)
    if told[-1].role != "user":
        return rs.Resign("nothing was said but control characters, or marks of a template")
    utterance = Utterance(name, sentences=settings.sentences)
    shown = ""

    def show() -> None:
        nonlocal shown
        if not utterance.worth_saying() or utterance.text == shown:
            return
        if not shown:
            ctx[rawio.speaking] = True
        ctx.emit(rawio.piece, utterance.text[len(shown) :])
        shown = utterance.text

    answer = backend.stream(
        told,
        max_tokens=settings.max_tokens,
        temperature=settings.temperature,
        seed=ctx.random.getrandbits(31),
    )
    try:
        with ProgressBar("Loading the language model") as bar:
            await backend.load(bar)
        async with aclosing(answer) as pieces:
            async for piece in pieces:
                utterance.feed(piece)
                show()
                if utterance.complete:
                    break
        utterance.finish()
        if not utterance.worth_saying():
            return rs.Resign("the model said nothing")
        show()
        ctx[rawio.output] = utterance.text
        ctx[trouble] = ""
        return None
    except PlatformError as error:
        tell(ctx, error)
        ctx[rawio.output] = shown + INTERRUPTED if shown else settings.no_model
        return None
    except asyncio.CancelledError:
        if shown:  # keep the words that were said, before those that interrupted them
            remember(ctx, "assistant", shown + INTERRUPTED)
            ctx[rawio.output] = shown + INTERRUPTED
        raise
    finally:
        if shown:
            ctx[rawio.speaking] = False


def tell(ctx: rs.RuleContext, error: PlatformError) -> None:
    """Log what is wrong with the model, once."""
    if ctx[trouble] != str(error):
        ctx.log.error("%s", error)
        ctx[trouble] = str(error)


def remember(ctx: rs.RuleContext, role: Role, text: str) -> None:
    """Add a message to the history, and drop the oldest.

    Each message has a key of its own, so that none is lost when several are said at once (L13).
    """
    items = ctx[history]
    items.add(f"{ctx.now:.6f}/{ctx.random.getrandbits(32):08x}", Message(role, text[:LONGEST]))
    for oldest in list(items)[:-KEPT]:
        items.remove(oldest)


def make_backend(settings: Settings) -> Backend:
    """Return the backend that `settings` name; `choose` completes settings that leave it open.

    Raises:
        PlatformError: The server's address is malformed.
    """
    if settings.backend == "openai":
        return OpenAIBackend(
            settings.base_url or OLLAMA,
            settings.model or "llama3.2",
            api_key=settings.api_key,
            connect_timeout=settings.connect_timeout,
            read_timeout=settings.read_timeout,
        )
    if settings.backend == "transformers":
        return TransformersBackend(settings.model or "gpt2", read_timeout=settings.read_timeout)
    if settings.backend == "gguf" and settings.model_path is not None:
        return LlamaBackend(
            settings.model_path,
            context_tokens=settings.context_tokens,
            threads=settings.threads,
            read_timeout=settings.read_timeout,
        )
    return ListeningBackend()
