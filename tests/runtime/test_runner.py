"""The runner on a real loop: the conversation continues even if rules fail, hang or block."""

import asyncio
import functools
import logging
import re
import threading
from typing import Any

import pytest

import ravestate as rs
from ravestate.engine.trace import Record, Settled, Started
from ravestate.runtime import runner as runner_file
from ravestate.runtime.async_rules import GRACE
from ravestate.testing import simulate
from runtime.on_loop import on_loop, turns

HERE = re.escape(__file__)
LIMIT = 20.0


class Talk:
    """A module in which a fallback answers if the rule under test does not."""

    def __init__(self) -> None:
        self.module = rs.Module("m")
        self.heard: rs.Slot[Any] = self.module.slot("heard", "", always=True)
        self.said = self.module.slot("said", "", always=True)
        self.note = self.module.slot("note", "")
        self.stop = self.module.signal("stop")
        self.word = self.module.signal("word")
        self.failures: list[rs.RuleFailure] = []

        @self.module.rule(when=self.heard.changed, writes=self.said)
        async def fallback(ctx: rs.RuleContext) -> None:
            ctx[self.said] = "fallback"

        @self.module.rule(when=rs.error)
        async def hear_error(ctx: rs.RuleContext) -> None:
            self.failures.append(ctx.payload(rs.error))

    def rule(self, function: Any, **options: Any) -> Any:
        options = {"writes": self.said, "weight": 2.0} | options
        return self.module.rule(when=self.heard.changed, **options)(function)

    async def ask(self, context: rs.Context, text: Any = "hello") -> str:
        """Say something, and wait for the answer."""
        answer = asyncio.ensure_future(context.next(self.said.changed))
        await turns(1)
        context.put(self.heard, text)
        found = await answer
        await context.quiet()
        return found


@pytest.fixture
def talk() -> Talk:
    return Talk()


def only_failure(talk: Talk) -> BaseException:
    (failure,) = talk.failures
    talk.failures.clear()
    return failure.exception


# ---------------------------------------------------------------------------------------- rules that fail


class Strange(BaseException):
    pass


def raising(error: BaseException, where: str) -> Any:
    """Return a rule function that raises an error immediately, after waiting, or in a thread."""

    async def immediately(ctx: rs.RuleContext) -> None:
        raise error

    async def later(ctx: rs.RuleContext) -> None:
        await asyncio.sleep(0)
        raise error

    def in_thread(ctx: rs.RuleContext) -> None:
        raise error

    return {"immediately": immediately, "later": later, "in a thread": in_thread}[where]


WHERE = pytest.mark.parametrize("where", ["immediately", "later", "in a thread"])


@WHERE
@pytest.mark.parametrize(
    "error", [ValueError("broken"), Strange("odd"), asyncio.CancelledError(), TimeoutError(), GeneratorExit()]
)
@on_loop
async def test_the_error_of_a_rule_is_logged_once_and_the_next_best_rule_answers(
    error: BaseException, where: str
) -> None:
    talk = Talk()
    talk.rule(raising(error, where), name="fails")
    handler = Records()
    with handler:
        async with rs.Context(talk.module) as context:
            assert await talk.ask(context) == "fallback"
            failure = only_failure(talk)
            assert type(failure) is type(error)
            (record,) = handler.records
            assert record.levelno == logging.ERROR and record.getMessage().startswith("rule m:fails failed: ")
            assert record.exc_info is not None and record.exc_info[1] is failure
            assert await talk.ask(context) == "fallback"  # the conversation continues


def test_an_error_handler_that_takes_too_long_causes_no_further_error() -> None:
    module = rs.Module("m")
    begin = module.signal("begin", input=True)
    seen: list[str] = []

    @module.rule(when=begin)
    async def fail(ctx: rs.RuleContext) -> None:
        raise ValueError("broken")

    @module.rule(when=rs.error, timeout=0.5)
    async def report(ctx: rs.RuleContext) -> None:
        seen.append(ctx.payload(rs.error).rule)
        await ctx.sleep(10.0)

    with simulate(module) as sim:
        sim.emit(begin)
        sim.advance(5.0)
    assert seen == ["m:fail"]


