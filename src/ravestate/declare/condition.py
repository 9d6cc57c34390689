"""Conditions: boolean combinations of constraints on signals and of predicates on slots (laws L3, L4).

A condition is a value. ``&`` and ``|`` build trees; ``policy/clauses.py`` brings these trees into disjunctive
normal form.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NoReturn, cast

from ravestate.declare.settings import Number, SettingRef, type_of_number
from ravestate.declare.wording import place_of_call, spelt
from ravestate.errors import DeclarationError

if TYPE_CHECKING:
    from ravestate.declare.signal import Signal
    from ravestate.declare.slot import Slot

DEFAULT_MAX_AGE = 5.0  # the default `max_age` of a constraint, in seconds (L4)
Predicate = Callable[[Any], object]  # a function of a payload or of a slot's value

LATER = inspect.CO_GENERATOR | inspect.CO_COROUTINE | inspect.CO_ASYNC_GENERATOR
"""Flags of a code object. Calling code with one of these flags only makes a generator or a coroutine."""


class Condition:
    """The trigger of a rule. Combine conditions with ``&`` (and) and ``|`` (or); ``&`` binds tighter.

    Example:
        >>> import ravestate as rs
        >>> demo = rs.Module("demo")
        >>> heard, seen, bored = demo.signal("heard"), demo.signal("seen"), demo.signal("bored")
        >>> heard & seen.max_age(1) | bored.min_age(2)
        demo:heard & demo:seen.max_age(1.0) | demo:bored.min_age(2.0)
    """

    __slots__ = ()

    def __and__(self, other: Condition) -> Condition:
        return AllOf((*_parts(self, AllOf), *_parts(_checked(self, other, "&"), AllOf)))

    def __or__(self, other: Condition) -> Condition:
        return AnyOf((*_parts(self, AnyOf), *_parts(_checked(self, other, "|"), AnyOf)))

    def __bool__(self) -> NoReturn:
        raise DeclarationError(
            f"condition {self} ({place_of_call()}) has no truth value: write & instead of 'and', | instead of 'or', and "
            ".where(predicate) instead of a comparison; & binds tighter than |"
        )


@dataclass(frozen=True, slots=True, repr=False)
class Constraint(Condition):
    """A signal with limits on the age of its spikes (seconds), and with predicates on their payload."""

    signal: Signal[Any]
    min_age_: Number = 0.0
    max_age_: Number | None = DEFAULT_MAX_AGE
    is_detached: bool = False
    predicates: tuple[Predicate, ...] = ()

    def min_age(self, seconds: Number) -> Constraint:
        """Let the rule start only when the spike is at least `seconds` old; `seconds` is a number or a setting."""
        return replace(self, min_age_=_age(seconds, "min_age"))

    def max_age(self, seconds: Number | None) -> Constraint:
        """Give up a spike when its age reaches `seconds`. With ``None``, there is no limit. The default is 5 s.

        A rule that is ready, but still waits to run, keeps its spikes, whatever their age (L14).
        """
        return replace(self, max_age_=None if seconds is None else _age(seconds, "max_age"))

    def detached(self) -> Constraint:
        """Let the rule look at the spike without consuming it.

        The rule does not wait for other rules because of this spike, and does not join the spike's causal group (L19).
        """
        return replace(self, is_detached=True)

    def where(self, predicate: Predicate) -> Constraint:
        """Accept a spike only if ``predicate(payload)`` is true. The predicate adds ln 2 to the utility (L9).

        Args:
            predicate: A plain, fast function. The event loop calls it for each spike that might trigger the rule. If
                the function raises an exception, the predicate counts as false. Its first exception also raises
                ``rs.error``.

        Raises:
            DeclarationError: The predicate is not callable, or it is asynchronous or a generator.

        Example:
            >>> import ravestate as rs
            >>> rs.Module("demo").signal("word", payload=str).where(str.isupper)
            demo:word.where(isupper)
        """
        return replace(self, predicates=(*self.predicates, checked_predicate(predicate, f"{self}.where", "payload")))

    def __repr__(self) -> str:
        text = self.signal.name
        if self.min_age_ != 0.0:
            text += f".min_age({self.min_age_})"
        if self.max_age_ != DEFAULT_MAX_AGE:
            text += f".max_age({self.max_age_})"
        if self.is_detached:
            text += ".detached()"
        return text + "".join(f".where({_title(p)})" for p in self.predicates)


@dataclass(frozen=True, slots=True, repr=False)
class Holds(Condition):
    """A predicate on a slot's current value. The rule starts only while the predicate is true (L4)."""

    slot: Slot[Any]
    predicate: Predicate

    def __repr__(self) -> str:
        return f"{self.slot.name}.holds({_title(self.predicate)})"


