"""Spoken conversations in virtual time: a recording replaces the user's microphone."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Literal

from ravestate.declare.core import shutdown
from ravestate.declare.module import Module
from ravestate.errors import EngineError
from ravestate.runtime.context import Context
from ravestate.runtime.rule_context import RuleContext
from ravestate.testing.virtual_loop import VirtualLoop

if TYPE_CHECKING:
    from ravestate.modules.platform.voiceio.mouth import Speech


@dataclass(frozen=True, slots=True)
class Said:
    """An utterance of one side, as the other side heard it.

    Attributes:
        speaker: ``user`` or ``agent``.
        text: The user's words, as speech recognition heard them, or those of the agent's words that the user heard.
        start, end: The times at which the sound began and ended (seconds on the recording's time line).
        cut: Whether the agent's utterance was cut off, because the user interrupted it or the agent ended.
        filler: Whether the utterance only filled a pause.
    """

    speaker: Literal["user", "agent"]
    text: str
    start: float
    end: float
    cut: bool = False
    filler: bool = False


def talk(
    recording: str | Path,
    output: str | Path | None,
    *modules: Module | ModuleType,
    settings: Mapping[str, Any] | None = None,
    seed: int | None = 0,
    show: Callable[[Said], None] | None = None,
    record: Callable[[Any], None] | None = None,
) -> list[Said]:
    """Hold a conversation between a recording and an agent, as fast as the machine can; return what was said.

    Time is virtual. Recognition, synthesis and plain functions take no virtual time, so the same recording gives the
    same conversation on any machine.

    Args:
        recording: The sound of the user's microphone, in any usual format.
        output: The WAV file for the loudspeaker's sound, on the time line of the recording; None for no file.
        modules: The agent's modules, without `voiceio`, which `talk` adds.
        settings: Name of a module → the module's settings, as for `Context`.
        seed: The seed of random choices.
        show: A function that receives each utterance when it is over. If the user speaks while the agent speaks, the
            function receives the agent's utterance first.
        record: A function that receives each record of the trace.

    Raises:
        PlatformError: The recording cannot be read; the output is no WAV file, or cannot be written; or a model or a
            program is missing.
        EngineError: An event loop runs in this thread already.
    """
    from ravestate.modules import voiceio
    from ravestate.modules.platform.voiceio.wav_line import check_target

    try:
        asyncio.get_running_loop()
    except RuntimeError:
        pass
    else:
        raise EngineError("talk runs a loop of its own: use it in a plain function, not in an async one")
    said: list[Said] = []

    def note(one: Said) -> None:
        said.append(one)
        if show is not None:
            show(one)

    given = {name: dict(values) for name, values in (settings or {}).items()}
    if output:
        check_target(Path(output))
    files = {"source": str(Path(recording).absolute()), "sink": str(Path(output).absolute()) if output else ""}
    given["voiceio"] = {**given.get("voiceio", {}), **files}
    context = Context(*modules, voiceio, transcript(note), settings=given, seed=seed, trace=record or False)

    async def hold() -> None:
        loop = asyncio.get_running_loop()
        assert isinstance(loop, VirtualLoop)
        async with context:
            loop.busy = context.plain_functions
            await context.until_stopped()

    with asyncio.Runner(loop_factory=VirtualLoop) as runner:  # at Ctrl-C, the runner lets the agent shut down
        runner.run(hold())
    return said


def transcript(note: Callable[[Said], None]) -> Module:
    """Return a module that calls `note` with each utterance of both sides when it is over.

    While the agent speaks, an utterance of the user waits until the agent's utterance is over.
    """
    from ravestate.modules import rawio, voiceio

    witness = Module("transcript", requires=[voiceio])
    begun: list[Speech] = []
    waiting: list[Said] = []

    def show() -> None:
        """Call `note` with the agent's utterances that are over; if the agent is then silent, also with the user's."""
        for one in [one for one in begun if one.over]:
            begun.remove(one)
            if one.heard.strip() and one.start is not None:
                cut = one.heard.strip() != one.text.strip()
                note(Said("agent", one.heard.strip(), one.start, one.end, cut, not one.counts))
        if all(one.start is None for one in begun):
            for one in waiting:
                note(one)
            waiting.clear()

    @witness.rule(when=voiceio.utterance.max_age(None).detached(), background=True)
    async def hear_user(ctx: RuleContext) -> None:
        """Call `note` with an utterance of the user; if the agent is speaking, after the agent's utterance."""
        one = ctx.payload(voiceio.utterance)
        waiting.append(Said("user", one.text, one.start, one.end))
        show()

    @witness.rule(when=voiceio.speech.max_age(None).detached(), background=True)
    async def wait_for_agent(ctx: RuleContext) -> None:
        """Keep an utterance of the agent until it is over."""
        begun.append(ctx.payload(voiceio.speech))

    @witness.rule(
        when=voiceio.agent_speaking.false.max_age(None).detached() | rawio.heard.changed.max_age(None).detached(),
        background=True,
    )
    async def hear_agent(ctx: RuleContext) -> None:
        """Call `note` with the utterances that wait, because an utterance of the agent is over."""
        show()

    @witness.rule(when=shutdown)
    async def end(ctx: RuleContext) -> None:
        """Call `note` with the remaining utterances."""
        show()  # the end of the agent has cut off its speech
        begun.clear()
        show()

    del hear_user, wait_for_agent, hear_agent, end
    return witness