def test_the_trace_has_the_line_in_which_a_rule_failed() -> None:
    module = rs.Module("m")
    go, slow = module.signal("go"), module.signal("slow")

    def deeper() -> None:
        raise ValueError("no stairs")

    @module.rule(when=go)
    async def climb(ctx: rs.RuleContext) -> None:
        deeper()

    @module.rule(when=slow)
    def parse(ctx: rs.RuleContext) -> None:
        int("twelve")  # the error comes from built-in code, which has no file

    with simulate(module) as sim:
        sim.emit(go)
        sim.emit(slow)
        sim.advance(1)
        reasons = {record.rule: record.reason for record in sim.trace if isinstance(record, Settled)}
    line = deeper.__code__.co_firstlineno + 1
    assert reasons["m:climb"] == f"ValueError('no stairs') (test_runner.py:{line})"
    assert re.fullmatch(r"ValueError\(.*\(test_runner\.py:\d+\)", reasons["m:parse"])


@on_loop
async def test_a_platform_error_is_logged_without_a_traceback() -> None:
    talk = Talk()
    talk.rule(raising(rs.PlatformError("no microphone: plug one in"), "immediately"), name="hears")
    with Records() as log:
        async with rs.Context(talk.module) as context:
            assert await talk.ask(context) == "fallback"
    (record,) = log.records
    assert record.getMessage() == "rule m:hears failed: no microphone: plug one in"
    assert record.exc_info is None


class Records(logging.Handler):
    """Collects the records that ravestate logs within a ``with`` block."""

    def __init__(self) -> None:
        super().__init__()
        self.records: list[logging.LogRecord] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.records.append(record)

    def __enter__(self) -> "Records":
        logging.getLogger("ravestate").addHandler(self)
        return self

    def __exit__(self, *_: object) -> None:
        logging.getLogger("ravestate").removeHandler(self)

    @property
    def messages(self) -> list[str]:
        return [record.getMessage() for record in self.records]


@WHERE
@on_loop
async def test_sys_exit_does_not_end_the_process(where: str) -> None:
    talk = Talk()
    talk.rule(raising(SystemExit(3), where), name="leaves")
    async with rs.Context(talk.module) as context:
        assert await talk.ask(context) == "fallback"
        failure = only_failure(talk)
        assert isinstance(failure, rs.RuleError) and isinstance(failure.__cause__, SystemExit)
        assert re.match(rf"rule m:leaves \({HERE}:\d+\) called sys.exit", str(failure))
        assert str(failure).endswith("write ctx.stop() to end the agent")
        assert await talk.ask(context) == "fallback"


def test_a_keyboard_interrupt_ends_the_context_and_its_task() -> None:
    talk = Talk()
    ended: list[bool] = []
    talk.rule(raising(KeyboardInterrupt(), "immediately"), name="interrupts")

    async def main() -> None:
        try:
            async with rs.Context(talk.module) as context:
                context.put(talk.heard, "hello")
                await asyncio.get_running_loop().create_future()
        finally:
            ended.append(True)

    with pytest.raises(KeyboardInterrupt):
        asyncio.run(main())
    assert ended == [True]


@pytest.mark.parametrize("nonsense", ["an answer", 0, False, (), rs.Module("x")])
@on_loop
async def test_the_message_about_a_returned_value_says_what_to_write(nonsense: object) -> None:
    talk = Talk()

    async def answers(ctx: rs.RuleContext) -> object:
        return nonsense

    talk.rule(answers)
    async with rs.Context(talk.module) as context:
        assert await talk.ask(context) == "fallback"
        failure = only_failure(talk)
        assert isinstance(failure, rs.RuleError)
        assert re.match(rf"rule m:answers \({HERE}:\d+\) returned {re.escape(repr(nonsense))};", str(failure))
        assert "a rule may only return None, rs.Resign(reason) or rs.Retire(); write the result" in str(failure)


