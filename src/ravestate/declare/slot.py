"""Slots: named, typed, long-lived variables, each with signals of its own (law L2)."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Generic, NamedTuple, NoReturn, TypeVar, Unpack

from ravestate.declare.condition import Holds, Predicate, checked_predicate
from ravestate.declare.signal import Signal, SignalOptions
from ravestate.declare.wording import place_of_call, short
from ravestate.errors import DeclarationError, RuleError, nearest

T = TypeVar("T")
V = TypeVar("V")

NOTHING: Mapping[str, Any] = MappingProxyType({})


class SlotOptions(SignalOptions, total=False):
    """The options of a value slot and of a flag.

    Attributes:
        always: Whether writing an equal value also raises the slot's signals, e.g. when the same utterance comes twice.
    """

    always: bool


class Entry(NamedTuple):
    """The payload of a collection's signals: the key, and the item that was added, set or removed."""

    key: str
    item: Any


class Slot(Generic[T]):
    """A value slot, made by ``module.slot(...)``. Its signal is ``.changed`` (payload: the new value).

    Attributes:
        name: The qualified name, ``module:name``.
        default: The value before the first write. Each context gets its own copy.
        type: The type that `isinstance` checks at each write; None if writes are not checked.
        declared: The type as the designer wrote it, such as ``list[int]``; None if the designer gave no type.
        always: Whether writing an equal value also raises the slot's signals.
        signals: All signals of the slot, `changed` first.
        origin: The place of the declaration, ``file:line``.
    """

    __slots__ = ("always", "changed", "declared", "default", "name", "origin", "signals", "type")
    kind = "value"
    names: tuple[str, ...] = ("changed",)

    def __init__(
        self,
        name: str,
        default: T,
        *,
        origin: str,
        type: Any = None,
        always: bool = False,
        **options: Unpack[SignalOptions],
    ) -> None:
        self.name = name
        self.default = default
        self.type = checkable(type)
        self.declared = type
        self.always = always
        self.origin = origin
        self.changed: Signal[Any]
        self.signals: tuple[Signal[Any], ...] = tuple(
            Signal[Any](f"{name}:{what}", None, origin=origin, **options) for what in self.names
        )
        for what, signal in zip(self.names, self.signals, strict=True):
            setattr(self, what, signal)

    def check(self, value: object, writer: str) -> None:
        """If the value is not of the slot's type, raise a `RuleError` that names the `writer`."""
        if self.type is None or isinstance(value, self.type) or (value is None and self.default is None):
            return
        takes = getattr(self.type, "__name__", str(self.type))
        raise RuleError(
            f"{writer} wrote {short(value)} to {self.name}, which takes {takes}, not {type(value).__name__}"
        )

    def holds(self, predicate: Predicate) -> Holds:
        """Return a condition: a rule starts only while ``predicate(value)`` is true.

        Such a condition triggers no rule, so combine it with a signal by ``&``. The predicate is a plain, fast function
        of the slot's value. It adds ln 2 to the rule's utility (L9).

        Raises:
            DeclarationError: The predicate is not callable, or it is asynchronous or a generator.
        """
        return Holds(self, checked_predicate(predicate, f"{self.name}.holds", "value"))

    def __getattr__(self, attribute: str) -> NoReturn:
        if attribute.startswith("__"):
            raise AttributeError(attribute)
        raise AttributeError(
            f"{self.kind} slot {self.name} has no {attribute!r}: its signals are {', '.join(self.names)}"
            f"{nearest(attribute, [*self.names, 'holds', 'default'])}",
            name=attribute,
        )

    def __and__(self, other: object) -> NoReturn:
        raise DeclarationError(
            f"slot {self.name} ({place_of_call()}) is not a condition: write .changed (its signal) or .holds(predicate)"
        )

    __or__ = __rand__ = __ror__ = __and__

    def __repr__(self) -> str:
        return self.name


def checkable(kind: Any) -> Any:
    """Return the type to check with `isinstance`, or None if `isinstance` cannot check `kind`.

    A float slot also takes integers.
    """
    if kind is float:
        kind = int | float
    try:
        isinstance(None, kind)
    except TypeError:
        return None
    return kind


class Flag(Slot[bool]):
    """A boolean slot with the signals ``.changed``, ``.true`` and ``.false`` (payload: the flag's new value)."""

    __slots__ = ("false", "true")
    kind = "flag"
    names = ("changed", "true", "false")
    true: Signal[bool]
    false: Signal[bool]


class Collection(Slot[Mapping[str, V]]):
    """Items by key, with the signals ``.added``, ``.removed`` and ``.changed`` (payload: an `Entry`).

    Every change raises ``changed``, as for any slot. A new key raises ``added``, and a removed key raises ``removed``.
    """

    __slots__ = ("added", "removed")
    kind = "collection"
    names = ("changed", "added", "removed")
    added: Signal[Entry]
    removed: Signal[Entry]

    def __init__(self, name: str, *, origin: str, **options: Unpack[SignalOptions]) -> None:
        super().__init__(name, NOTHING, origin=origin, **options)
