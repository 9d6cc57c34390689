"""Random worlds: whatever the policy and whatever happens, the laws hold (L10, L15, L16, L18, L23)."""

from __future__ import annotations

from hypothesis import given

from properties.oracle import Exclusion, bounded, empty
from properties.strategies import worlds
from properties.worlds import Play, World


@given(worlds(adds=True))
def test_who_excludes_each_other_never_both_finish_for_one_cause(world: World) -> None:
    """And nobody runs too early, twice on the same spikes, or before somebody who is ready and worth more."""
    Play(world, started=Exclusion()).play()


@given(worlds(adds=True))
def test_whoever_waits_has_a_reason_and_an_end(world: World) -> None:
    """A taken slot or a viable rival; and a rival that only patience bounds ends within it."""
    play = Play(world, before=bounded).play()
    bounded(play)


@given(worlds(ageless=False))
def test_with_time_nothing_is_left(world: World) -> None:
    play = Play(world).play()
    play.settle(1000.0)
    empty(play)


@given(worlds())
def test_when_all_is_wiped_nothing_is_left(world: World) -> None:
    """Also of what would have been held for ever."""
    play = Play(world).play()
    for _ in range(
        50
    ):  # the end of activity is an input to others, and so is what a run does when it is cancelled
        play.wipe_all()
        play.settle(1000.0)
        if not play.engine.active and not play.engine.live:
            break
    empty(play)
