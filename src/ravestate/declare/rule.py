"""A rule: an annotated function with a condition (law L3)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass, field
from functools import partial
from inspect import iscoroutinefunction
from typing import Any, Generic, ParamSpec, TypeVar, cast

from ravestate.declare.condition import Condition
from ravestate.declare.settings import Number
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Slot

P = ParamSpec("P")
R = TypeVar("R")


@dataclass(eq=False, repr=False)
class Rule(Generic[P, R]):
    """A function with its declaration, made by ``@module.rule(...)``. Calling the rule calls the function.

    Attributes:
        name: The qualified name, ``module:name``; by default, the function's name comes after the colon.
        function: The function that runs when the rule fires.
        is_async: Whether the function is a coroutine function. Coroutine functions run on the loop, plain functions in
            a worker thread.
        origin: The place of the declaration, ``file:line``.

    The other attributes are the arguments of `Module.rule`.
    """

    name: str
    function: Callable[P, R]
    _: KW_ONLY
    when: Condition
    reads: tuple[Slot[Any], ...]
    writes: tuple[Slot[Any], ...]
    emits: tuple[Signal[Any], ...]
    weight: Number
    cooldown: Number
    patience: Number | None
    until: Condition | None
    timeout: Number | None
    detached: bool
    background: bool
    origin: str
    is_async: bool = field(init=False)

    def __post_init__(self) -> None:
        self.is_async = _is_async(self.function)
        self.__doc__ = self.function.__doc__
        self.__wrapped__ = self.function

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        return self.function(*args, **kwargs)

    def __repr__(self) -> str:
        return f"<rule {self.name}>"


def _is_async(function: object) -> bool:
    while isinstance(function, partial):
        function = cast("partial[Any]", function).func
    call = getattr(type(function), "__call__", None)  # noqa: B004  # a callable object's own or inherited method
    return iscoroutinefunction(function) or iscoroutinefunction(call)
