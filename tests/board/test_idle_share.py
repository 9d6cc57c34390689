"""The idle share of a process. Time spent waiting for a processor that other programs use is not idle."""

from pathlib import Path

import pytest

from ravestate.board import recorder
from ravestate.board.recorder import IdleShare


class Clocks:
    """The real time, computing time and waiting time of a process (seconds). The test sets them."""

    passed = computed = kept = 0.0

    def __init__(self, schedule: Path) -> None:
        self.schedule = schedule
        self.advance(0.0, 0.0)

    def advance(self, passed: float, computed: float, kept: float = 0.0) -> None:
        self.passed += passed
        self.computed += computed
        self.kept += kept
        self.schedule.write_text(f"5000000000 {round(self.kept * 1e9)} 7\n")


@pytest.fixture
def clocks(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Clocks:
    clocks = Clocks(tmp_path / "schedstat")
    monkeypatch.setattr(recorder, "perf_counter", lambda: clocks.passed)
    monkeypatch.setattr(recorder, "process_time", lambda: clocks.computed)
    monkeypatch.setattr(recorder, "SCHEDULE", str(clocks.schedule))
    return clocks


def test_the_method_share_measures_the_idle_time_since_its_last_call(clocks: Clocks) -> None:
    spare = IdleShare()
    clocks.advance(2.0, computed=0.5)
    assert spare.share() == 0.75
    clocks.advance(1.0, computed=1.0)
    assert spare.share() == 0.0  # no idle time has passed after the last call


def test_time_spent_waiting_for_other_programs_is_not_idle(clocks: Clocks) -> None:
    spare = IdleShare()
    clocks.advance(3.0, computed=1.0, kept=2.0)
    assert spare.share() == 0.0
    clocks.advance(4.0, computed=1.0, kept=1.0)
    assert spare.share() == 0.5


def test_several_busy_threads_leave_no_idle_time(clocks: Clocks) -> None:
    spare = IdleShare()
    clocks.advance(1.0, computed=1.8)
    assert spare.share() == 0.0
    assert spare.share() == 0.0  # no time has passed


@pytest.mark.parametrize("told", ["", "5 x 7", None])
def test_without_a_readable_measurement_the_waiting_time_is_zero(clocks: Clocks, told: str | None) -> None:
    spare = IdleShare()
    clocks.advance(4.0, computed=1.0, kept=2.0)
    if told is None:
        clocks.schedule.unlink()
    else:
        clocks.schedule.write_text(told)
    assert spare.share() == 0.75
