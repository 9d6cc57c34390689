"""Every exception that Ravestate raises on purpose.

```text
RavestateError
├── DeclarationError(ValueError)     the designer's mistake, found before running
├── DeclarationErrors(ExceptionGroup) all of them at once, raised by ``rs.compile``
├── UsageError                       an agent is named wrongly: no such module, file or setting
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
    "UsageError",
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


class UsageError(RavestateError):
    """An agent is named wrongly: there is no such module, file or setting. Commands end with exit code 2."""


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

    def likeness(other: str) -> float:
        if _is_a_slip(name, other):
            return 3.0
        if len(name) > 2 and other.startswith(name):
            return 2.0
        return difflib.SequenceMatcher(None, other, name).ratio()

    best = max(known, key=likeness, default="")
    if known and likeness(best) >= ALIKE:
        return f"; did you mean {best!r}?"
    if ":" in name:  # the right name in the wrong module, or the other way round
        last = name.rsplit(":", 1)[-1]
        for other in known:
            if other.rsplit(":", 1)[-1] == last:
                return f"; did you mean {other!r}?"
    return ""


ALIKE = 0.6
"""The share of letters, in the same order, that two names of similar length have in common if one may be meant by the
other."""


def _is_a_slip(one: str, other: str) -> bool:
    """Whether one letter more, less or another, or two neighbours exchanged, make one name of the other."""
    if min(len(one), len(other)) < 2:
        return False
    pairs = zip(one, other, strict=False)
    start = next((i for i, (a, b) in enumerate(pairs) if a != b), min(len(one), len(other)))
    rest, others = one[start:], other[start:]
    exchanged = rest[1::-1] + rest[2:]
    return others in (rest[1:], exchanged) or others[1:] in (rest, rest[1:])
