"""The rules of wildtalk. They choose the model, keep the history of the conversation, and make small talk.

A *backend* is an object that generates answers, usually with a language model. The *listening skill*
answers with authored phrases, without a model.
"""

from __future__ import annotations

import asyncio
from contextlib import aclosing
from typing import cast

import ravestate as rs
from ravestate.errors import PlatformError
from ravestate.language.bundled import ModelMissing, warn_once
from ravestate.language.chat import Backend, Message, Role
from ravestate.language.loading import wait_for_prompt
from ravestate.language.openai import OpenAIBackend
from ravestate.modules import interloc, nlp, rawio

from .choosing import choose
from .facts import asks_for_fact
from .history import History
from .listening import ListeningBackend, State
from .llama import LlamaBackend, checked_model
from .names import OLLAMA, Settings, chosen, clock, history, listening, model, module, notes, overheard, trouble
from .pending import PendingBackend
from .progress import ProgressBar
from .small_talk import (
    claims,
    follow_up,
    gate_for,
    heard_in,
    is_known,
    is_open,
    learn_all,
    listen,
    listener,
    may_suit,
    needs_comfort,
    notes_for,
    traces,
    up_to_date,
)
from .transformers import TransformersBackend
from .utterance import Utterance

INTERRUPTED = "…"
"""The end of an interrupted utterance."""

KEPT = 64
"""The maximum number of messages in the history. The settings limit how many of them go into a prompt."""

LONGEST = 20_000
"""The maximum number of characters of a message in the history; longer messages are cut."""


@module.rule(when=rs.startup, writes=(model, trouble), emits=chosen)
async def choose_model(ctx: rs.RuleContext) -> None:
    """Choose the backend. Early answers wait for the choice. The model is loaded for the first answer."""
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
    """Replace the `PendingBackend` with the chosen backend, unless the designer has put another backend into the slot."""
    if not isinstance(ctx[model], PendingBackend):
        return rs.Resign("there is another backend already")
    ctx[model] = cast("Backend | None", ctx.payload(chosen))
    return None


@module.rule(when=rs.startup, background=True)
def learn(ctx: rs.RuleContext) -> None:
    """Learn the examples of small talk in the background, so that the first utterance does not have to wait."""
    wait_for_prompt()
    try:
        learn_all()
    except ModelMissing as error:
        warn_once(ctx.log, error)
    except PlatformError as error:
        ctx.log.error("%s", error)


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
    """Add the agent's words to the history. Any rule may have said them."""
    said = ctx.payload(rawio.output.changed)
    lately = list(ctx[history].values())[-2:]
    # Skip an interrupted utterance, because `chat` has already added it.
    if not (said.endswith(INTERRUPTED) and Message("assistant", said) in lately):
        remember(ctx, "assistant", said)


@module.rule(when=rawio.heard.changed.max_age(None).detached(), writes=history, background=True)
async def keep_heard(ctx: rs.RuleContext) -> rs.Resign | None:
    """Cut an interrupted utterance in the history down to the words that the user heard."""
    heard = ctx.payload(rawio.heard.changed).strip()[:LONGEST]
    said = [(key, message.text) for key, message in ctx[history].items() if message.role == "assistant"]
    if any(text.strip() == heard for _, text in said[-4:]):
        return rs.Resign("the user heard all of it")
    for key, text in reversed(said):
        if text.startswith(heard):
            if heard:
                ctx[history].add(key, Message("assistant", heard + INTERRUPTED))
            else:
                ctx[history].remove(key)
            return None
    return rs.Resign("the history has no such utterance")


@module.rule(when=nlp.analysis.changed.max_age(None).detached(), reads=listening, writes=overheard, background=True)
def overhear(ctx: rs.RuleContext) -> rs.Resign | None:
    """Note the tone of every utterance, also of those that other modules answer."""
    seen = ctx.payload(nlp.analysis.changed)
    if seen is None:
        return rs.Resign("nothing was analysed")
    ctx[overheard] = traces(ctx, seen)
    return None


