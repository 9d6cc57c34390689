"""A rule: an annotated function with a condition (L3)."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from inspect import iscoroutinefunction
from typing import Any, Generic, ParamSpec, TypeVar, cast

from ravestate.declare.condition import Condition
from ravestate.declare.settings import Number
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Slot

__all__ = ["Rule"]

P = ParamSpec("P")
R = TypeVar("R")


class Rule(Generic[P, R]):
    """What ``@module.rule(...)`` makes of a function. Calling it calls the function.

    Attributes:
        name: The qualified name, ``module:function``.
        function: The function.
        is_async: Whether the function is a coroutine function. It runs on the loop, a plain one in a worker thread.
        when: The condition.
        reads: The slots whose values the function may read.
        writes: The slots that the function may write (and read); they decide whom it excludes (L10).
        emits: The signals that the function may emit.
        weight: Factor on the utility (L9), above 0.
        cooldown: Seconds over which the utility recovers from 0 after a run (L9).
        patience: Seconds that the rule, when others wait for it, has to become ready (L16); ``None``: the context's.
        until: A condition that interrupts a run (L21).
        timeout: Seconds that a run may take (L18); ``None``: any.
        detached: Whether what the rule causes begins new causal groups (L19).
        background: Whether the rule leaves ``rs.activity`` alone (L22).
        origin: Where it was declared, ``file:line``.
    """

    __slots__ = (
        "__dict__",  # for functools.wraps
        "background",
        "cooldown",
        "detached",
        "emits",
        "function",
        "is_async",
        "name",
        "origin",
        "patience",
        "reads",
        "timeout",
        "until",
        "weight",
        "when",
        "writes",
    )

    def __init__(
        self,
        name: str,
        function: Callable[P, R],
        *,
        when: Condition,
        reads: tuple[Slot[Any], ...],
        writes: tuple[Slot[Any], ...],
        emits: tuple[Signal[Any], ...],
        weight: Number,
        cooldown: Number,
        patience: Number | None,
        until: Condition | None,
        timeout: Number | None,
        detached: bool,
        background: bool,
        origin: str,
    ) -> None:
        self.name = name
        self.function = function
        self.is_async = _is_async(function)
        self.when = when
        self.reads = reads
        self.writes = writes
        self.emits = emits
        self.weight = weight
        self.cooldown = cooldown
        self.patience = patience
        self.until = until
        self.timeout = timeout
        self.detached = detached
        self.background = background
        self.origin = origin
        self.__doc__ = function.__doc__
        self.__wrapped__ = function

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        return self.function(*args, **kwargs)

    def __repr__(self) -> str:
        return f"<rule {self.name}>"


def _is_async(function: object) -> bool:
    while isinstance(function, partial):
        function = cast("partial[Any]", function).func
    call = getattr(type(function), "__call__", None)  # noqa: B004  # an object's own or inherited call
    return iscoroutinefunction(function) or iscoroutinefunction(call)
