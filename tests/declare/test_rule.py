"""A rule acts like its function: calls, name, docstring and repr."""

import asyncio
import inspect

import ravestate as rs

demo = rs.Module("demo")
go = demo.signal("go")


@demo.rule(when=go)
def double(ctx: int) -> int:
    """Return twice the argument."""
    return 2 * ctx


@demo.rule(when=go)
async def triple(ctx: int) -> int:
    return 3 * ctx


def test_calling_a_rule_calls_its_function() -> None:
    assert double(4) == 8
    assert asyncio.run(triple(4)) == 12


def test_a_rule_has_the_name_the_docstring_and_the_signature_of_its_function() -> None:
    assert inspect.unwrap(double) is double.function
    assert inspect.getdoc(double) == "Return twice the argument."
    assert list(inspect.signature(double).parameters) == ["ctx"]


def test_the_repr_of_a_rule_is_its_name() -> None:
    assert repr(double) == "<rule demo:double>"


def test_the_options_of_a_rule_have_the_defaults_from_the_laws() -> None:
    assert (double.weight, double.cooldown, double.patience, double.timeout) == (1.0, 0.0, None, None)
    assert (double.until, double.detached, double.background) == (None, False, False)
    assert (double.reads, double.writes, double.emits) == ((), (), ())