@on_loop
async def test_the_message_about_a_huge_returned_value_is_short() -> None:
    talk = Talk()

    async def answers(ctx: rs.RuleContext) -> str:
        return "x" * 10_000_000

    talk.rule(answers)
    async with rs.Context(talk.module) as context:
        assert await talk.ask(context) == "fallback"
        assert len(str(only_failure(talk))) < 400


@on_loop
async def test_the_message_about_a_plain_wrapper_of_an_async_rule_says_what_to_write() -> None:
    talk = Talk()

    async def answer(ctx: rs.RuleContext) -> None:
        ctx[talk.said] = "never"

    @functools.wraps(answer)
    def wrapper(ctx: rs.RuleContext) -> Any:
        return answer(ctx)

    talk.rule(wrapper)
    async with rs.Context(talk.module) as context:
        assert await talk.ask(context) == "fallback"
        assert "is a plain function that returned a coroutine: write async def" in str(only_failure(talk))


@on_loop
async def test_no_other_rule_answers_if_a_rule_fails_after_it_has_written() -> None:
    talk = Talk()

    async def halfway(ctx: rs.RuleContext) -> None:
        ctx[talk.said] = "half"
        raise ValueError

    talk.rule(halfway)
    async with rs.Context(talk.module, trace=True) as context:
        assert await talk.ask(context) == "half"
        assert isinstance(only_failure(talk), ValueError)
        assert context.read(talk.said) == "half"


@pytest.mark.parametrize("outcome", [rs.Resign("not now"), rs.Retire("enough")])
@pytest.mark.parametrize("how", ["return", "raise"])
@on_loop
async def test_outcomes_can_be_returned_or_raised(outcome: Any, how: str) -> None:
    talk = Talk()

    async def decide(ctx: rs.RuleContext) -> Any:
        if how == "raise":
            raise outcome
        return outcome

    talk.rule(decide)
    async with rs.Context(talk.module) as context:
        if isinstance(outcome, rs.Resign):
            assert await talk.ask(context) == "fallback"
        else:
            context.put(talk.heard, "hello")
            await context.quiet()
        assert context.explain("m:decide").retired == isinstance(outcome, rs.Retire)
        assert talk.failures == []


@on_loop
async def test_a_predicate_that_fails_counts_as_false_and_the_error_names_it() -> None:
    talk = Talk()

    async def picky(ctx: rs.RuleContext) -> None:
        ctx[talk.said] = "picky"

    talk.module.rule(when=talk.heard.changed.where(lambda text: text.upper()), writes=talk.said)(picky)
    async with rs.Context(talk.module) as context:
        assert await talk.ask(context, 3) == "fallback"
        assert isinstance(only_failure(talk), AttributeError)
        assert await talk.ask(context, "x") == "picky"


# ---------------------------------------------------------------------------------------- undeclared

UNDECLARED = {
    "read": (lambda talk, ctx: ctx[talk.note], "read m:note without declaring it: add reads=note"),
    "write": (
        lambda talk, ctx: ctx.__setitem__(talk.note, "x"),
        "wrote m:note without declaring it: declare writes=(said, note)",
    ),
    "emit": (lambda talk, ctx: ctx.emit(talk.word), "emitted m:word without declaring it: add emits=word"),
}


@pytest.mark.parametrize("did", list(UNDECLARED))
@pytest.mark.parametrize("thread", [False, True])
@on_loop
async def test_the_message_about_an_undeclared_act_has_the_line_to_add(did: str, thread: bool) -> None:
    talk = Talk()
    act, text = UNDECLARED[did]

    def plain(ctx: rs.RuleContext) -> None:
        act(talk, ctx)

    async def trespass(ctx: rs.RuleContext) -> None:
        act(talk, ctx)

    talk.rule(plain if thread else trespass, name="trespass")
    async with rs.Context(talk.module) as context:
        assert await talk.ask(context) == "fallback"
        failure = only_failure(talk)
        assert isinstance(failure, rs.UndeclaredError)
        assert re.match(rf"rule m:trespass \({HERE}:\d+\) {re.escape(text)} (to|in) @m.rule\(\.\.\.\)", str(failure))


