"""Every exception that Ravestate raises on purpose.

```text
RavestateError
├── DeclarationError(ValueError)     the designer's mistake, found before running
├── DeclarationErrors(ExceptionGroup) all of them at once, raised by ``rs.compile``
├── RuleError(RuntimeError)          a rule did what it may not, or failed
│   ├── UndeclaredError(LookupError) it touched what its declaration does not name
│   ├── RuleTimeout(TimeoutError)    it took longer than its ``timeout``
│   └── RunEnded                     its run was over (interrupted, timed out) when it acted
├── EngineError(RuntimeError)        an event that the automaton cannot take in its state
└── PlatformError(RuntimeError)      the world failed: a device, a server, a file, a package
```

Every message gives the offending value, where it was declared, the nearest valid name, and the line
to write instead.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

__all__ = [
    "DeclarationError",
    "DeclarationErrors",
    "EngineError",
    "PlatformError",
    "RavestateError",
    "RuleError",
    "RuleTimeout",
    "RunEnded",
    "UndeclaredError",
    "nearest",
]


class RavestateError(Exception):
    """The root: ``except rs.RavestateError`` catches everything that Ravestate raises on purpose."""


class DeclarationError(RavestateError, ValueError):
    """A module, signal, slot, rule or condition is declared in a way that cannot work."""


class DeclarationErrors(RavestateError, ExceptionGroup[DeclarationError]):
    """Every fault that compiling found; each one is a `DeclarationError` in ``.exceptions``."""

    def __new__(cls, faults: Sequence[DeclarationError]) -> DeclarationErrors:
        return super().__new__(cls, _count(faults), faults)

    def __init__(self, faults: Sequence[DeclarationError]) -> None:
        super().__init__(_count(faults), faults)

    def derive(self, excs: Sequence[Exception]) -> ExceptionGroup[Exception]:  # type: ignore[override]  # typeshed has the wider type
        return DeclarationErrors([e for e in excs if isinstance(e, DeclarationError)])

    def __str__(self) -> str:
        return "\n".join([f"{self.message}:", *(f"  - {fault}" for fault in self.exceptions)])


def _count(faults: Sequence[DeclarationError]) -> str:
    return f"{len(faults)} fault" + ("s" if len(faults) != 1 else "") + " in the declarations"


class RuleError(RavestateError, RuntimeError):
    """A rule did something that it may not do, returned nonsense, or failed."""


class UndeclaredError(RuleError, LookupError):
    """A rule read, wrote or emitted something that its declaration does not name (L3)."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class RuleTimeout(RuleError, TimeoutError):
    """A rule ran for longer than its ``timeout`` (seconds)."""


class RunEnded(RuleError):
    """A run acted after its end: it had been interrupted, timed out, or the context was closed."""


class EngineError(RavestateError, RuntimeError):
    """The engine was given an event that its state does not allow: a fault of the shell around it."""


class PlatformError(RavestateError, RuntimeError):
    """Something outside failed: a device, a server, a file, or a package that is not installed."""


def nearest(name: str, names: Iterable[str]) -> str:
    """Word the hint "did you mean ...?" for a name that is not among `names`; empty if none is near."""
    import difflib  # only on the way to an error

    known = list(names)
    close = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    if not close and ":" in name:  # the right name in the wrong module, or the other way round
        last = name.rsplit(":", 1)[-1]
        close = [n for n in known if n.rsplit(":", 1)[-1] == last][:1]
    return f"; did you mean {close[0]!r}?" if close else ""