@module.rule(
    when=nlp.analysis.changed | rawio.input.changed,  # without an analysis, the input starts the rule
    reads=(model, nlp.analysis, nlp.text, interloc.agent, interloc.users, interloc.facts, notes, clock, overheard),
    writes=(rawio.output, rawio.speaking, history, trouble, listening),
    emits=rawio.piece,
    until=rawio.input.changed | rs.shutdown,  # otherwise, a model that is still loading would delay the shutdown
)
async def chat(ctx: rs.RuleContext) -> rs.Resign | None:
    """Answer with small talk, piece by piece. A new utterance interrupts the answer."""
    settings: Settings = ctx.settings
    seen = ctx.payload(nlp.analysis.changed)
    text, backend = ctx.payload(rawio.input.changed) if seen is None else seen.text, ctx[model]
    if not text.strip():
        return rs.Resign("nothing was said")
    if seen is None and ctx[nlp.analysis] is not None and ctx[nlp.text] == text:
        return rs.Resign("this rule has resigned from the analysed utterance")
    if backend is None and not ctx[trouble]:
        return rs.Resign("there is no model")
    if isinstance(backend, PendingBackend):
        backend = await backend.settled()
    heard = heard_in(ctx, text, seen)
    skill = await asyncio.to_thread(listener)  # the first call reads the phrases
    if isinstance(backend, ListeningBackend) or skill.performs(heard, ctx[listening]):
        ctx[rawio.output] = await listen(ctx, heard)
        return None
    asked = seen is not None and seen.question is not None
    if not settings.facts and await asyncio.to_thread(asks_for_fact, text, question=asked):
        ctx[rawio.output] = settings.no_facts
        return None
    if backend is None:
        ctx[rawio.output] = settings.no_model
        return None

    past = History(turns=settings.history_turns, characters=settings.history_characters)
    newest = Message("user", text[:LONGEST])
    for message in ctx[history].values():
        past.add(message)
    if list(ctx[history].values())[-1:] != [newest]:  # `hear` may not have added these words yet
        past.add(newest)
    name = settings.name or ctx[interloc.agent]
    told = past.prompt(settings.persona, name, settings.examples, notes=notes_for(ctx, heard))
    if told[-1].role != "user":
        return rs.Resign("nothing was said but control characters, or marks of a template")
    utterance = Utterance(name, sentences=settings.sentences)
    gate = gate_for(ctx, name, text) if settings.gate else None
    shown = ""

    async def show() -> bool:
        """Say the sentences that the gate has admitted so far; return False once it refuses a sentence."""
        nonlocal shown
        sayable, refused = utterance.text, False
        if gate is not None:
            sayable, refused = await asyncio.to_thread(gate.admit, utterance.text, last=utterance.complete)
        if utterance.worth_saying() and sayable != shown:
            if not shown:
                ctx[rawio.speaking] = True
            ctx.emit(rawio.piece, sayable[len(shown) :])
            shown = sayable
        return not refused

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
                if not await show() or utterance.complete:
                    break
        utterance.finish()
        if not utterance.worth_saying():
            if gate is None:
                return rs.Resign("the model said nothing")
            ctx[rawio.output] = await listen(ctx, heard)
            return None
        if not await show():
            ctx.log.debug("small talk left out a sentence: %s", gate and gate.reason)
        ctx[rawio.output] = shown or await listen(ctx, heard)
        ctx[trouble] = ""
        return None
    except PlatformError as error:
        tell(ctx, error)
        ctx[rawio.output] = shown + INTERRUPTED if shown else settings.no_model
        return None
    except asyncio.CancelledError:
        if shown:  # put the words said so far into the history, before the words that interrupted them
            remember(ctx, "assistant", shown + INTERRUPTED)
            ctx[rawio.output] = shown + INTERRUPTED
        raise
    finally:
        if shown:
            ctx[rawio.speaking] = False


@module.rule(
    when=nlp.analysis.changed & listening.holds(is_open),
    reads=(interloc.users, overheard, history),
    writes=(rawio.output, listening),
    weight=8.0,  # this rule outranks modules that would mistake a turn in a game for a question
)
async def go_on(ctx: rs.RuleContext) -> rs.Resign | None:
    """Continue a game, or react to the user's answer to a question of the listening skill."""
    seen = ctx.payload(nlp.analysis.changed)
    said = "" if seen is None else await follow_up(ctx, heard_in(ctx, seen.text, seen))
    if not said:
        return rs.Resign("the utterance is neither a turn in a game nor a reply to the agent's last answer")
    ctx[rawio.output] = said
    return None


@module.rule(
    when=nlp.analysis.changed.where(may_suit),
    reads=(model, interloc.users, overheard, history),
    writes=(rawio.output, listening),
    # This rule outranks modules that would only note a fact, such as the name in "I am Ann, my dog has died".
    weight=4.0,
)
async def comfort(ctx: rs.RuleContext) -> rs.Resign | None:
    """Answer sorrow, news, corrections and requests for a performance (a joke, a song, a game...).

    The rule also answers statements to which the listening skill has a reply. If a language model makes the small talk,
    the rule answers only requests for a performance.
    """
    seen = ctx.payload(nlp.analysis.changed)
    if seen is None:
        return rs.Resign("nothing was analysed")
    # The checks take up to 0.2 s, so they run in a thread, on values that are read here.
    heard, state, backend = heard_in(ctx, seen.text, seen), up_to_date(ctx, seen.text), ctx[model]
    skill = await asyncio.to_thread(listener)
    if not (isinstance(backend, ListeningBackend) or await asyncio.to_thread(skill.performs, heard, State())):
        return rs.Resign("a language model answers")
    suits = await asyncio.to_thread(claims, heard, state) or await asyncio.to_thread(needs_comfort, seen)
    if not (suits or await asyncio.to_thread(is_known, seen, state)):
        return rs.Resign("no known reply suits")
    ctx[rawio.output] = await listen(ctx, heard)
    return None


@module.rule(when=interloc.forgotten.max_age(None).detached(), writes=(history, listening, overheard), background=True)
async def forget(ctx: rs.RuleContext) -> None:
    """Delete the messages and the memory of the listening skill when the agent forgets the user."""
    for key in list(ctx[history]):
        ctx[history].remove(key)
    ctx[listening], ctx[overheard] = State(), ()


def tell(ctx: rs.RuleContext, error: PlatformError) -> None:
    """Log the model's fault, unless the last fault was the same."""
    if ctx[trouble] != str(error):
        ctx.log.error("%s", error)
        ctx[trouble] = str(error)


def remember(ctx: rs.RuleContext, role: Role, text: str) -> None:
    """Add a message to the history, and drop the oldest messages beyond `KEPT`.

    Each message has its own key, so that none is lost when several rules add messages at the same time (law L13 in
    docs/explanation/processing-model.md).
    """
    items = ctx[history]
    items.add(f"{ctx.now:.6f}/{ctx.random.getrandbits(32):08x}", Message(role, text[:LONGEST]))
    for oldest in list(items)[:-KEPT]:
        items.remove(oldest)


def make_backend(settings: Settings) -> Backend:
    """Return the backend that the settings describe. The settings must be complete, as `choose` returns them.

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
