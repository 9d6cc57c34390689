"""A module: a value that holds what a designer declares (L1-L3). No registry, no side effects."""

from __future__ import annotations

import sys
from collections.abc import Callable, Coroutine, Iterable
from types import CodeType, ModuleType
from typing import Any, ParamSpec, TypeVar, cast, overload

from ravestate.declare.condition import Condition
from ravestate.declare.rule import Rule
from ravestate.declare.settings import Number, SettingRef, type_of_number
from ravestate.declare.signal import DEFAULT_LIMIT, Keep, Signal
from ravestate.declare.slot import Collection, Flag, Slot
from ravestate.declare.wording import spelt
from ravestate.errors import DeclarationError

__all__ = ["Module", "as_module"]

T = TypeVar("T")
P = ParamSpec("P")
R = TypeVar("R")

ANY_SLOT: type[Slot[Any]] = Slot
ANY_SIGNAL: type[Signal[Any]] = Signal
GENERATOR_FLAGS = 0x20 | 0x200  # inspect.CO_GENERATOR | CO_ASYNC_GENERATOR, without importing inspect


class Module:
    """A named collection of signals, slots and rules.

    Args:
        name: Letters, digits, ``_`` and ``-``; the first part of all its qualified names.
        requires: Modules whose signals and slots this one uses: `Module` values, or Python modules that
            hold one (``from ravestate.modules import rawio``).
        settings: A subclass of ``rs.Settings``: what a user may configure.
        serve: For platforms that talk with many users at once: an async function that ``rs.run`` calls with the
            `Agent`, instead of running one context. It makes a context for each user, and ends when it is cancelled.

    Example:
        >>> import ravestate as rs
        >>> lamp = rs.Module("lamp")
        >>> lit = lamp.flag("lit")
        >>> @lamp.rule(when=rs.startup, writes=lit)
        ... async def switch_on(ctx):
        ...     ctx[lit] = True
        >>> switch_on.name
        'lamp:switch_on'
    """

    __slots__ = ("name", "origin", "requires", "rules", "serve", "settings", "signals", "slots")

    def __init__(
        self,
        name: str,
        *,
        requires: Iterable[Module | ModuleType] = (),
        settings: type[Any] | None = None,
        serve: Callable[[Any], Coroutine[Any, Any, None]] | None = None,
    ) -> None:
        _check_name(name, "Module")
        self.name = name
        self.origin = _caller()
        if isinstance(requires, (Module, ModuleType, str)):
            requires = (requires,)  # type: ignore[assignment]  # a text is refused below, whole
        self.requires: list[Module] = []
        for required in requires:
            try:
                self.requires.append(as_module(required))
            except DeclarationError as fault:
                raise DeclarationError(f"module {name} ({self.origin}): requires: {fault}") from None
        self.settings = settings
        self.serve = serve
        self.signals: list[Signal[Any]] = []
        self.slots: list[Slot[Any]] = []
        self.rules: list[Rule[Any, Any]] = []
        if settings is not None and not (
            isinstance(cast("object", settings), type) and hasattr(settings, "model_fields")
        ):
            raise DeclarationError(
                f"module {name} ({self.origin}): settings={settings!r} must be a class derived from rs.Settings: write "
                "class Settings(rs.Settings): ..."
            )

    @overload
    def signal(self, name: str, *, input: bool = ..., keep: Keep = ..., limit: int = ...) -> Signal[None]: ...
    @overload
    def signal(
        self, name: str, payload: type[T], *, input: bool = ..., keep: Keep = ..., limit: int = ...
    ) -> Signal[T]: ...
    def signal(
        self,
        name: str,
        payload: Any = None,
        *,
        input: bool = False,
        keep: Keep = "all",
        limit: int = DEFAULT_LIMIT,
    ) -> Signal[Any]:
        """Declare a signal.

        Args:
            name: Its name within the module.
            payload: The type of what it carries; nothing by default.
            input: Whether it may also come from outside although a rule raises it (L8). A signal that no
                rule raises is an input anyway.
            keep: ``"latest"``: a new spike withdraws the older ones (L20).
            limit: The greatest number of live spikes; beyond it the oldest is dropped (L23).
        """
        _check_name(name, f"{self.name}.signal")
        _check_keep(keep, limit, f"{self.name}:{name}")
        signal: Signal[Any] = Signal(
            f"{self.name}:{name}", payload, input=input, keep=keep, limit=limit, origin=_caller()
        )
        self.signals.append(signal)
        return signal

    @overload
    def slot(
        self,
        name: str,
        default: T,
        *,
        type: object = ...,
        always: bool = ...,
        input: bool = ...,
        keep: Keep = ...,
        limit: int = ...,
    ) -> Slot[T]: ...
    @overload
    def slot(
        self,
        name: str,
        *,
        type: type[T],
        always: bool = ...,
        input: bool = ...,
        keep: Keep = ...,
        limit: int = ...,
    ) -> Slot[T | None]: ...
    @overload
    def slot(
        self, name: str, *, always: bool = ..., input: bool = ..., keep: Keep = ..., limit: int = ...
    ) -> Slot[Any]: ...
    def slot(
        self,
        name: str,
        default: Any = None,
        *,
        type: Any = None,
        always: bool = False,
        input: bool = False,
        keep: Keep = "all",
        limit: int = DEFAULT_LIMIT,
    ) -> Slot[Any]:
        """Declare a value slot; its signal is ``.changed``.

        Args:
            name: Its name within the module.
            default: The value before the first write. Each context starts with a copy of its own.
            type: The value's type, e.g. ``str`` or ``str | Path``. A value of another one is refused when it is written;
                None is taken where it is the default. Types that ``isinstance`` does not know are not checked.
            always: Signal even when an equal value is written (an utterance may be said twice).
            input: Whether it is also written from outside although a rule writes it (L8).
            keep: ``"latest"``: a new change withdraws the spikes of older ones (L20).
            limit: The greatest number of live spikes of each of its signals (L23).
        """
        _check_name(name, f"{self.name}.slot")
        _check_keep(keep, limit, f"{self.name}:{name}")
        slot: Slot[Any] = Slot(
            f"{self.name}:{name}",
            default,
            type=type,
            always=always,
            input=input,
            keep=keep,
            limit=limit,
            origin=_caller(),
        )
        self.slots.append(slot)
        return slot

    def flag(
        self,
        name: str,
        default: bool = False,
        *,
        always: bool = False,
        input: bool = False,
        keep: Keep = "all",
        limit: int = DEFAULT_LIMIT,
    ) -> Flag:
        """Declare a boolean slot; its signals are ``.changed``, ``.true``, ``.false``. Arguments as for `slot`."""
        _check_name(name, f"{self.name}.flag")
        _check_keep(keep, limit, f"{self.name}:{name}")
        flag = Flag(
            f"{self.name}:{name}",
            default,
            always=always,
            input=input,
            keep=keep,
            limit=limit,
            origin=_caller(),
        )
        self.slots.append(flag)
        return flag

    def collection(
        self, name: str, *, input: bool = False, keep: Keep = "all", limit: int = DEFAULT_LIMIT
    ) -> Collection[Any]:
        """Declare keyed items; the signals are ``.added``, ``.removed``, ``.changed``. Arguments as for `slot`."""
        _check_name(name, f"{self.name}.collection")
        _check_keep(keep, limit, f"{self.name}:{name}")
        collection: Collection[Any] = Collection(
            f"{self.name}:{name}", input=input, keep=keep, limit=limit, origin=_caller()
        )
        self.slots.append(collection)
        return collection

    def rule(
        self,
        *,
        when: Condition,
        reads: Slot[Any] | Iterable[Slot[Any]] = (),
        writes: Slot[Any] | Iterable[Slot[Any]] = (),
        emits: Signal[Any] | Iterable[Signal[Any]] = (),
        weight: Number = 1.0,
        cooldown: Number = 0.0,
        patience: Number | None = None,
        until: Condition | None = None,
        timeout: Number | None = None,
        detached: bool = False,
        background: bool = False,
        name: str | None = None,
    ) -> Callable[[Callable[P, R]], Rule[P, R]]:
        """Make a rule of a function that takes the rule context: ``async def`` runs on the loop, a plain one in a thread.

        Args:
            when: The condition: signals, combined with ``&`` and ``|``.
            reads: The slot, or the slots, whose values the function may read.
            writes: What it may write, and read; rules that write one slot for the same cause exclude each other (L10).
            emits: The signals that it may emit.
            weight: Factor on the utility (L9), above 0.
            cooldown: Seconds over which the utility recovers from 0 after a run (L9).
            patience: Seconds that the rule, when others wait for it, has to become ready (L16); the context's by default.
            until: A condition that interrupts a run (L21).
            timeout: Seconds that a run may take (L18); any by default.
            detached: Whether what the rule causes begins new causal groups (L19).
            background: Whether the rule leaves ``rs.activity`` alone (L22).
            name: Its name within the module; the function's by default.

        Raises:
            DeclarationError: An argument of the wrong type. Faulty values are collected by ``rs.compile``.
        """
        frame = sys._getframe(1)  # pyright: ignore[reportPrivateUsage]  # where the rule is declared
        origin = f"{frame.f_code.co_filename}:{frame.f_lineno}"

        def decorate(function: Callable[P, R]) -> Rule[P, R]:
            title = name or getattr(function, "__name__", "")
            whole = f"{self.name}:{title}"
            if isinstance(function, Rule):
                raise DeclarationError(
                    f"{function.name} ({function.origin}) is a rule already: write its second condition behind |, or give "
                    "the second rule a function of its own"
                )
            if not callable(function):
                raise DeclarationError(f"@{self.name}.rule(...) stands above a function, not {function!r}")
            if name is None and not title.isidentifier():  # a lambda, a partial, an object
                raise DeclarationError(f"the rule at {origin} has no name of its own: write name='...'")
            code = cast("CodeType | None", getattr(function, "__code__", None))
            if code is not None and code.co_flags & GENERATOR_FLAGS:
                raise DeclarationError(
                    f"rule {whole} ({origin}) is a generator: a rule returns once; write with "
                    "ctx[slot] = value instead of yield"
                )
            if code is not None and code.co_argcount == 0 and not code.co_flags & 0x04:
                raise DeclarationError(f"rule {whole} ({origin}) takes no argument: write def {title}(ctx)")
            _check_name(title, f"rule {whole}")
            if isinstance(when, Slot):
                raise DeclarationError(
                    f"rule {whole} ({origin}): when={when!r} is a slot: write "
                    f"when={spelt(when.name, self.name)}.changed"
                )
            if not isinstance(when, Condition):  # pyright: ignore[reportUnnecessaryIsInstance]  # users may not type-check
                raise DeclarationError(
                    f"rule {whole} ({origin}): when={when!r} is no condition: combine signals with & and |"
                )
            if until is not None and not isinstance(until, Condition):  # pyright: ignore[reportUnnecessaryIsInstance]
                raise DeclarationError(
                    f"rule {whole} ({origin}): until={until!r} is no condition: combine signals with & and |"
                )
            numbers = {"weight": weight, "cooldown": cooldown, "patience": patience, "timeout": timeout}
            for what, number in numbers.items():
                if number is not None and (
                    isinstance(number, bool) or not isinstance(cast("object", number), type_of_number)
                ):
                    raise DeclarationError(
                        f"rule {whole} ({origin}): {what}={number!r} is no number; write {what}=1.0 or a setting"
                    )
            rule: Rule[P, R] = Rule(
                whole,
                function,
                when=when,
                reads=_many(reads, ANY_SLOT, f"rule {whole} ({origin}): reads", self.name),
                writes=_many(writes, ANY_SLOT, f"rule {whole} ({origin}): writes", self.name),
                emits=_many(emits, ANY_SIGNAL, f"rule {whole} ({origin}): emits", self.name),
                weight=_float(weight),
                cooldown=_float(cooldown),
                patience=None if patience is None else _float(patience),
                until=until,
                timeout=None if timeout is None else _float(timeout),
                detached=detached,
                background=background,
                origin=origin,
            )
            self.rules.append(rule)
            return rule

        return decorate

    def __repr__(self) -> str:
        return f"<module {self.name}>"


