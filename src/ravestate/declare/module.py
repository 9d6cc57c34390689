"""A module is a value that holds the declarations of a designer (laws L1-L3). There is no global registry."""

from __future__ import annotations

from collections.abc import Callable, Coroutine, Iterable
from types import ModuleType
from typing import Any, ParamSpec, TypeAlias, TypeVar, Unpack, cast, overload

from ravestate.declare import arguments
from ravestate.declare.arguments import check_name, check_options, condition, keywords, number, several
from ravestate.declare.condition import Condition
from ravestate.declare.rule import Rule
from ravestate.declare.settings import Number
from ravestate.declare.signal import Signal, SignalOptions
from ravestate.declare.slot import Collection, Flag, Slot, SlotOptions
from ravestate.declare.wording import place_of_call
from ravestate.errors import DeclarationError

T = TypeVar("T")
P = ParamSpec("P")
R = TypeVar("R")

Server: TypeAlias = Callable[[Any], Coroutine[Any, Any, None]]
"""A function that serves an `Agent` to many users."""

S = TypeVar("S", bound=Server)

ANY_SLOT: type[Slot[Any]] = Slot
ANY_SIGNAL: type[Signal[Any]] = Signal


class Module:
    """A named collection of signals, slots and rules.

    Args:
        name: Letters, digits, ``_`` and ``-``, without a digit at the beginning. The names of the module's signals,
            slots and rules begin with it.
        requires: Modules whose signals and slots this module uses: `Module` values, or Python modules that contain a
            `Module` (``from ravestate.modules import rawio``).
        settings: A subclass of ``rs.Settings`` with the values that a user may configure.
        serve: An async function that serves an agent to many users. The decorator `server` can declare it later.

    Raises:
        DeclarationError: The name is invalid, a value in `requires` is no module, or `settings` is no settings class.

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

    @keywords()
    def __init__(
        self,
        name: str,
        *,
        requires: Iterable[Module | ModuleType] = (),
        settings: type[Any] | None = None,
        serve: Server | None = None,
    ) -> None:
        check_name(name, "Module")
        self.name = name
        self.origin = place_of_call()
        if isinstance(requires, (Module, ModuleType, str)):
            requires = (requires,)  # type: ignore[assignment]  # `as_module` refuses a str; do not iterate over it
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
    def signal(self, name: str, **options: Unpack[SignalOptions]) -> Signal[None]: ...
    @overload
    def signal(self, name: str, payload: type[T], **options: Unpack[SignalOptions]) -> Signal[T]: ...
    @keywords(*SignalOptions.__annotations__)
    def signal(self, name: str, payload: Any = None, **options: Unpack[SignalOptions]) -> Signal[Any]:
        """Declare a signal.

        Args:
            name: The signal's name within the module.
            payload: The type of the payload; by default, the signal has no payload. Raising the signal does not check
                the type.
            options: See `SignalOptions`.

        Raises:
            DeclarationError: The name or an option is invalid.
        """
        qualified = self._qualified("signal", name, options)
        signal: Signal[Any] = Signal(qualified, payload, origin=place_of_call(), **options)
        self.signals.append(signal)
        return signal

    @overload
    def slot(self, name: str, default: T, *, type: object = ..., **options: Unpack[SlotOptions]) -> Slot[T]: ...
    @overload
    def slot(self, name: str, *, type: type[T], **options: Unpack[SlotOptions]) -> Slot[T | None]: ...
    @overload
    def slot(self, name: str, **options: Unpack[SlotOptions]) -> Slot[Any]: ...
    @keywords(*SlotOptions.__annotations__)
    def slot(self, name: str, default: Any = None, *, type: Any = None, **options: Unpack[SlotOptions]) -> Slot[Any]:
        """Declare a value slot; its signal is ``.changed``.

        Args:
            name: The slot's name within the module.
            default: The slot's value before the first write. Each context gets its own copy.
            type: The value's type, e.g. ``str`` or ``str | Path``. Writing a value of another type fails; None is
                allowed if it is the default. A ``float`` slot also takes integers. Types that ``isinstance`` cannot
                check are not enforced.
            options: See `SlotOptions`.

        Raises:
            DeclarationError: The name or an option is invalid.
        """
        qualified = self._qualified("slot", name, options)
        slot: Slot[Any] = Slot(qualified, default, type=type, origin=place_of_call(), **options)
        self.slots.append(slot)
        return slot

    @keywords(*SlotOptions.__annotations__)
    def flag(self, name: str, default: bool = False, **options: Unpack[SlotOptions]) -> Flag:
        """Declare a boolean slot with the signals ``.changed``, ``.true``, ``.false``. Its arguments: see `slot`."""
        flag = Flag(self._qualified("flag", name, options), default, origin=place_of_call(), **options)
        self.slots.append(flag)
        return flag

    @keywords(*SignalOptions.__annotations__)
    def collection(self, name: str, **options: Unpack[SignalOptions]) -> Collection[Any]:
        """Declare a slot that maps keys to items, with the signals ``.added``, ``.removed`` and ``.changed``.

        Options: see `SignalOptions`.
        """
        qualified = self._qualified("collection", name, options)
        collection: Collection[Any] = Collection(qualified, origin=place_of_call(), **options)
        self.slots.append(collection)
        return collection

    def _qualified(self, what: str, name: str, options: SlotOptions | SignalOptions) -> str:
        check_name(name, f"{self.name}.{what}")
        check_options(options.get("keep", "all"), options.get("limit", 1), what=f"{self.name}:{name}")
        return f"{self.name}:{name}"

    @keywords()
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
        """Return a decorator that turns a function into a rule. The function receives the rule context.

        An ``async def`` runs on the event loop; a plain function runs in a thread.

        Args:
            when: The condition: signals and predicates on slots, combined with ``&`` and ``|``.
            reads: The slot or slots whose values the function may read.
            writes: The slot or slots that the function may write and read. Rules that write the same slot for the same
                cause exclude each other (L10).
            emits: The signal or signals that the function may emit.
            weight: A factor above 0 that multiplies the utility (L9).
            cooldown: When the rule has fired, its utility takes this many seconds to recover from 0 (L9). A run that
                resigned, or failed before its first write, does not count.
            patience: If this rule lacks an input or a spike of another causal group, other rules wait for it, at most
                this many seconds (L16). Only rules of less utility that write the same slot wait. The default is the
                context's patience.
            until: A condition that interrupts a run when new spikes meet it (L21).
            timeout: The maximum duration of a run in seconds, after which it fails (L18); no limit by default.
            detached: Whether the rule's effects begin new causal groups (L19).
            background: If true, the rule never makes ``rs.activity`` true (L22), and `Context.quiet` does not wait for
                it.
            name: The rule's name within the module; by default the function's name.

        Raises:
            DeclarationError: An argument has the wrong type, the name is invalid, or the function cannot be a rule's
                function. ``rs.compile`` reports numbers out of range.
        """
        origin = place_of_call()

        def decorate(function: Callable[P, R]) -> Rule[P, R]:
            title = name or getattr(function, "__name__", "")
            where = f"rule {self.name}:{title} ({origin})"
            arguments.check_function(
                function, title, named=bool(name), where=where, decorator=f"@{self.name}.rule(...)"
            )
            rule: Rule[P, R] = Rule(
                f"{self.name}:{title}",
                function,
                when=condition(when, "when", where, self.name),
                reads=several(reads, ANY_SLOT, "reads", where, self.name),
                writes=several(writes, ANY_SLOT, "writes", where, self.name),
                emits=several(emits, ANY_SIGNAL, "emits", where, self.name),
                weight=number(weight, "weight", where),
                cooldown=number(cooldown, "cooldown", where),
                patience=None if patience is None else number(patience, "patience", where),
                until=None if until is None else condition(until, "until", where, self.name),
                timeout=None if timeout is None else number(timeout, "timeout", where),
                detached=detached,
                background=background,
                origin=origin,
            )
            self.rules.append(rule)
            return rule

        return decorate

    def server(self, function: S) -> S:
        """Make an async function the server of a platform with many users: ``@module.server`` above the function.

        ``rs.run`` calls the function with the `Agent` instead of running one context. The function makes a context for
        each user, and ends when it is cancelled.

        Raises:
            DeclarationError: The module has a server already.
        """
        if self.serve is not None:
            raise DeclarationError(f"module {self.name} ({self.origin}) has a server already: {self.serve!r}; keep one")
        self.serve = function
        return function

    def __repr__(self) -> str:
        return f"<module {self.name}>"


def as_module(value: object) -> Module:
    """Return a `Module` itself; for a Python module, return its attribute ``module``, or else its only `Module`.

    Raises:
        DeclarationError: The value is of another type, or the Python module holds no `Module` or more than one.
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
            + ("s: call one of them `module`" if held_all else ": write module = rs.Module('name')")
        )
    raise DeclarationError(f"expected an rs.Module (or a Python module that holds one), not {value!r}")