@dataclass(frozen=True, slots=True, repr=False)
class Compound(Condition):
    """Several conditions, combined by "and" or by "or"."""

    parts: tuple[Condition, ...]

    def __repr__(self) -> str:
        return _written(self)


class AllOf(Compound):
    """A conjunction."""


class AnyOf(Compound):
    """A disjunction."""


def checked_predicate(predicate: object, what: str, of: str) -> Predicate:
    """Return `predicate` if it is callable, and neither asynchronous nor a generator; refuse any other value.

    Calling an asynchronous function or a generator only creates an object, and that object always counts as true. The
    message uses `what`, the method that got the predicate, and `of`, the predicate's argument: ``payload`` or
    ``value``.
    """
    if not callable(predicate):
        raise DeclarationError(f"{what}({predicate!r}): expected a function of the {of}")
    function: Any = predicate
    while not hasattr(function, "__code__") and hasattr(function, "func"):
        function = function.func  # functools.partial
    if not hasattr(function, "__code__"):
        function = cast("Any", type(function)).__call__
    code = getattr(function, "__code__", None)
    if code is not None and code.co_flags & LATER:
        raise DeclarationError(
            f"{what}({_title(predicate)}) ({place_of_call()}): the result of an asynchronous function or a generator is "
            f"always true: write a plain function of the {of}, and do slow work in a rule that emits a signal"
        )
    return predicate


def _parts(condition: Condition, kind: type[AllOf] | type[AnyOf]) -> tuple[Condition, ...]:
    return condition.parts if isinstance(condition, kind) else (condition,)


def _checked(condition: Condition, other: object, operator: str) -> Condition:
    if not isinstance(other, Condition):
        hint = ""
        if hasattr(other, "changed"):
            home = str(condition).lstrip("(").partition(":")[0]
            hint = f"; a slot is not a signal: write {operator} {spelt(getattr(other, 'name', 'slot'), home)}.changed"
        raise DeclarationError(
            f"cannot combine condition {condition} with {other!r} by {operator} ({place_of_call()}){hint}"
        )
    return other


def _age(seconds: object, what: str) -> Number:
    if isinstance(seconds, bool) or not isinstance(seconds, type_of_number):
        raise DeclarationError(
            f"{what}({seconds!r}): expected seconds as a number, or a setting: {what}(rs.setting('name'))"
        )
    return seconds if isinstance(seconds, SettingRef) else float(seconds)


def _written(condition: Condition) -> str:
    """Return a condition of any depth as Python code."""
    words: list[str] = []
    stack: list[Condition | str] = [condition]
    while stack:
        item = stack.pop()
        if not isinstance(item, Compound):
            words.append(str(item))
            continue
        inner: list[Condition | str] = []
        for part in item.parts:
            bracketed = isinstance(item, AllOf) and isinstance(part, AnyOf)
            inner.append(" & " if isinstance(item, AllOf) else " | ")
            inner.extend(("(", part, ")") if bracketed else (part,))
        stack.extend(reversed(inner[1:]))
    return "".join(words)


def _title(predicate: Predicate) -> str:
    return getattr(predicate, "__name__", type(predicate).__name__)
