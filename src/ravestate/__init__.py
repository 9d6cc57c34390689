"""Ravestate: interactive agents as Signal-Rule-Slot automata.

Declare modules of rules in plain Python. Run them as an agent, talk to the agent, or test it in virtual time.
Importing this package loads neither third-party packages nor asyncio. A name that needs these, such as ``rs.Context``,
loads them on first use.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

from ravestate.declare.condition import Condition, Constraint
from ravestate.declare.core import RuleFailure, activity, error, pressure, shutdown, startup
from ravestate.declare.module import Module
from ravestate.declare.outcome import Resign, Retire
from ravestate.declare.rule import Rule
from ravestate.declare.settings import setting
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Collection, Entry, Flag, Slot
from ravestate.errors import (
    DeclarationError,
    DeclarationErrors,
    EngineError,
    PlatformError,
    RavestateError,
    RuleError,
    RuleTimeout,
    RunEnded,
    UndeclaredError,
)

if TYPE_CHECKING:
    from ravestate.policy.compile import compile_policy as compile
    from ravestate.policy.model import ClauseView
    from ravestate.policy.policy import Policy
    from ravestate.runtime.context import Context
    from ravestate.runtime.rule_context import RuleContext
    from ravestate.runtime.run import run
    from ravestate.settings import Settings

__all__ = [
    "ClauseView", "Collection", "Condition", "Constraint", "Context", "DeclarationError", "DeclarationErrors",
    "EngineError", "Entry", "Flag", "Module", "PlatformError", "Policy", "RavestateError", "Resign", "Retire", "Rule",
    "RuleContext", "RuleError", "RuleFailure", "RuleTimeout", "RunEnded", "Settings", "Signal", "Slot",
    "UndeclaredError", "activity", "compile", "error", "pressure", "run", "setting", "shutdown", "startup",
]  # fmt: skip

__version__ = "1.0.0.dev0"

_LATER = {
    "ClauseView": ("ravestate.policy.model", "ClauseView"),
    "Context": ("ravestate.runtime.context", "Context"),
    "Policy": ("ravestate.policy.policy", "Policy"),
    "RuleContext": ("ravestate.runtime.rule_context", "RuleContext"),
    "Settings": ("ravestate.settings", "Settings"),
    "compile": ("ravestate.policy.compile", "compile_policy"),
    "run": ("ravestate.runtime.run", "run"),
}
"""Name → the Python module that defines it, and its name there. The module loads when the name is first used."""


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"ravestate has no {name!r}{_hint(name)}", name=name)
    from importlib import import_module

    module, attribute = _LATER[name]
    value = globals()[name] = getattr(import_module(module), attribute)
    return value


@lru_cache(maxsize=64)  # tools look up the same missing names again and again
def _hint(name: str) -> str:
    from ravestate.errors import nearest

    return nearest(name, __all__)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