# ---------------------------------------------------------------------------------------- cancelled rules


def test_the_last_writes_of_a_cancelled_rule_come_before_those_of_its_successor() -> None:
    m = rs.Module("m")
    go, face = m.signal("go"), m.slot("face", "calm")
    faces: list[str] = []

    @m.rule(when=go, writes=face, until=go)
    async def smile(ctx: rs.RuleContext) -> None:
        ctx[face] = "happy"
        try:
            # With `wait_for`, a cancellation takes several turns of the loop.
            await asyncio.wait_for(ctx.sleep(3.0), 60.0)
        finally:
            ctx[face] = "calm"

    @m.rule(when=face.changed.detached())
    async def show(ctx: rs.RuleContext) -> None:
        faces.append(ctx.payload(face.changed))

    with simulate(m) as sim:
        sim.emit(go)
        sim.advance(2.0)
        sim.emit(go)
        assert sim.read(face) == "happy"
        sim.advance(2.9)
        assert faces == ["happy", "calm", "happy"]
        sim.advance(0.1)
        assert faces == ["happy", "calm", "happy", "calm"]


def test_a_cancelled_rule_that_cleans_up_slowly_delays_no_other_rule() -> None:
    m = rs.Module("m")
    go, stop, note = m.signal("go"), m.signal("stop"), m.slot("note", "")

    @m.rule(when=go, until=stop)
    async def linger(ctx: rs.RuleContext) -> None:
        try:
            await ctx.sleep(60.0)
        finally:
            await ctx.sleep(1.0)

    @m.rule(when=stop, writes=note)
    async def answer(ctx: rs.RuleContext) -> None:
        ctx[note] = "stopped"

    with simulate(m) as sim:
        sim.emit(go)
        sim.emit(stop)
        assert sim.read(note) == "stopped" and sim.fired == ["m:answer"]
        sim.advance(1.0)
        assert sim.fired == ["m:answer", "m:linger"]


def test_a_thousand_cancellations_in_one_instant_are_not_reported_as_an_endless_loop() -> None:
    m = rs.Module("m")
    go, done = m.signal("go"), m.slot("done", 0)

    @m.rule(when=go, until=go)
    async def work(ctx: rs.RuleContext) -> None:
        await ctx.sleep(1.0)

    @m.rule(when=go, writes=done)
    async def count(ctx: rs.RuleContext) -> None:
        ctx[done] += 1

    with simulate(m) as sim:
        for _ in range(1000):
            sim.context.emit(go)
        sim.settle()
        for _ in range(1000):
            sim.emit(go)
        assert sim.read(done) == 2000


# ---------------------------------------------------------------------------------------- plain functions


@on_loop
async def test_a_plain_function_runs_in_a_thread() -> None:
    talk = Talk()
    threads: list[int] = []

    def slow(ctx: rs.RuleContext) -> None:
        threads.append(threading.get_ident())
        ctx[talk.said] = ctx.payload(talk.heard.changed).upper()
        assert ctx[talk.said] == "HELLO"  # the rule sees its own write
        ctx.emit(talk.word)

    talk.rule(slow, emits=talk.word)
    async with rs.Context(talk.module) as context:
        assert await talk.ask(context) == "HELLO"
        assert threads != [threading.get_ident()]
        assert talk.failures == []


@pytest.mark.parametrize("how", ["return", "raise"])
@on_loop
async def test_a_plain_function_can_resign(how: str) -> None:
    talk = Talk()

    def resigns(ctx: rs.RuleContext) -> rs.Resign:
        if how == "raise":
            raise rs.Resign("no")
        return rs.Resign("no")

    talk.rule(resigns)
    async with rs.Context(talk.module) as context:
        assert await talk.ask(context) == "fallback"
        assert talk.failures == []


class Greeter:
    async def __call__(self, ctx: rs.RuleContext) -> None:
        await self.greet(ctx)

    async def greet(self, ctx: rs.RuleContext) -> None:
        await asyncio.sleep(0)
        ctx[ctx.rule.writes[0]] = threading.current_thread().name


