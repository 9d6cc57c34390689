"""Checks of the values and payloads that a user of the board types as JSON."""

from __future__ import annotations

from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from ravestate.board.protocol import Emit
from ravestate.board.rendering import not_json
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Collection, Flag, Slot, checkable
from ravestate.errors import RavestateError

SAMPLES: tuple[Any, ...] = (True, 0, 0.5, "", [], {})  # one value of each JSON type except null


def check_value(slot: Slot[Any], value: object, holds: object) -> None:
    """Raise a `RavestateError` if a user may not write a value to a slot. The write itself checks more (`Slot.check`).

    If the slot declares no type that can be checked, its current value, `holds`, must be one that JSON can express.
    """
    if isinstance(slot, Flag) and not isinstance(value, bool):
        raise RavestateError(f"{slot.name} is a flag: write true or false, not {value!r}")
    takes = _checkable(slot.declared)
    if takes is None:
        _check_holds(slot, holds)
    elif value is None and slot.default is None:
        return
    elif not _is_expressible(takes):
        raise RavestateError(f"{slot.name} takes {_named(slot.declared)}, which JSON cannot express")
    elif slot.type is None and not isinstance(value, takes):
        raise RavestateError(f"{slot.name} takes {_named(slot.declared)}, not {type(value).__name__}")


def check_payload(signal: Signal[Any], command: Emit, slot: Slot[Any] | None, holds: object = None) -> None:
    """Raise a `RavestateError` if a payload is missing, superfluous, or of the wrong type.

    If the signal belongs to a slot, `slot` is that slot, and `holds` is its current value.
    """
    if isinstance(slot, Collection):
        raise RavestateError(f"{signal.name} announces a change of the collection {slot.name}: write the slot instead")
    if slot is None:
        kind = signal.payload
        if kind is None or kind is NoneType:
            if command.payload is not None:
                raise RavestateError(f"{signal.name} carries no payload: send none, or declare its type (payload=...)")
            return
    else:
        kind = bool if isinstance(slot, Flag) else slot.declared
        if _checkable(kind) is None:
            _check_holds(slot, holds)
            return
        if command.payload is None and slot.default is None:
            return
    _check_kind(signal, kind, command)


def _check_kind(signal: Signal[Any], kind: Any, command: Emit) -> None:
    what = f"{signal.name} carries a payload of type {_named(kind)}"
    takes = _checkable(kind)
    if not _is_expressible(takes):
        raise RavestateError(f"{what}, which JSON cannot express: only a rule or a program can raise it")
    if "payload" not in command.model_fields_set:
        raise RavestateError(f"{what}: give a payload")
    if takes is not None and not isinstance(command.payload, takes):
        raise RavestateError(f"{what}, not {type(command.payload).__name__}")


def _check_holds(slot: Slot[Any], holds: object) -> None:
    if not isinstance(slot, Flag) and not isinstance(slot, Collection) and not_json(holds):
        raise RavestateError(
            f"{slot.name} holds a {type(holds).__name__}, which JSON cannot express: only a rule or a program can write it"
        )


def _is_expressible(takes: Any) -> bool:
    """Return whether JSON can express at least one value of these types; None means any type."""
    return takes is None or any(isinstance(sample, takes) for sample in SAMPLES)


def _checkable(kind: Any) -> Any:
    """Return the type or types for an `isinstance` check of a value, or None if no such check is possible.

    For ``list[int]``, the check accepts any list and ignores its items.
    """
    takes = checkable(kind)
    if takes is not None:
        return takes
    origin = get_origin(kind)
    if origin is Annotated:
        return _checkable(get_args(kind)[0])
    if origin is Union or origin is UnionType:
        each = tuple(_checkable(one) for one in get_args(kind))
        return None if None in each else each
    return checkable(origin)


def _named(kind: Any) -> str:
    return getattr(kind, "__name__", str(kind)) if isinstance(kind, type) else str(kind)