def as_module(value: object) -> Module:
    """The `Module` that a value stands for: itself, or the one that a Python module holds as ``module``.

    Raises:
        DeclarationError: It is neither.
    """
    if isinstance(value, Module):
        return value
    if isinstance(value, ModuleType):
        held = getattr(value, "module", None)
        if isinstance(held, Module):
            return held
        held_all = {id(v): v for v in vars(value).values() if isinstance(v, Module)}
        if len(held_all) == 1:
            return next(iter(held_all.values()))
        raise DeclarationError(
            f"Python module {value.__name__} holds {len(held_all) or 'no'} rs.Module"
            + ("s: name the one you mean `module`" if held_all else ": write module = rs.Module('name')")
        )
    raise DeclarationError(f"expected an rs.Module (or a Python module that holds one), not {value!r}")


def _caller() -> str:
    frame = sys._getframe(2)  # pyright: ignore[reportPrivateUsage]  # error messages say where a thing was declared
    return f"{frame.f_code.co_filename}:{frame.f_lineno}"


def _float(number: Number) -> Number:
    return number if isinstance(number, SettingRef) else float(number)


def _check_name(name: object, what: str) -> None:
    if not isinstance(name, str) or not name.replace("-", "_").isidentifier():
        raise DeclarationError(
            f"{what}: {name!r} is no name: use letters, digits, '_' and '-', beginning with a letter"
        )


def _check_keep(keep: object, limit: object, what: str) -> None:
    if keep not in ("all", "latest"):
        raise DeclarationError(f"{what}: keep={keep!r}: write keep='all' or keep='latest'")
    if not isinstance(limit, int) or limit < 1:
        raise DeclarationError(f"{what}: limit={limit!r}: write a whole number of at least 1")


def _many(values: Any, kind: type[T], what: str, home: str) -> tuple[T, ...]:
    if isinstance(values, kind):
        return (values,)
    try:
        found = tuple(values)
    except TypeError:
        found = (values,)
    for value in found:
        if not isinstance(value, kind):
            hint = ""
            if isinstance(value, Signal):
                hint = ": reads and writes name slots, emits names signals"
            elif isinstance(value, Slot):
                hint = f": writing it signals; write writes={spelt(cast('Slot[Any]', value).name, home)}"
            raise DeclarationError(f"{what}={value!r} is no {kind.__name__.lower()}{hint}")
    return tuple(dict.fromkeys(found))
