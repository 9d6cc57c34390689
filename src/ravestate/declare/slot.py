"""Slots: named, typed, long-lived variables, each with signals of its own (L2)."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Generic, NamedTuple, NoReturn, TypeVar

from ravestate.declare.condition import Holds, Predicate, checked_predicate
from ravestate.declare.signal import Keep, Signal
from ravestate.declare.wording import place_of_call
from ravestate.errors import DeclarationError, RuleError, nearest

__all__ = ["Collection", "Entry", "Flag", "Slot", "checkable"]

T = TypeVar("T")
V = TypeVar("V")

NOTHING: Mapping[str, Any] = MappingProxyType({})


class Entry(NamedTuple):
    """Payload of a collection's signals: the key, and the item that was added, set or removed."""

    key: str
    item: Any


class Slot(Generic[T]):
    """A value slot. Made by ``module.slot(...)``; its signal is ``.changed`` (payload: the new value).

    Attributes:
        name: The qualified name, ``module:name``.
        default: The value before the first write; each context gets a copy of its own.
        type: What `isinstance` is asked of each value written; None: nothing.
        declared: The type as it was declared, such as ``list[int]``; None: none was.
        always: Whether writing an equal value signals too.
        signals: All signals of the slot, `changed` first.
        origin: Where it was declared, ``file:line``.
    """

    __slots__ = ("always", "changed", "declared", "default", "name", "origin", "signals", "type")
    kind = "value"

    def __init__(
        self,
        name: str,
        default: T,
        *,
        always: bool,
        input: bool,
        keep: Keep,
        limit: int,
        origin: str,
        type: Any = None,
    ) -> None:
        self.name = name
        self.default = default
        self.type = checkable(type)
        self.declared = type
        self.always = always
        self.origin = origin
        self.changed: Signal[Any] = self._signal("changed", input, keep, limit)
        self.signals: tuple[Signal[Any], ...] = (self.changed,)

    def _signal(self, what: str, input: bool, keep: Keep, limit: int) -> Signal[Any]:
        return Signal(f"{self.name}:{what}", None, input=input, keep=keep, limit=limit, origin=self.origin)

    def check(self, value: object, writer: str) -> None:
        """Refuse a value that is not of the slot's type.

        Args:
            value: What is written.
            writer: Who writes it, for the message.

        Raises:
            RuleError: It is of another type.
        """
        if self.type is None or isinstance(value, self.type) or (value is None and self.default is None):
            return
        text = repr(value)
        takes = getattr(self.type, "__name__", str(self.type))
        raise RuleError(
            f"{writer} wrote {text if len(text) <= 60 else text[:57] + '...'} to {self.name}, which takes {takes}, not "
            f"{type(value).__name__}"
        )

    def holds(self, predicate: Predicate) -> Holds:
        """Gate a rule by ``predicate(value)`` of the slot's present value. Adds ln 2 to the utility (L9)."""
        return Holds(self, checked_predicate(predicate, f"{self.name}.holds", "value"))

    def __getattr__(self, attribute: str) -> NoReturn:
        if attribute.startswith("__"):
            raise AttributeError(attribute)
        names = [signal.name.rsplit(":", 1)[-1] for signal in self.signals]
        raise AttributeError(
            f"{self.kind} slot {self.name} has no {attribute!r}: its signals are {', '.join(names)}"
            f"{nearest(attribute, [*names, 'holds', 'default'])}",
            name=attribute,
        )

    def __and__(self, other: object) -> NoReturn:
        raise DeclarationError(
            f"slot {self.name} ({place_of_call()}) is no condition: write .changed (its signal) or .holds(predicate)"
        )

    __or__ = __rand__ = __ror__ = __and__

    def __repr__(self) -> str:
        return self.name


def checkable(kind: Any) -> Any:
    """A type as `isinstance` takes it, an int being fine for a float; None if it does not."""
    if kind is float:
        kind = int | float
    try:
        isinstance(None, kind)
    except TypeError:
        return None
    return kind


class Flag(Slot[bool]):
    """A boolean slot with the signals ``.changed``, ``.true`` and ``.false`` (payload: the new value)."""

    __slots__ = ("false", "true")
    kind = "flag"

    def __init__(
        self, name: str, default: bool, *, always: bool, input: bool, keep: Keep, limit: int, origin: str
    ) -> None:
        super().__init__(name, default, always=always, input=input, keep=keep, limit=limit, origin=origin)
        self.true: Signal[bool] = self._signal("true", input, keep, limit)
        self.false: Signal[bool] = self._signal("false", input, keep, limit)
        self.signals = (self.changed, self.true, self.false)


class Collection(Slot[Mapping[str, V]]):
    """Items by key, with the signals ``.added``, ``.removed`` and ``.changed`` (payload: an `Entry`).

    ``changed`` is raised by every change, as for any slot; ``added`` and ``removed`` say that a key came
    or went.
    """

    __slots__ = ("added", "removed")
    kind = "collection"

    def __init__(self, name: str, *, input: bool, keep: Keep, limit: int, origin: str) -> None:
        super().__init__(name, NOTHING, always=False, input=input, keep=keep, limit=limit, origin=origin)
        self.added: Signal[Entry] = self._signal("added", input, keep, limit)
        self.removed: Signal[Entry] = self._signal("removed", input, keep, limit)
        self.signals = (self.changed, self.added, self.removed)
