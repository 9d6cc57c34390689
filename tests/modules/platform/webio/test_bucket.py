"""The token bucket first allows a burst of events, and then a fixed rate."""

from hypothesis import given
from hypothesis import strategies as st

from ravestate.modules.platform.webio.channel import Bucket


@given(st.lists(st.floats(0, 10), min_size=1, max_size=60))
def test_burst_and_rate_bound_the_number_of_events_in_any_period(gaps: list[float]) -> None:
    bucket = Bucket(burst=5, rate=2.0, now=0.0)
    now, through = 0.0, []
    for gap in gaps:
        now += gap
        now += bucket.wait(now)  # each event waits before the next event is counted
        through.append(now)
    for n, begin in enumerate(through):
        for count, end in enumerate(through[n:], start=1):
            assert count <= 5 + 2.0 * (end - begin) + 1e-6


def test_a_sender_within_the_limits_never_waits() -> None:
    bucket = Bucket(burst=3, rate=1.0, now=0.0)
    assert [bucket.wait(t) for t in (0.0, 0.0, 0.0, 1.0, 2.0, 3.0)] == [0.0] * 6


def test_a_refused_event_uses_up_no_tokens() -> None:
    bucket = Bucket(burst=2, rate=1.0, now=0.0)
    assert [bucket.take(0.0) for _ in range(100)] == [True, True] + 98 * [False]
    assert [bucket.take(t) for t in (0.5, 1.0, 1.5, 2.0)] == [False, True, False, True]
