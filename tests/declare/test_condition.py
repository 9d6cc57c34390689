"""Conditions are built with operators and methods. Python code that would silently mean something else is refused."""

import functools
import re
from collections.abc import AsyncIterator, Iterator

import pytest

import ravestate as rs
from ravestate.declare.condition import AllOf, AnyOf, Holds

HERE = re.escape(__file__)

demo = rs.Module("demo")
a, b, c = (demo.signal(name) for name in "abc")
mood = demo.slot("mood", "calm")


def cheerful(value: object) -> bool:
    return value == "cheerful"


def test_the_operators_for_and_and_or_build_flat_trees_in_order() -> None:
    assert a & b & c == AllOf((a, b, c))
    assert a & (b & c) == AllOf((a, b, c))
    assert a | b | c == AnyOf((a, b, c))
    assert a & b | c == AnyOf((AllOf((a, b)), c))
    assert a & (b | c) == AllOf((a, AnyOf((b, c))))


@pytest.mark.parametrize(
    ("condition", "text"),
    [
        (a, "demo:a"),
        (a & b | c, "demo:a & demo:b | demo:c"),
        (a & (b | c), "demo:a & (demo:b | demo:c)"),
        (a.min_age(2), "demo:a.min_age(2.0)"),
        (a.min_age(0).max_age(5), "demo:a"),
        (a.max_age(None).detached(), "demo:a.max_age(None).detached()"),
        (a.max_age(rs.setting("late")), "demo:a.max_age(setting('late'))"),
        (a.where(cheerful), "demo:a.where(cheerful)"),
        (a & mood.holds(cheerful), "demo:a & demo:mood.holds(cheerful)"),
    ],
)
def test_the_repr_of_a_condition_is_its_code(condition: rs.Condition, text: str) -> None:
    assert repr(condition) == text


def test_each_method_of_a_constraint_makes_a_new_constraint_and_leaves_the_old_one() -> None:
    young = a.min_age(1)
    old = young.min_age(3).max_age(None).detached()
    assert (young.min_age_, young.max_age_, young.is_detached) == (1.0, 5.0, False)
    assert (old.min_age_, old.max_age_, old.is_detached) == (3.0, None, True)
    twice = a.where(cheerful).where(bool)
    assert twice.predicates == (cheerful, bool)


def test_a_slot_predicate_can_be_part_of_a_condition() -> None:
    holds = mood.holds(cheerful)
    assert isinstance(holds, Holds) and holds.slot is mood
    assert (a & holds).parts == (a, holds)


def test_the_python_operators_and_or_not_and_comparisons_are_refused() -> None:
    with pytest.raises(
        rs.DeclarationError,
        match=rf"condition demo:a \({HERE}:\d+\) .* write & instead of 'and', \| instead of 'or'",
    ):
        _ = a and b
    with pytest.raises(rs.DeclarationError, match="has no truth value"):
        _ = a or b
    with pytest.raises(rs.DeclarationError, match="has no truth value"):
        _ = not (a & b)
    with pytest.raises(rs.DeclarationError, match=r"and \.where\(predicate\) instead of a comparison"):
        _ = 1 if a.where(cheerful) else 2


@pytest.mark.parametrize("other", [True, None, "demo:b", 3, cheerful])
def test_only_conditions_can_be_combined(other: object) -> None:
    with pytest.raises(rs.DeclarationError, match=rf"cannot combine condition demo:a with .* by & \({HERE}:\d+\)"):
        _ = a & other
    with pytest.raises(rs.DeclarationError, match=rf"cannot combine condition demo:a with .* by \| \({HERE}:\d+\)"):
        _ = a | other


def test_the_message_about_a_slot_combined_with_a_condition_names_its_signal() -> None:
    with pytest.raises(rs.DeclarationError, match=r"a slot is not a signal: write & mood\.changed"):
        _ = a & mood
    with pytest.raises(rs.DeclarationError, match=r"a slot is not a signal: write \| mood\.changed"):
        _ = a | mood
    with pytest.raises(rs.DeclarationError, match=r"write & rawio\.input\.changed"):
        _ = a & rs.Module("rawio").slot("input")


@pytest.mark.parametrize("age", ["2", None, True, object()])
def test_an_age_that_is_neither_a_number_nor_a_setting_is_refused(age: object) -> None:
    with pytest.raises(rs.DeclarationError, match=r"min_age\(.*\): expected seconds as a number, or a setting"):
        a.min_age(age)
    if age is not None:
        with pytest.raises(rs.DeclarationError, match=r"write|max_age\(rs\.setting\('name'\)\)"):
            a.max_age(age)


def test_a_predicate_that_is_not_a_function_is_refused() -> None:
    with pytest.raises(rs.DeclarationError, match=r"demo:a\.where\('yes'\): expected a function of the payload"):
        a.where("yes")
    with pytest.raises(rs.DeclarationError, match=r"demo:mood\.holds\('calm'\): expected a function of the value"):
        mood.holds("calm")


class Asks:
    """An object that is itself a predicate, and whose methods can be predicates."""

    def __init__(self, word: str) -> None:
        self.word = word

    def __call__(self, value: str) -> bool:
        return value == self.word

    async def later(self, value: str) -> bool:
        return value == self.word


class AsksLater:
    async def __call__(self, value: str) -> bool:
        return True


async def coroutine(value: object) -> bool:
    return False


def generator(value: object) -> Iterator[bool]:
    yield False


async def both(value: object) -> AsyncIterator[bool]:
    yield False


@pytest.mark.parametrize(
    "predicate",
    [
        coroutine,
        generator,
        both,
        Asks("x").later,
        AsksLater(),
        functools.partial(coroutine),
        functools.partial(functools.partial(AsksLater())),
    ],
)
def test_a_coroutine_function_or_a_generator_function_is_refused_as_a_predicate(predicate: object) -> None:
    """Such a function returns an object, and any object is true."""
    with pytest.raises(
        rs.DeclarationError,
        match=rf"demo:a\.where\(.*\) \({HERE}:\d+\): .* always true: write a plain function of the payload",
    ):
        a.where(predicate)
    with pytest.raises(
        rs.DeclarationError, match=rf"demo:mood\.holds\(.*\) \({HERE}:\d+\): .* plain function of the value"
    ):
        mood.holds(predicate)


@pytest.mark.parametrize(
    "predicate",
    [cheerful, bool, str.isupper, Asks("x"), Asks("x").__call__, functools.partial(cheerful), re.Pattern],
)
def test_every_plain_callable_can_be_a_predicate(predicate: object) -> None:
    assert a.where(predicate).predicates == (predicate,)
    assert mood.holds(predicate).predicate == predicate


def test_a_condition_of_any_depth_can_be_printed() -> None:
    condition: rs.Condition = a
    for _ in range(3000):
        condition = AllOf((b, AnyOf((condition, c))))
    assert repr(condition).startswith("demo:b & (demo:b & (demo:b & (")
    assert repr(condition).endswith("| demo:c) | demo:c) | demo:c)")
