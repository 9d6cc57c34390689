"""An agent runs until a rule or Ctrl-C ends it cleanly. A second Ctrl-C ends it immediately."""

import asyncio
import gc
import os
import signal
import subprocess
import sys
import textwrap
import threading
import warnings
from pathlib import Path

import pytest

import ravestate as rs
from ravestate.modules import rawio
from ravestate.runtime.agent import Agent
from ravestate.runtime.run import run_context, run_servers, until_first_ends
from runtime.on_loop import on_loop, turns

LIMIT = 20


def test_a_rule_can_end_the_agent_and_rules_for_shutdown_still_run() -> None:
    m = rs.Module("m")
    told: list[str] = []

    @m.rule(when=rs.startup)
    async def leave(ctx: rs.RuleContext) -> None:
        told.append("start")
        ctx.stop()

    @m.rule(when=rs.shutdown)
    async def end(ctx: rs.RuleContext) -> None:
        await asyncio.sleep(0)
        told.append("end")

    rs.run(m)
    assert told == ["start", "end"]


def test_rs_run_takes_the_same_options_as_a_context() -> None:
    class Options(rs.Settings):
        word: str = "a"

    m = rs.Module("m", settings=Options)
    told: list[object] = []

    @m.rule(when=rs.startup)
    async def leave(ctx: rs.RuleContext) -> None:
        told.append(ctx.settings.word)
        told.append(ctx.random.random())
        ctx.stop()

    for _ in range(2):
        rs.run(m, settings={"m": {"word": "b"}}, seed=1)
    assert told[:2] == told[2:] and told[0] == "b"


def test_a_platform_with_many_users_gets_the_agent_and_makes_the_contexts() -> None:
    told: list[object] = []

    async def serve(agent: Agent) -> None:
        async with agent.context() as one, agent.context(seed=5) as other:
            assert one.policy is other.policy is agent.policy
            assert one.settings is not None
            for context, name in ((one, "Ada"), (other, "Bob")):
                context.put(heard, name)
                told.append(await context.next(said.changed))

    class Options(rs.Settings):
        word: str = "Hello"
        pause: float = 0.0

    m = rs.Module("m", serve=serve, settings=Options)
    heard, said = m.slot("heard", ""), m.slot("said", "")

    @m.rule(when=heard.changed.min_age(Options.pause), writes=said)
    async def greet(ctx: rs.RuleContext) -> None:
        ctx[said] = f"{ctx.settings.word}, {ctx.payload(heard.changed)}!"

    rs.run(m, settings={"m": {"word": "Hi"}})
    assert told == ["Hi, Ada!", "Hi, Bob!"]


def test_when_one_server_fails_the_others_end_and_the_failure_is_raised() -> None:
    ends: list[str] = []

    async def stay(_: Agent) -> None:
        try:
            await asyncio.get_running_loop().create_future()
        finally:
            ends.append("stay")

    async def fail(_: Agent) -> None:
        raise rs.PlatformError("the port is taken")

    with pytest.raises(rs.PlatformError, match="the port is taken"):
        rs.run(rs.Module("a", serve=stay), rs.Module("b", serve=fail))
    assert ends == ["stay"]


def test_an_interrupt_cancels_a_server_which_can_clean_up() -> None:
    ends: list[str] = []

    async def stay(_: Agent) -> None:
        asyncio.get_running_loop().call_soon(os.kill, os.getpid(), signal.SIGINT)
        try:
            await asyncio.get_running_loop().create_future()
        finally:
            ends.append("stay")

    rs.run(rs.Module("a", serve=stay))
    assert ends == ["stay"]


def test_a_rule_can_end_the_agent_with_an_error() -> None:
    m = rs.Module("m")
    told: list[str] = []

    @m.rule(when=rs.startup)
    async def leave(ctx: rs.RuleContext) -> None:
        ctx.stop(rs.PlatformError("the robot is gone"))
        ctx.stop()

    @m.rule(when=rs.shutdown)
    async def end(ctx: rs.RuleContext) -> None:
        told.append("end")

    with pytest.raises(rs.PlatformError, match="the robot is gone"):
        rs.run(m)
    assert told == ["end"]


def leaver(*requires: rs.Module) -> rs.Module:
    m = rs.Module("m", requires=requires)

    @m.rule(when=rs.startup)
    async def leave(ctx: rs.RuleContext) -> None:
        ctx.stop()

    return m


def test_a_warning_says_that_no_user_can_talk_to_the_agent(caplog: pytest.LogCaptureFixture) -> None:
    rs.run(leaver(rawio.module))
    (record,) = caplog.records
    assert "no rule writes rawio:input; name a platform too, e.g. conio" in record.getMessage()


def test_an_agent_with_a_platform_or_without_rawio_causes_no_warning(caplog: pytest.LogCaptureFixture) -> None:
    rs.run(leaver())
    platform = leaver(rawio.module)

    @platform.rule(when=rawio.picture.changed, writes=rawio.input)
    async def hear(ctx: rs.RuleContext) -> None: ...

    rs.run(platform)
    assert not caplog.records


