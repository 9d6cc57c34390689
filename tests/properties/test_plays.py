"""Random worlds: the laws hold for any policy and any inputs (laws L10, L15, L16, L18, L23)."""

from __future__ import annotations

from hypothesis import given

from properties.oracle import Exclusion, bounded, empty
from properties.strategies import worlds
from properties.worlds import Play, World


@given(worlds(adds=True))
def test_rules_that_exclude_each_other_never_both_fire_for_one_cause(world: World) -> None:
    """Also, no rule runs too early, twice on the same spikes, or before a ready rule of greater utility."""
    Play(world, started=Exclusion()).play()


@given(worlds(adds=True))
def test_every_wait_has_a_reason_and_ends(world: World) -> None:
    """The reason is a taken slot or a viable rival. If only patience bounds the wait, it ends within the patience."""
    play = Play(world, before=bounded).play()
    bounded(play)


@given(worlds(ageless=False))
def test_after_enough_time_no_engine_object_is_left(world: World) -> None:
    play = Play(world).play()
    play.settle(1000.0)
    empty(play)


@given(worlds())
def test_after_all_signals_are_wiped_no_engine_object_is_left(world: World) -> None:
    """Even a spike that never grows too old (``max_age=None``) is gone."""
    play = Play(world).play()
    for _ in range(50):  # the end of activity and the clean-up of a cancelled run can raise signals again
        play.wipe_all()
        play.settle(1000.0)
        if not play.engine.state.active and not play.engine.state.live:
            break
    empty(play)
