"""A signal is a value that equals only itself."""

import ravestate as rs
from ravestate.declare.condition import Constraint
from ravestate.declare.signal import DEFAULT_LIMIT

demo = rs.Module("demo")


def test_a_signal_has_its_name_its_options_and_the_place_of_its_declaration() -> None:
    word = demo.signal("word", payload=str, input=True, keep="latest", limit=3)
    assert (word.name, word.payload, word.input, word.keep, word.limit) == (
        "demo:word",
        str,
        True,
        "latest",
        3,
    )
    assert word.origin.rsplit(":", 1)[0] == __file__
    plain = demo.signal("plain")
    assert (plain.payload, plain.input, plain.keep, plain.limit) == (None, False, "all", DEFAULT_LIMIT)


def test_two_signals_with_the_same_name_are_not_equal() -> None:
    one, other = rs.Module("twin").signal("s"), rs.Module("twin").signal("s")
    assert one != other and one == one
    assert len({one, other}) == 2


def test_a_signal_does_not_equal_its_name() -> None:
    """Otherwise, two signals with the same name would equal their name, but not each other."""
    assert rs.Module("twin").signal("s") != "twin:s"


def test_a_signal_can_be_used_as_a_constraint() -> None:
    signal = demo.signal("start")
    assert signal.min_age(1) == Constraint(signal, min_age_=1.0)
    assert signal.max_age(None) == Constraint(signal, max_age_=None)
    assert signal.detached() == Constraint(signal, is_detached=True)
    assert signal.where(bool) == Constraint(signal, predicates=(bool,))


def test_the_repr_of_a_signal_is_its_name() -> None:
    assert repr(demo.signal("shown")) == str(demo.signal("shown")) == "demo:shown"