def test_faults_are_raised_before_anything_runs() -> None:
    with pytest.raises(rs.DeclarationErrors):
        rs.run("nonsense")


def test_an_agent_can_run_in_a_thread() -> None:
    m = rs.Module("m")
    told: list[str] = []

    @m.rule(when=rs.startup)
    async def leave(ctx: rs.RuleContext) -> None:
        told.append("ran")
        ctx.stop()

    thread = threading.Thread(target=rs.run, args=(m,))
    thread.start()
    thread.join(LIMIT)
    assert told == ["ran"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signal_handlers_are_set_only_while_the_agent_runs(number: signal.Signals) -> None:
    m = rs.Module("m")
    before = signal.getsignal(number)

    @m.rule(when=rs.startup)
    async def hit(ctx: rs.RuleContext) -> None:
        os.kill(os.getpid(), number)

    async def main() -> None:
        async with asyncio.timeout(LIMIT):
            await run_context(rs.Context(m))

    asyncio.run(main())
    assert signal.getsignal(number) is before


@on_loop
async def test_a_cancellation_from_outside_is_not_swallowed() -> None:
    ends: list[str] = []
    m = rs.Module("m")

    @m.rule(when=rs.shutdown)
    async def end(ctx: rs.RuleContext) -> None:
        ends.append("farewell")

    running = asyncio.create_task(run_context(rs.Context(m)))
    await turns()
    running.cancel()
    with pytest.raises(asyncio.CancelledError):
        await running
    assert running.cancelled() and ends == ["farewell"]


@on_loop
async def test_a_timeout_around_a_context_or_a_server_raises_timeout_error() -> None:
    ends: list[str] = []

    async def stay(_: Agent) -> None:
        try:
            await asyncio.get_running_loop().create_future()
        finally:
            ends.append("stay")

    for running in (run_context(rs.Context(rs.Module("m"))), run_servers(Agent(rs.Module("m")), [stay])):
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(0.001):
                await running
    assert ends == ["stay"]


@on_loop
async def test_rs_run_in_a_running_loop_is_refused_and_leaves_no_coroutine() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(rs.EngineError, match=r"rs.run starts an event loop.*async with rs.Context"):
            rs.run(rs.Module("m"))
        gc.collect()  # a coroutine that was never awaited causes a warning when it is deleted


async def _for_ever(ended: list[str]) -> None:
    try:
        await asyncio.Event().wait()
    finally:
        ended.append("for ever")


async def _end() -> None:
    """End immediately."""


async def _fail() -> None:
    raise rs.PlatformError("too slow")


def test_when_one_task_ends_the_others_are_cancelled_and_its_error_is_raised() -> None:
    ended: list[str] = []
    asyncio.run(until_first_ends(_for_ever(ended), _end()))
    with pytest.raises(rs.PlatformError, match="too slow"):
        asyncio.run(until_first_ends(_fail(), _for_ever(ended), _for_ever(ended)))
    assert ended == ["for ever"] * 3


AGENT = """
    import asyncio, sys
    import ravestate as rs
    m = rs.Module("m")

    def tell(text):
        print(text, flush=True)

    @m.rule(when=rs.startup)
    async def long(ctx):
        tell("running")
        try:
            await asyncio.get_running_loop().create_future()
        finally:
            tell("cleaned up")

    @m.rule(when=rs.shutdown)
    async def farewell(ctx):
        tell("farewell")
        if "slow" in sys.argv:
            try:
                await asyncio.get_running_loop().create_future()
            finally:
                tell("broken off")
        while "stubborn" in sys.argv:
            try:
                await asyncio.get_running_loop().create_future()
            except asyncio.CancelledError:
                tell("no")

    rs.run(m)
    tell("ended")
"""


def started(folder: Path, *arguments: str) -> subprocess.Popen[str]:
    file = folder / "agent.py"
    file.write_text(textwrap.dedent(AGENT), encoding="utf-8")
    return subprocess.Popen(
        [sys.executable, str(file), *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_one_operating_system_signal_ends_the_agent_cleanly(tmp_path: Path, number: signal.Signals) -> None:
    with started(tmp_path) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "running\n"
        process.send_signal(number)
        out, errors = process.communicate(timeout=LIMIT)
    assert out.splitlines() == ["farewell", "cleaned up", "ended"]
    assert (process.returncode, errors) == (0, "")


@pytest.mark.parametrize(
    ("manner", "said"),
    [("slow", ["broken off", "cleaned up", "ended"]), ("stubborn", ["cleaned up", "ended", "no"])],
)
def test_a_second_operating_system_signal_aborts_the_shutdown(tmp_path: Path, manner: str, said: list[str]) -> None:
    with started(tmp_path, manner) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "running\n"
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "farewell\n"
        process.send_signal(signal.SIGINT)
        out, errors = process.communicate(timeout=LIMIT)
    assert sorted(out.splitlines()) == said
    assert (process.returncode, errors) == (0, "")
