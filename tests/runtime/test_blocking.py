"""A warning names each rule that blocks the event loop. Delays that a busy machine causes lead to no warning."""

import asyncio
import logging
import re
from dataclasses import dataclass
from types import SimpleNamespace

import pytest

import ravestate as rs
from ravestate.runtime import blocking
from ravestate.testing import simulate

HERE = re.escape(__file__)


@dataclass
class Machine:
    """A simulated machine: its clock, and the CPU seconds of the loop's thread (`computed`) and of other threads.

    The loop's thread gives the processor up `chosen` times by itself, and loses it `forced` times.
    """

    time: float = 0.0
    computed: float = 0.0
    others: float = 0.0
    chosen: int = 0
    forced: int = 0

    def usage(self, who: int) -> SimpleNamespace:
        return SimpleNamespace(ru_nvcsw=self.chosen, ru_nivcsw=self.forced)

    def compute(self, seconds: float) -> None:
        self.time += seconds
        self.computed += seconds

    def sleep(self, seconds: float) -> None:
        self.time += seconds
        self.chosen += 1

    def wait_for_a_processor(self, seconds: float) -> None:
        self.time += seconds
        self.forced += 1

    def wait_for_the_interpreter(self, seconds: float) -> None:
        self.time += seconds
        self.chosen += int(seconds / 0.005)

    def start_a_thread_while_a_library_loads(self, seconds: float) -> None:
        """Wait until the new thread gets the interpreter's lock, which the library holds while it computes."""
        self.sleep(seconds)
        self.others += seconds


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch) -> Machine:
    machine = Machine()
    monkeypatch.setattr(blocking, "perf_counter", lambda: machine.time)
    monkeypatch.setattr(blocking, "thread_time", lambda: machine.computed)
    monkeypatch.setattr(blocking, "process_time", lambda: machine.computed + machine.others)
    usage = SimpleNamespace(RUSAGE_THREAD=1, getrusage=machine.usage)
    monkeypatch.setattr(blocking, "resource", usage)
    return machine


IN_EITHER_STEP = pytest.mark.parametrize("first_step", [True, False])


def warnings_of(machine: Machine, caplog: pytest.LogCaptureFixture, first_step: bool, **did: float) -> list[str]:
    """Run a rule that calls these methods of `machine` in one step; return the logged warnings."""
    m = rs.Module("m")

    @m.rule(when=rs.startup)
    async def work(ctx: rs.RuleContext) -> None:
        if not first_step:
            await asyncio.sleep(0)
        for act, seconds in did.items():
            getattr(machine, act)(seconds)

    with caplog.at_level(logging.WARNING), simulate(m) as sim:
        assert sim.fired == ["m:work"]
    return [record.getMessage() for record in caplog.records]


@IN_EITHER_STEP
def test_a_warning_names_a_rule_that_computes_too_long(
    machine: Machine, caplog: pytest.LogCaptureFixture, first_step: bool
) -> None:
    (text,) = warnings_of(machine, caplog, first_step, compute=0.25)
    assert re.match(rf"rule m:work \({HERE}:\d+\) blocked the loop for 250 ms by computing: make it a plain", text)


@IN_EITHER_STEP
def test_a_warning_names_a_rule_that_sleeps_too_long(
    machine: Machine, caplog: pytest.LogCaptureFixture, first_step: bool
) -> None:
    (text,) = warnings_of(machine, caplog, first_step, compute=0.01, sleep=5.0)
    assert re.match(rf"rule m:work \({HERE}:\d+\) blocked the loop for 5000 ms by sleeping: make it a plain", text)


@IN_EITHER_STEP
@pytest.mark.parametrize(
    "wait", ["wait_for_a_processor", "wait_for_the_interpreter", "start_a_thread_while_a_library_loads"]
)
def test_a_busy_machine_causes_no_warning(
    machine: Machine, caplog: pytest.LogCaptureFixture, first_step: bool, wait: str
) -> None:
    assert warnings_of(machine, caplog, first_step, compute=0.05, **{wait: 5.0}) == []


def test_short_steps_that_follow_each_other_cause_no_warning(
    machine: Machine, caplog: pytest.LogCaptureFixture
) -> None:
    m = rs.Module("m")
    count = m.slot("count", 0)

    @m.rule(when=rs.startup | count.changed, writes=count, detached=True)
    async def work(ctx: rs.RuleContext) -> None:
        machine.compute(0.05)
        if ctx[count] < 10:
            ctx[count] += 1

    with simulate(m) as sim:
        assert sim.read(count) == 10
    assert not caplog.records
