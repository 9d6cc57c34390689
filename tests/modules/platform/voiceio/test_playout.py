"""The play-out clock counts the time in which sound was played, without the pauses."""

from hypothesis import given
from hypothesis import strategies as st

from ravestate.modules.platform.voiceio.playout import SECOND, PlayOut


def test_queued_sounds_are_counted_one_after_another() -> None:
    out = PlayOut()
    out.play(bytes(SECOND), 1.0)
    out.play(bytes(SECOND), 1.0)
    assert (out.played(0.5), out.played(1.5), out.played(2.5), out.played(9.0)) == (0.0, 0.5, 1.5, 2.0)
    out.play(bytes(SECOND), 5.0)
    assert out.played(5.5) == 2.5


def test_the_method_stop_drops_the_remaining_sound_and_keeps_the_count() -> None:
    out = PlayOut()
    out.play(bytes(2 * SECOND), 0.0)
    out.stop(0.5)
    assert out.played(3.0) == 0.5
    out.play(bytes(SECOND), 3.0)
    assert out.played(3.25) == 0.75
    assert [(begin, len(sound)) for begin, sound in out.parts()] == [(0.0, SECOND // 2), (3.0, SECOND)]


@given(st.lists(st.tuples(st.sampled_from(["play", "stop"]), st.floats(0, 0.5)), max_size=20))
def test_the_count_never_decreases(steps: list[tuple[str, float]]) -> None:
    out, now, before = PlayOut(), 0.0, 0.0
    for what, wait in steps:
        now += wait
        if what == "play":
            out.play(bytes(SECOND // 4 * 2), now)
        else:
            out.stop(now)
        assert out.played(now) >= before - 1e-4
        before = out.played(now)
