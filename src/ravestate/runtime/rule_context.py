"""The argument of a rule's function. The function reads slots and acts only through this argument (laws L3, L13)."""

from __future__ import annotations

import logging
import random
from collections.abc import ItemsView, Iterator, KeysView, Mapping, ValuesView
from types import MappingProxyType
from typing import Any, Generic, NoReturn, Protocol, TypeVar, overload

from ravestate.declare.rule import Rule
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Collection, Slot
from ravestate.declare.wording import spelt
from ravestate.engine.effects import Run
from ravestate.engine.events import Discard, Event, Store, Wipe
from ravestate.errors import RavestateError, RuleError, RunEnded, UndeclaredError, nearest
from ravestate.policy.policy import Policy
from ravestate.runtime.clock import Clock
from ravestate.runtime.lookup import check_known

T = TypeVar("T")
V = TypeVar("V")


class Host(Protocol):
    """The part of a running context's `Runner` that rule contexts use."""

    settings: Mapping[str, Any]
    clock: Clock

    @property
    def random(self) -> random.Random: ...
    @property
    def policy(self) -> Policy: ...
    def receive(self, event: Event) -> None: ...
    def emit(self, signal: str, payload: Any, run: int | None) -> None: ...
    def write(self, slot: str, value: Any, run: int | None) -> None: ...
    def add_rule(self, rule: Rule[Any, Any]) -> None: ...
    def stop(self, failure: RavestateError | None) -> None: ...
    async def quiet(self) -> None: ...
    def drive(self, time: float) -> None: ...