class Heir(Greeter):
    """A class that inherits ``__call__``."""


class Caller:
    def __call__(self, ctx: rs.RuleContext) -> None:
        ctx[ctx.rule.writes[0]] = threading.current_thread().name


async def with_more(word: str, ctx: rs.RuleContext) -> None:
    await Greeter().greet(ctx)


def plain_with_more(word: str, ctx: rs.RuleContext) -> None:
    Caller()(ctx)


@pytest.mark.parametrize(
    "function",
    [
        functools.partial(with_more, "word"),
        functools.partial(functools.partial(with_more), "word"),
        functools.partial(Greeter()),
        Greeter(),
        Heir(),
        Greeter().greet,
    ],
)
@on_loop
async def test_a_partial_an_object_or_a_method_can_be_an_async_rule(function: Any) -> None:
    talk = Talk()
    rule = talk.rule(function, name="greets")
    assert rule.is_async
    async with rs.Context(talk.module) as context:
        assert await talk.ask(context) == threading.main_thread().name
        assert talk.failures == []


@pytest.mark.parametrize("function", [functools.partial(plain_with_more, "word"), Caller(), Caller().__call__])
@on_loop
async def test_a_partial_an_object_or_a_method_can_be_a_plain_rule(function: Any) -> None:
    talk = Talk()
    rule = talk.rule(function, name="calls")
    assert not rule.is_async
    async with rs.Context(talk.module) as context:
        assert (await talk.ask(context)).startswith("ravestate-")
        assert talk.failures == []


@on_loop
async def test_wiping_the_signal_of_a_plain_partial_does_not_end_its_run() -> None:
    """The engine knows that the rule is a plain function. Its thread cannot be stopped, so the run continues."""
    talk = Talk()
    begun, release = threading.Event(), threading.Event()

    def slow(word: str, ctx: rs.RuleContext) -> None:
        begun.set()
        release.wait(LIMIT)
        ctx[talk.said] = word

    talk.rule(functools.partial(slow, "done"), name="slow")
    async with rs.Context(talk.module) as context:
        answer = asyncio.create_task(context.next(talk.said.changed))
        context.put(talk.heard, "hello")
        await asyncio.to_thread(begun.wait)
        context.wipe(talk.heard.changed)
        await turns()
        release.set()
        assert await answer == "done"


@on_loop
async def test_a_plain_function_that_hangs_is_abandoned_and_its_later_acts_are_refused() -> None:
    talk = Talk()
    release = threading.Event()
    told: asyncio.Queue[BaseException] = asyncio.Queue()
    loop = asyncio.get_running_loop()

    def hang(ctx: rs.RuleContext) -> None:
        release.wait(LIMIT)
        for act in (
            lambda: ctx.__setitem__(talk.said, "too late"),
            lambda: ctx.emit(talk.word),
            lambda: ctx.wipe(talk.word),
        ):
            try:
                act()
            except rs.RunEnded as error:
                loop.call_soon_threadsafe(told.put_nowait, error)

    talk.rule(hang, emits=talk.word, timeout=0.1)  # long enough for a thread to begin
    async with rs.Context(talk.module) as context:
        assert await talk.ask(context) == "fallback"
        failure = only_failure(talk)
        assert isinstance(failure, rs.RuleTimeout)
        assert re.match(rf"rule m:hang took longer than its timeout of 0.1 s \({HERE}:\d+\)", str(failure))
        release.set()
        for _ in range(3):
            assert str(await told.get()) == "rule m:hang acted after its run was over (timeout)"
        assert context.read(talk.said) == "fallback"


@on_loop
async def test_an_interrupted_plain_function_is_abandoned() -> None:
    talk = Talk()
    release, begun = threading.Event(), asyncio.Event()
    loop = asyncio.get_running_loop()

    def hang(ctx: rs.RuleContext) -> None:
        loop.call_soon_threadsafe(begun.set)
        release.wait(LIMIT)

    talk.rule(hang, until=talk.stop)
    async with rs.Context(talk.module, trace=True) as context:
        context.put(talk.heard, "hello")
        await begun.wait()
        context.emit(talk.stop)
        await context.quiet()
        assert "interrupted" in str(context.explain("m:hang"))
    release.set()


