"""Functions by which another part of the library observes a context."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ravestate.engine.effects import Ended


@dataclass(frozen=True, slots=True, kw_only=True)
class Hooks:
    """Functions that a context calls on its loop; `Context.start` takes them.

    Attributes:
        on_ended: Called with the outcome of each run that has ended.
        on_failed: Called with the name of each rule that fails, and with its exception.
        on_endless: Called with the rule that ran last, if an instant of virtual time does not end. If this function is
            given, the context's time is virtual. Plain functions then run one by one, so that threads do not race.
        listeners: Signal's name → a function that is called with the payload of every spike of the signal.
    """

    on_ended: Callable[[Ended], None] | None = None
    on_failed: Callable[[str, BaseException], None] | None = None
    on_endless: Callable[[str], None] | None = None
    listeners: Mapping[str, Callable[[Any], None]] = field(default_factory=dict[str, Callable[[Any], None]])