class RuleContext:
    """The argument of a rule's function. With it, the function reads slots, writes slots and emits signals.

    ``ctx[slot]`` is the slot's value when the rule started, or the rule's own last write. ``ctx[slot] = value`` writes
    the slot. A write takes effect and raises signals immediately. When the run is over, a write, `emit`, `wipe`,
    `add_rule` and `drive_clock` raise `RunEnded`.
    """

    __slots__ = ("_host", "_payloads", "_values", "cancelled", "ended", "origin", "rule", "run")

    def __init__(self, host: Host, effect: Run) -> None:
        self._host = host
        self.run = effect.run
        """The number of the run."""
        self.rule = effect.rule
        """The rule of the run."""
        self.origin: Any = effect.origin
        """The object that came with the event that led to this run.

        The event comes from code outside the rules. That code may pass an object to ``put`` or ``emit``. The origin is
        None if that code passed no object, or if no event from outside led to the run: then the agent acts on its own
        initiative. If a detached rule leads to further runs, these get its object as well. If several spikes of the run
        have an object, the object of the youngest counts. The spikes of detached constraints count only if no other
        spike has an object. ``core:error`` has the object of the run that failed. ``core:activity``, ``core:pressure``
        and the failure of a predicate have none.
        """
        self._payloads = effect.payloads
        self._values: dict[str, Any] = effect.values  # type: ignore[assignment]  # made for this run alone
        self.cancelled = ""
        """The reason for which the async function was cancelled, or empty. A cancelled function may still write."""
        self.ended = ""
        """The reason for which the run is over, or empty. Its function may still be running in a thread."""

    @overload
    def __getitem__(self, slot: Collection[V]) -> Items[V]: ...
    @overload
    def __getitem__(self, slot: Slot[T]) -> T: ...
    def __getitem__(self, slot: Slot[Any]) -> Any:
        """Read a slot.

        Raises:
            UndeclaredError: The rule declares the slot neither in ``reads`` nor in ``writes``.
        """
        try:
            value = self._values[slot.name]
        except (KeyError, AttributeError):
            self._refuse("read", "reads", slot, (*self.rule.reads, *self.rule.writes))
        if slot.kind == "collection":
            return Items(self, slot)  # type: ignore[arg-type]  # the kind of the slot proves the type
        return value

    def __setitem__(self, slot: Slot[T], value: T) -> None:
        """Write a slot.

        Raises:
            UndeclaredError: The rule does not declare the slot in ``writes``.
            RuleError: The value is not of the slot's type.
            RunEnded: The run is over.
        """
        if slot not in self.rule.writes:
            self._refuse("wrote", "writes", slot, self.rule.writes)
        self._alive()
        if slot.type is not None:
            slot.check(value, f"rule {self.rule.name} ({self.rule.origin})")
        if slot.kind == "collection":
            if not isinstance(value, Mapping):
                raise RuleError(
                    f"rule {self.rule.name} ({self.rule.origin}) wrote {type(value).__name__} to the collection "
                    f"{slot.name}: write a mapping of keys to items, or ctx[{self._spelt(slot)}].add(key, item)"
                )
            value = MappingProxyType(dict(value))  # type: ignore[assignment]  # the kind of the slot proves the type
        elif slot.kind == "flag":
            value = bool(value)  # type: ignore[assignment]  # the kind of the slot proves the type
        self._values[slot.name] = value
        self._host.write(slot.name, value, self.run)

    @overload
    def payload(self, signal: Signal[T]) -> T: ...
    @overload
    def payload(self, signal: Signal[Any]) -> Any: ...
    def payload(self, signal: Signal[Any]) -> Any:
        """Return the payload of a signal that started the rule; None if the signal did not help to start it.

        Raises:
            UndeclaredError: The signal is not part of the rule's condition.
        """
        try:
            return self._payloads[signal.name]
        except (KeyError, AttributeError):
            plan = self._host.policy.rule_plan(self.rule)
            names = {need.signal.name for clause in plan.clauses for need in clause.needs}
            if getattr(signal, "name", None) in names:
                return None
            raise UndeclaredError(
                f"rule {self.rule.name} ({self.rule.origin}) asked for the payload of {signal!r}, which is not in its "
                f"condition: the condition has {', '.join(sorted(names))}"
                f"{nearest(str(getattr(signal, 'name', signal)), names)}"
            ) from None

    def emit(self, signal: Signal[T], payload: T | None = None) -> None:
        """Raise a signal.

        Raises:
            UndeclaredError: The rule does not declare the signal in ``emits``.
            RunEnded: The run is over.
        """
        for declared in self.rule.emits:
            if declared is signal:
                break
        else:
            self._refuse("emitted", "emits", signal, self.rule.emits)
        if self.ended:
            self._alive()
        self._host.emit(signal.name, payload, self.run)

    def wipe(self, signal: Signal[Any]) -> None:
        """Withdraw the live spikes of a signal, and all spikes that they have caused (L20).

        Other async runs that began with such a spike are cancelled.

        Raises:
            UndeclaredError: The policy does not have the signal.
        """
        self._alive()
        check_known(signal, self._host.policy.signals, Signal, self.rule)
        self._host.receive(Wipe(signal.name, self.run))

    def add_rule(self, rule: Rule[Any, Any]) -> None:
        """Add a rule to this context alone. The rule must use signals and slots of this context's policy.

        Raises:
            DeclarationErrors: The rule does not fit the policy.
        """
        self._alive()
        self._host.add_rule(rule)

    async def sleep(self, seconds: float) -> None:
        """Wait until `seconds` have passed on the context's clock. With 0 or less, only give other tasks a turn.

        Raises:
            ValueError: `seconds` is NaN.
        """
        await self._host.clock.sleep(seconds)

    async def quiet(self) -> None:
        """Wait until no foreground rule (without ``background=True``) runs, or is ready and waits to run.

        Call this only in a background rule: a foreground rule would wait for its own end.
        """
        await self._host.quiet()

    def drive_clock(self, time: float) -> None:
        """Set the context's clock forward to `time` (seconds since its start), e.g. to a robot simulator's time.

        From the first call on, only calls of this method move the clock. So the context's time passes, and halts, with
        the simulator's time. A time in the past changes nothing.
        """
        self._alive()
        self._host.drive(time)

    def stop(self, failure: RavestateError | None = None) -> None:
        """Ask the context to end. It raises ``rs.shutdown``, waits a few seconds, and cancels the rules that still run.

        Args:
            failure: The error that ends the agent, if any; ``rs.run`` raises it when the agent has ended.
        """
        self._host.stop(failure)

    @property
    def now(self) -> float:
        """The time on the context's clock: the seconds since the start, without pauses."""
        return self._host.clock.now()

    @property
    def settings(self) -> Any:
        """The settings of the rule's module; None if the module has none."""
        return self._host.settings.get(self.rule.name.split(":", 1)[0])

    @property
    def policy(self) -> Policy:
        """The context's policy: its modules, signals, slots and rules."""
        return self._host.policy

    @property
    def log(self) -> logging.Logger:
        """A logger named ``ravestate.<module>.<rule>``."""
        return logging.getLogger("ravestate." + self.rule.name.replace(":", "."))

    @property
    def random(self) -> random.Random:
        """Random numbers from the context's seed. A rule should use no other ones, so that its tests are repeatable."""
        return self._host.random

    def _alive(self) -> None:
        if self.ended:
            raise RunEnded(f"rule {self.rule.name} acted after its run was over ({self.ended})")

    def _refuse(self, did: str, what: str, value: Any, declared: tuple[Any, ...]) -> NoReturn:
        name = str(getattr(value, "name", repr(value)))
        if what == "emits" and isinstance(value, Slot):
            raise UndeclaredError(
                f"rule {self.rule.name} ({self.rule.origin}) emitted {name}, which is a slot: write "
                f"ctx[{self._spelt(value)}] = value, or emit a signal: ctx.emit(signal)"
            )
        kind, right = ("signal", "ctx.emit(signal)") if what == "emits" else ("slot", "ctx[slot]")
        if not isinstance(value, Signal if what == "emits" else Slot):
            raise UndeclaredError(
                f"rule {self.rule.name} ({self.rule.origin}) {did} {name}, which is not a {kind}: write {right}"
            )
        own = getattr(self.rule, what)
        line = self._spelt(value)
        line = f"add {what}={line} to" if not own else f"declare {what}=({', '.join(map(self._spelt, own))}, {line}) in"
        raise UndeclaredError(
            f"rule {self.rule.name} ({self.rule.origin}) {did} {name} without declaring it: {line} "
            f"@{self.rule.name.split(':')[0]}.rule(...){nearest(name, [d.name for d in declared])}"
        )

    def _spelt(self, thing: Any) -> str:
        return spelt(str(getattr(thing, "name", thing)), self.rule.name.split(":")[0])