@on_loop
async def test_the_context_ends_without_waiting_for_a_plain_function_that_hangs() -> None:
    talk = Talk()
    release, begun = threading.Event(), asyncio.Event()
    over: asyncio.Queue[str] = asyncio.Queue()
    loop = asyncio.get_running_loop()

    def hang(ctx: rs.RuleContext) -> None:
        loop.call_soon_threadsafe(begun.set)
        release.wait(LIMIT)
        try:
            ctx[talk.said] = "too late"
        except rs.RunEnded as error:
            loop.call_soon_threadsafe(over.put_nowait, str(error))

    talk.rule(hang)
    async with rs.Context(talk.module) as context:
        context.put(talk.heard, "hello")
        await begun.wait()
    release.set()
    assert await over.get() == "rule m:hang acted after its run was over (the context has ended)"


@on_loop
async def test_a_plain_function_that_wipes_an_unknown_signal_fails() -> None:
    talk = Talk()
    foreign = rs.Module("far").signal("far")

    def wipes(ctx: rs.RuleContext) -> None:
        ctx.wipe(foreign)

    talk.rule(wipes, writes=talk.note)
    async with rs.Context(talk.module) as context:
        await talk.ask(context)
        assert isinstance(only_failure(talk), rs.UndeclaredError)


# ---------------------------------------------------------------------------------------- rules that hang, or block


@on_loop
async def test_an_async_rule_that_hangs_is_cancelled_at_its_timeout() -> None:
    talk = Talk()
    told: list[str] = []

    async def hang(ctx: rs.RuleContext) -> None:
        try:
            await asyncio.get_running_loop().create_future()
        finally:
            told.append("clean")

    talk.rule(hang, timeout=0.001)
    async with rs.Context(talk.module) as context:
        assert await talk.ask(context) == "fallback"
        assert isinstance(only_failure(talk), rs.RuleTimeout)
        assert told == ["clean"]


def test_a_rule_that_refuses_to_end_is_abandoned_after_five_seconds() -> None:
    talk = Talk()
    told: list[str] = []

    async def stubborn(ctx: rs.RuleContext) -> None:
        while not told:
            try:
                await ctx.sleep(3600)
            except asyncio.CancelledError:
                try:
                    await ctx.sleep(3600)
                except asyncio.CancelledError:
                    told.append("second")
                    raise
            finally:
                if not told:
                    try:
                        ctx[talk.said] = "while cleaning up"
                    except rs.RunEnded as error:
                        told.append(str(error))

    talk.rule(stubborn, until=talk.stop)
    with Records() as log, simulate(talk.module) as sim:
        sim.put(talk.heard, "hello")
        sim.emit(talk.stop)
        sim.advance(GRACE - 0.1)
        assert log.messages == []
        sim.advance(0.2)
        assert re.match(
            rf"rule m:stubborn \({HERE}:\d+\) did not end within 5 s of being cancelled: let asyncio.CancelledError through",
            log.messages[0],
        )
        assert "m:stubborn" in sim.fired
        sim.advance(3600)
        assert told == ["rule m:stubborn acted after its run was over (it did not end in time)"]


# ---------------------------------------------------------------------------------------- load


@pytest.mark.parametrize("thread", [False, True])
@on_loop
async def test_a_payload_of_ten_megabytes_is_not_copied(thread: bool) -> None:
    talk = Talk()
    huge = "x" * 10_000_000
    seen: list[object] = []

    async def measure(ctx: rs.RuleContext) -> None:
        seen.append(ctx.payload(talk.heard.changed))
        ctx[talk.said] = str(len(ctx.payload(talk.heard.changed)))

    def plain(ctx: rs.RuleContext) -> None:
        seen.append(ctx.payload(talk.heard.changed))
        ctx[talk.said] = str(len(ctx.payload(talk.heard.changed)))

    talk.rule(plain if thread else measure, name="measure")
    with Records() as log:
        async with rs.Context(talk.module) as context:
            assert await talk.ask(context, huge) == "10000000"
            assert seen[0] is huge
            assert len(str(context.explain("m:measure"))) < 2000
            assert await talk.ask(context, "x") == "1"
    assert log.messages == []


