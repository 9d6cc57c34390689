"""What may be written and raised by hand: what a type checker would let a rule write, as far as JSON has words for it."""

from __future__ import annotations

from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from ravestate.board.protocol import Emit
from ravestate.board.rendering import not_json
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Collection, Flag, Slot, checkable
from ravestate.errors import RavestateError

__all__ = ["check_payload", "check_value"]

WORDS: tuple[Any, ...] = (True, 0, 0.5, "", [], {})
"""One of each kind of thing that JSON has a word for, but null."""


def check_value(slot: Slot[Any], value: object, holds: object) -> None:
    """Refuse what cannot be written to a slot by hand; what `Slot.check` refuses as it is written is left to it.

    Args:
        slot: The slot.
        value: As it was read from JSON.
        holds: What the slot holds now: if it has no type, that tells what it is for.

    Raises:
        RavestateError: JSON has no words for what the slot takes, or the value is of another type.
    """
    if isinstance(slot, Flag) and not isinstance(value, bool):
        raise RavestateError(f"{slot.name} is a flag: write true or false, not {value!r}")
    takes = _asked(slot.declared)
    if takes is None:
        _check_holds(slot, holds)
    elif value is None and slot.default is None:
        return
    elif not _is_sayable(takes):
        raise RavestateError(f"{slot.name} takes {_named(slot.declared)}, for which JSON has no words")
    elif slot.type is None and not isinstance(value, takes):
        raise RavestateError(f"{slot.name} takes {_named(slot.declared)}, not {type(value).__name__}")


def check_payload(signal: Signal[Any], command: Emit, slot: Slot[Any] | None, holds: object = None) -> None:
    """Refuse a payload that is missing, that the signal does not carry, or that is not of its type.

    Args:
        signal: The signal.
        command: What is asked for.
        slot: The slot whose signal it is, if it is one's.
        holds: What that slot holds now.

    Raises:
        RavestateError: It is refused; the message says what to do instead.
    """
    if isinstance(slot, Collection):
        raise RavestateError(f"{signal.name} tells of a change in the collection {slot.name}: write the slot")
    if slot is None:
        kind = signal.payload
        if kind is None or kind is NoneType:
            if command.payload is not None:
                raise RavestateError(
                    f"{signal.name} carries no payload: leave it away, or declare its type (payload=...)"
                )
            return
    else:
        kind = bool if isinstance(slot, Flag) else slot.declared
        if _asked(kind) is None:
            _check_holds(slot, holds)
            return
        if command.payload is None and slot.default is None:
            return
    _check_kind(signal, kind, command)


def _check_kind(signal: Signal[Any], kind: Any, command: Emit) -> None:
    what = f"{signal.name} carries a payload of type {_named(kind)}"
    takes = _asked(kind)
    if not _is_sayable(takes):
        raise RavestateError(f"{what}, for which JSON has no words: only a rule or a program can raise it")
    if "payload" not in command.model_fields_set:
        raise RavestateError(f"{what}: give one")
    if takes is not None and not isinstance(command.payload, takes):
        raise RavestateError(f"{what}, not {type(command.payload).__name__}")


def _check_holds(slot: Slot[Any], holds: object) -> None:
    if not isinstance(slot, Flag) and not isinstance(slot, Collection) and not_json(holds):
        raise RavestateError(
            f"{slot.name} holds a {type(holds).__name__}, for which JSON has no words: only a rule or a program can "
            "write it"
        )


def _is_sayable(takes: Any) -> bool:
    """Whether anything that JSON has a word for is of a type, as far as one can tell."""
    return takes is None or any(isinstance(word, takes) for word in WORDS)


def _asked(kind: Any) -> Any:
    """What `isinstance` is asked of a type; None: nothing.

    Of ``list[int]`` it is whether something is a list: what that holds is not looked at.
    """
    takes = checkable(kind)
    if takes is not None:
        return takes
    origin = get_origin(kind)
    if origin is Annotated:
        return _asked(get_args(kind)[0])
    if origin is Union or origin is UnionType:
        each = tuple(_asked(one) for one in get_args(kind))
        return None if None in each else each
    return checkable(origin)


def _named(kind: Any) -> str:
    return getattr(kind, "__name__", str(kind)) if isinstance(kind, type) else str(kind)