class Items(Mapping[str, V], Generic[V]):
    """A rule's view of a collection: a mapping of keys to items, with `add` and `remove`.

    The mapping shows the rule's own changes. An iteration visits the keys that existed when it began.
    """

    __slots__ = ("_ctx", "_slot")

    def __init__(self, ctx: RuleContext, slot: Collection[V]) -> None:
        self._ctx = ctx
        self._slot = slot

    @property
    def _items(self) -> Mapping[str, V]:
        return self._ctx._values[self._slot.name]  # pyright: ignore[reportPrivateUsage]

    def add(self, key: str, item: V) -> None:
        """Set the item of a key. A new key raises ``added`` and ``changed``; a different item raises ``changed``.

        Raises:
            UndeclaredError: The rule does not declare the collection in ``writes``.
        """
        self._own()[key] = item
        self._ctx._host.receive(Store(self._slot.name, key, item, self._ctx.run))  # pyright: ignore[reportPrivateUsage]

    def remove(self, key: str) -> None:
        """Remove the item of a key. If the key has an item, this raises ``removed`` and ``changed``.

        Raises:
            UndeclaredError: The rule does not declare the collection in ``writes``.
        """
        self._own().pop(key, None)
        self._ctx._host.receive(Discard(self._slot.name, key, self._ctx.run))  # pyright: ignore[reportPrivateUsage]

    def _own(self) -> dict[str, V]:
        """Return the rule's own copy of the items. The rule's first change makes the copy."""
        ctx = self._ctx
        if self._slot not in ctx.rule.writes:  # pyright: ignore[reportPrivateUsage]
            ctx._refuse("wrote", "writes", self._slot, ctx.rule.writes)  # pyright: ignore[reportPrivateUsage]
        ctx._alive()  # pyright: ignore[reportPrivateUsage]
        items = self._items
        if not isinstance(items, dict):
            items = ctx._values[self._slot.name] = dict(items)  # pyright: ignore[reportPrivateUsage]
        return items

    def __setitem__(self, key: str, item: V) -> NoReturn:
        self._point_to("add(key, item)")

    def __delitem__(self, key: str) -> NoReturn:
        self._point_to("remove(key)")

    def _point_to(self, call: str) -> NoReturn:
        rule, slot = self._ctx.rule, self._ctx._spelt(self._slot)  # pyright: ignore[reportPrivateUsage]
        raise RuleError(
            f"rule {rule.name} ({rule.origin}): the items of a collection cannot be assigned or deleted: write "
            f"ctx[{slot}].{call}"
        )

    def __getitem__(self, key: str) -> V:
        return self._items[key]

    def __iter__(self) -> Iterator[str]:
        return iter(tuple(self._items))

    def keys(self) -> KeysView[str]:
        """Return the present keys; later changes do not change the result."""
        return dict(self._items).keys()

    def values(self) -> ValuesView[V]:
        """Return the present items; later changes do not change the result."""
        return dict(self._items).values()

    def items(self) -> ItemsView[str, V]:
        """Return the present keys and items; later changes do not change the result."""
        return dict(self._items).items()

    def __len__(self) -> int:
        return len(self._items)

    def __repr__(self) -> str:
        return f"{self._slot.name}{dict(self._items)!r}"