@on_loop
async def test_a_rule_that_triggers_itself_does_not_starve_the_event_loop() -> None:
    """Input and timers are handled even if a detached rule triggers itself for ever."""
    m = rs.Module("m")
    tick, enough = m.signal("tick", keep="latest"), m.signal("enough")
    count = [0]

    @m.rule(when=tick, emits=tick, detached=True)
    async def tock(ctx: rs.RuleContext) -> None:
        count[0] += 1
        ctx.emit(tick)

    @m.rule(when=enough)
    async def end(ctx: rs.RuleContext) -> None:
        ctx.stop()

    async with rs.Context(m) as context:
        context.emit(tick)
        await turns(3)
        assert count[0] > 0
        context.emit(enough)
        await context.until_stopped()


@pytest.mark.parametrize("thread", [False, True])
@on_loop
async def test_two_detached_rules_that_trigger_each_other_delay_neither_input_nor_timers(
    thread: bool,
) -> None:
    m = rs.Module("m")
    ping, pong, ask = m.signal("ping"), m.signal("pong"), m.signal("ask", payload=int)
    answer, later = m.slot("answer", 0), m.signal("later")
    count, spinning = [0], asyncio.Event()

    @m.rule(when=ping, emits=pong, detached=True)
    async def hit(ctx: rs.RuleContext) -> None:
        count[0] += 1
        if count[0] == 1500:
            spinning.set()
        ctx.emit(pong)

    @m.rule(when=pong, emits=ping, detached=True)
    async def hit_back(ctx: rs.RuleContext) -> None:
        ctx.emit(ping)

    @m.rule(when=ask, writes=answer)
    async def reply(ctx: rs.RuleContext) -> None:
        ctx[answer] = ctx.payload(ask)

    @m.rule(when=ask.min_age(0.01).detached(), emits=later)
    async def reply_later(ctx: rs.RuleContext) -> None:
        ctx.emit(later)

    with Records() as log:
        async with rs.Context(m) as context:
            context.emit(ping)
            await spinning.wait()
            for number in range(1, 4):
                answers = asyncio.create_task(context.next(answer.changed))
                timers = asyncio.create_task(context.next(later))
                await turns(1)
                if thread:
                    await asyncio.to_thread(context.emit, ask, number)
                else:
                    context.emit(ask, number)
                assert await answers == number
                await timers
            await context.stop(grace=0)
    assert [message for message in log.messages if "an endless loop: m:hit, m:hit_back" in message] == log.messages
    assert len(log.messages) == 1


@on_loop
async def test_slow_rules_that_trigger_each_other_do_not_starve_the_event_loop() -> None:
    """The event loop gets a turn after a short time, even if only a few rules have run."""
    m = rs.Module("m")
    tick, count = m.signal("tick", keep="latest"), [0]

    @m.rule(when=tick, emits=tick, detached=True)
    async def slow(ctx: rs.RuleContext) -> None:
        count[0] += 1
        clock[0] += 0.01
        ctx.emit(tick)

    clock = [0.0]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runner_file, "perf_counter", lambda: clock[0])
        async with rs.Context(m) as context:
            context.emit(tick)
            await turns(2)
            assert 0 < count[0] <= 6
            await context.stop(grace=0)


@on_loop
async def test_a_fault_of_the_engine_ends_the_context_with_an_error(talk: Talk) -> None:
    async with rs.Context(talk.module) as context:
        await talk.ask(context)
        answer = asyncio.ensure_future(context.next(talk.said.changed))
        await turns(1)

        def fail(record: Record) -> None:
            if isinstance(record, Started):
                raise KeyError("a fault of our own")

        context.observe(fail)
        context.put(talk.heard, "hello")
        for waiting in (answer, context.until_stopped()):
            with pytest.raises(rs.RavestateError, match=r"the engine has failed.*a fault of our own"):
                await waiting
