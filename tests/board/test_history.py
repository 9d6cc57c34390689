"""`History`, an index of the records of one causal group in a trace."""

import pytest

from ravestate.board.history import History
from ravestate.engine.trace import Born, GaveUp, Held, Merged, Record, Set, Settled, Started


def born(spike: int, signal: str, group: int = 1, source: int = 0, time: float = 0.0) -> Born:
    return Born(time, spike, signal, group, (), source, None)


def run(number: int, rule: str, spikes: tuple[int, ...], begin: float, end: float | None) -> list[Record]:
    """Return the records of a run from `begin` to `end` (seconds); without `end`, the run is not over yet."""
    ended = [] if end is None else [Settled(end, number, rule, "done", "", True)]
    return [Started(begin, number, rule, 0, spikes), *ended]


def test_groups_that_merge_in_many_steps_become_one_group() -> None:
    merges = [Merged(1.0, group, group - 1) for group in range(2, 3000)]
    history = History([born(n, "m:s", group=n) for n in range(1, 3000)] + [*reversed(merges)], 2999)
    assert history.root(2999) == 1
    assert len(history.group) == 2999


def test_a_file_that_merges_groups_in_a_circle_can_still_be_read() -> None:
    records: list[Record] = [born(1, "m:s", 1), born(2, "m:s", 2), Merged(1.0, 2, 1), Merged(1.0, 1, 2)]
    assert History(records, 1).group == {1, 2}


@pytest.mark.parametrize(
    ("time", "runs"),
    [(0.5, False), (1.0, True), (2.5, True), (5.0, True), (5.5, False), (7.0, True), (9.0, True)],
)
def test_the_method_ran_returns_true_between_the_start_and_the_end_of_a_run(time: float, runs: bool) -> None:
    records = [
        born(1, "m:s"),
        born(2, "m:s", group=2),
        *run(1, "m:r", (1,), 1.0, 5.0),
        *run(2, "m:r", (1,), 2.0, 2.2),  # a second run, at the same time
        *run(3, "m:r", (2,), 5.2, 6.0),  # the rule runs for another cause
        *run(4, "m:r", (1,), 7.0, None),
    ]
    assert History(records, 1).ran("m:r", time) is runs
    assert not History(records, 1).ran("m:other", time)


def test_the_method_before_names_the_rule_of_this_group_that_raised_a_spike_of_the_run() -> None:
    records = [
        born(1, "m:boot", group=2),
        *run(1, "m:warm_up", (1,), 0.0, 0.0),
        born(2, "m:ready", group=2, source=1),
        born(3, "m:said"),
        *run(2, "m:classify", (3,), 1.0, 1.0),
        born(4, "m:question", source=2),
        *run(3, "m:answer", (2, 4), 1.0, 2.0),
        *run(4, "m:greet", (2, 3), 1.0, 2.0),
    ]
    history = History(records, 3)
    assert [history.before(number) for number in (3, 4, 2)] == ["m:classify", "", ""]
    assert [history.before(number) for number in (0, 99)] == ["", ""]  # no run has these numbers


def test_the_method_answered_returns_the_run_that_ended_first_for_this_cause() -> None:
    records = [
        born(1, "m:s"),
        born(2, "m:s", group=2),
        *run(1, "m:slow", (1,), 1.0, None),
        *run(2, "m:quick", (2,), 1.0, 1.5),
        *run(3, "m:quick", (1,), 1.0, 2.0),
        Settled(3.0, 1, "m:slow", "done", "", True),
    ]
    history = History(records, 1)
    hears = {"m:slow": [{"m:s"}], "m:quick": [{"m:s"}]}
    first = history.answered(hears)
    assert first is not None
    assert (first.id, first.end) == (3, 2.0)
    last = history.answered({**hears, "m:quick": [{"m:t"}]})  # m:quick does not consume m:s
    assert last is not None
    assert last.id == 1
    assert history.answered({"m:other": [{"m:s"}]}) is None


def test_the_method_value_returns_the_last_write_to_a_slot_up_to_a_time() -> None:
    history = History([born(1, "m:s"), *(Set(time, "m:x", time, 0) for time in (1.0, 2.0, 2.5))], 1)
    found = [history.value("m:x", time) for time in (0.5, 1.0, 2.2, 9.0)]
    assert [None if write is None else write.value for write in found] == [None, 1.0, 2.0, 2.5]
    assert history.value("m:y", 9.0) is None


def test_the_attribute_lacks_of_an_attempt_stays_when_the_attempt_loses_all_its_spikes_together() -> None:
    held = [Held(0.0, 7, "m:r", 0, 1, "m:s", ("m:t", "m:u")), Held(1.0, 7, "m:r", 0, 2, "m:t", ("m:u",))]
    lost = [GaveUp(2.0, 7, "m:r", spike, signal, "age") for spike, signal in ((1, "m:s"), (2, "m:t"))]
    history = History([born(1, "m:s"), born(2, "m:t"), *held, *lost], 1)
    (attempt,) = history.of("m:r")
    assert (attempt.lacks, attempt.end, attempt.over) == (("m:u",), 2.0, True)


def test_a_run_with_an_end_record_but_no_start_record_has_ended() -> None:
    records = [born(1, "m:s"), Held(0.0, 7, "m:r", 0, 1, "m:s", ()), Settled(2.0, 7, "m:r", "done", "", True)]
    (attempt,) = History(records, 1).of("m:r")
    assert (attempt.over, attempt.end) == (True, 2.0)
