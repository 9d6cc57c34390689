"""The console module: a scripted user talks to an agent."""

import asyncio
import threading
from collections import deque
from pathlib import Path
from typing import Any

import pytest

import ravestate as rs
from ravestate.errors import PlatformError
from ravestate.language import loading
from ravestate.modules import conio, idle, interloc, rawio
from ravestate.modules.platform.conio.console import Console
from ravestate.modules.platform.conio.pipes import Pipes
from ravestate.testing import simulate

parrot = rs.Module("parrot", requires=(rawio, interloc))


@parrot.rule(when=rawio.input.changed, writes=rawio.output, emits=rawio.piece, until=rawio.input.changed)
async def repeat(ctx: rs.RuleContext) -> None:
    heard = ctx.payload(rawio.input.changed)
    for word in heard.split(" ")[:-1]:
        ctx.emit(rawio.piece, word + " ")
        await ctx.sleep(1.0)
    ctx[rawio.output] = heard


@parrot.rule(when=interloc.users.removed, writes=rawio.output)
async def miss(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "Bye!"


stammer = rs.Module("stammer", requires=(rawio,))


@stammer.rule(when=rawio.input.changed, writes=rawio.speaking, emits=rawio.piece)
async def fail(ctx: rs.RuleContext) -> None:
    ctx[rawio.speaking] = True
    ctx.emit(rawio.piece, "I, I")
    ctx[rawio.speaking] = False


class Keys:
    """A screen for which a test types lines. It keeps its output in `log`."""

    def __init__(self, *, interactive: bool = True) -> None:
        self.interactive = interactive
        self.typed: deque[str | BaseException] = deque()
        self.more = asyncio.Event()
        self.log: list[str] = []

    def type(self, *lines: str | BaseException) -> None:
        self.typed += lines
        self.more.set()

    async def __aenter__(self) -> object:
        return self

    async def __aexit__(self, *_: object) -> None:
        self.log.append("closed")

    async def read(self) -> str:
        while not self.typed:
            self.more.clear()
            await self.more.wait()
        line = self.typed.popleft()
        if isinstance(line, BaseException):
            raise line
        return line

    def show(self, text: str) -> None:
        self.log.append(text)

    def stream(self, piece: str) -> None:
        self.log.append(f"{piece}…")

    def end(self) -> None:
        self.log.append("end")


@pytest.fixture
def keys(monkeypatch: pytest.MonkeyPatch) -> Keys:
    keys = Keys()
    monkeypatch.setattr(conio.rules, "Console", lambda **_: Console(keys))
    return keys


def test_the_terminal_library_loads_in_another_thread(keys: Keys, monkeypatch: pytest.MonkeyPatch) -> None:
    threads: list[threading.Thread] = []

    def note(**_: Any) -> Console:
        threads.append(threading.current_thread())
        return Console(keys)

    monkeypatch.setattr(conio.rules, "prepare", note)
    monkeypatch.setattr(conio.rules, "Console", note)
    with simulate(parrot, conio):
        pass
    assert len(threads) == 2 and threading.current_thread() not in threads


def test_models_load_after_the_prompt_appears(keys: Keys, monkeypatch: pytest.MonkeyPatch) -> None:
    free: list[bool] = []

    def make(**_: Any) -> Console:
        free.append(may_load())
        return Console(keys)

    monkeypatch.setattr(loading, "LONGEST", 0.0)
    monkeypatch.setattr(conio.rules, "Console", make)
    with simulate(parrot, conio):
        assert free == [False]
        assert may_load()


def test_models_load_without_a_console(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(**_: Any) -> Console:
        raise PlatformError("there is no terminal")

    monkeypatch.setattr(conio.rules, "Console", fail)
    with simulate(parrot, conio):
        assert may_load()


def test_a_model_that_is_needed_can_be_loaded_while_the_console_opens(
    keys: Keys, monkeypatch: pytest.MonkeyPatch
) -> None:
    free: list[bool] = []

    def make(**_: Any) -> Console:  # this runs in another thread
        free.append(loading.LOADING.acquire(timeout=10))
        loading.LOADING.release()
        return Console(keys)

    monkeypatch.setattr(conio.rules, "Console", make)
    with simulate(parrot, conio):
        assert free == [True]


def may_load() -> bool:
    """Return whether models may load now, because no prompt is about to appear."""
    return loading.wait_for_prompt()


def test_a_user_who_types_does_not_make_the_agent_bored(keys: Keys, monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[Any] = []
    monkeypatch.setattr(conio.rules, "Console", lambda on_key, **_: told.append(on_key) or Console(keys))
    lonely = rs.Module("lonely", requires=(rawio, idle))

    @lonely.rule(when=idle.bored, writes=rawio.output)
    async def ask(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "Are you there?"

    with simulate(parrot, lonely, conio, settings={"idle": {"bored_after": 5.0}}) as sim:
        for _ in range(10):
            sim.advance(2.0)
            told[0]()
        assert sim.said == []
        keys.type("hello")
        sim.advance(6.0)
        assert sim.said == ["hello", "Are you there?"]


def test_the_agent_knows_and_hears_the_user_at_the_console(keys: Keys) -> None:
    with simulate(parrot, conio, settings={"conio": {"name": "Ada"}}) as sim:
        assert dict(sim.read(interloc.users)) == {"conio": "Ada"}
        assert isinstance(sim.read(conio.screen), Console)
        keys.type("hello", " ", "hello")
        sim.settle()
        assert sim.said == ["hello", "hello"]
        assert keys.log == ["hello", "hello"]
    assert keys.log[-1] == "closed"


def test_a_growing_utterance_is_shown_piece_by_piece(keys: Keys) -> None:
    with simulate(parrot, conio) as sim:
        keys.type("how are you")
        sim.settle()
        assert keys.log == ["how …"]
        sim.advance(1.0)
        assert keys.log == ["how …", "are …"]
        sim.advance(1.0)
        assert keys.log == ["how …", "are …", "you…", "end"]


@pytest.mark.parametrize("end", [EOFError(), KeyboardInterrupt(), BrokenPipeError()])
def test_the_end_of_input_ends_the_agent_after_a_farewell(keys: Keys, end: BaseException) -> None:
    with simulate(parrot, conio) as sim:
        keys.type(end)
        sim.settle()
        assert sim.said == ["Bye!"]
        assert dict(sim.read(interloc.users)) == {}
        assert sim.read(conio.screen) is None
        with pytest.raises(StopIteration):  # it returns at once, because the agent is to end
            sim.context.until_stopped().send(None)
    assert not sim.failures


def test_a_user_who_ends_the_input_gets_the_last_answer(keys: Keys) -> None:
    with simulate(parrot, conio) as sim:
        keys.type("one two", EOFError())
        sim.advance(1.0)
        assert sim.said == ["one two", "Bye!"]


def test_a_user_who_presses_ctrl_c_gets_no_answer(keys: Keys) -> None:
    with simulate(parrot, conio) as sim:
        keys.type("one two", KeyboardInterrupt())
        sim.settle()
        assert sim.said == ["Bye!"]


def test_a_line_of_streamed_pieces_ends_even_if_no_utterance_follows(keys: Keys) -> None:
    with simulate(stammer, conio) as sim:
        keys.type("hello")
        sim.settle()
        assert keys.log == ["I, I…", "end"]


def test_the_agent_ends_with_an_error_if_the_console_cannot_be_opened(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(**_: Any) -> Console:
        raise PlatformError("conio on a terminal needs prompt_toolkit")

    monkeypatch.setattr(conio.rules, "Console", missing)
    with pytest.raises(PlatformError, match="needs prompt_toolkit"):
        rs.run(conio)


def test_each_line_of_a_pipe_is_answered_before_the_next_is_read(keys: Keys) -> None:
    keys.interactive = False
    with simulate(parrot, conio) as sim:
        keys.type("one two", "three four", EOFError())
        sim.settle()
        assert sim.said == []
        sim.advance(1.0)
        assert sim.said == ["one two"]
        sim.advance(1.0)
        assert sim.said == ["one two", "three four", "Bye!"]


def test_a_setting_turns_the_history_off(monkeypatch: pytest.MonkeyPatch, keys: Keys) -> None:
    seen: list[dict[str, Any]] = []
    monkeypatch.setattr(conio.rules, "Console", lambda **options: seen.append(options) or Console(keys))
    monkeypatch.setattr(conio.rules, "history_file", lambda: Path("file"))
    for history in (True, False):
        with simulate(conio, settings={"conio": {"history": history, "prompt": "$ "}}):
            pass
    told = [(options["prompt"], options["history"]) for options in seen]
    assert told == [("$ ", Path("file")), ("$ ", None)]


def test_a_terminal_first_shows_how_to_end_the_conversation(keys: Keys, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(conio.rules, "is_terminal", lambda *_: True)
    with simulate(parrot, conio) as sim:
        keys.type("one")
        sim.settle()
        assert keys.log == ["Ctrl-D ends the conversation.", "one"]


def test_the_setting_plain_avoids_the_terminal_library(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[Any] = []

    def missing(*, screen: Any, **_: Any) -> Console:
        seen.append(screen)
        raise PlatformError("this console stops here")

    monkeypatch.setattr(conio.rules, "Console", missing)
    with pytest.raises(PlatformError):
        rs.run(conio, settings={"conio": {"plain": True}})
    assert isinstance(seen[0], Pipes)
