"""The exceptions that Ravestate raises on purpose.

```text
RavestateError
├── DeclarationError(ValueError)      a designer's mistake, found before running
├── DeclarationErrors(ExceptionGroup) all such mistakes together
├── UsageError                        a user's mistake, e.g. an unknown module; commands end with exit code 2
├── RuleError(RuntimeError)           a rule failed or broke its declaration, or a value does not fit its slot
│   ├── UndeclaredError(LookupError)  a rule used an undeclared slot or signal, or other code used an unknown one
│   ├── RuleTimeout(TimeoutError)     a run took longer than the rule's ``timeout``
│   └── RunEnded                      a rule acted after its run was over
├── EngineError(RuntimeError)         a call that the context cannot accept now, or a failure of the engine
└── PlatformError(RuntimeError)       a failure of a device, a server or a file, or a missing package
```

Where possible, a message gives the refused value, the place in the code, the nearest valid name, and the code to write
instead.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence


class RavestateError(Exception):
    """The root of the tree: ``except rs.RavestateError`` catches every exception that Ravestate raises on purpose."""


class DeclarationError(RavestateError, ValueError):
    """The declaration of a module, signal, slot, rule or condition cannot work."""


class DeclarationErrors(RavestateError, ExceptionGroup[DeclarationError]):
    """All faults of a policy or its settings; ``.exceptions`` holds a `DeclarationError` for each fault."""

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
    """The user made a mistake, e.g. in a command's arguments or in an agent file. Commands end with exit code 2."""


class RuleError(RavestateError, RuntimeError):
    """A rule failed, returned an invalid value, or broke its declaration; or a written value does not fit its slot."""


class UndeclaredError(RuleError, LookupError):
    """A rule used a slot or a signal that its declaration does not name (law L3).

    Code outside the rules gets this error if it uses a slot or a signal that the policy does not have.
    """

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class RuleTimeout(RuleError, TimeoutError):
    """A rule ran for longer than its ``timeout`` (seconds)."""


class RunEnded(RuleError):
    """A rule acted after its run was over: it had returned, was interrupted or timed out, or the context had ended."""


class EngineError(RavestateError, RuntimeError):
    """A call does not fit the present state of a context or a simulation, or the engine itself has failed.

    A simulation also raises this error if rules trigger each other without end in one instant.
    """


class PlatformError(RavestateError, RuntimeError):
    """A device, a server or a file failed, or a package is not installed."""


def nearest(name: str, names: Iterable[str]) -> str:
    """Return the hint "; did you mean ...?" for a name that is not among `names`, or "" if no name is similar."""
    import difflib  # imported here because only an error needs it

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
    if ":" in name:  # the user may have written the right name with the wrong module
        last = name.rsplit(":", 1)[-1]
        for other in known:
            if other.rsplit(":", 1)[-1] == last:
                return f"; did you mean {other!r}?"
    return ""


ALIKE = 0.6
"""The minimum similarity of a name that `nearest` suggests: the share of letters that both names have in the same
order."""


def _is_a_slip(one: str, other: str) -> bool:
    """Return whether two names differ by one letter, or by two adjacent letters that changed places."""
    if min(len(one), len(other)) < 2:
        return False
    pairs = zip(one, other, strict=False)
    start = next((i for i, (a, b) in enumerate(pairs) if a != b), min(len(one), len(other)))
    rest, others = one[start:], other[start:]
    exchanged = rest[1::-1] + rest[2:]
    return others in (rest[1:], exchanged) or others[1:] in (rest, rest[1:])
