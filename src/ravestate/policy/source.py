"""Mistakes in the source of a rule's function: undeclared acts, names that do not exist, a forgotten ``await``, a slot
that the function replaces.

An act is a read, a write, an emit or the use of a payload. This file checks an act only if the function's globals or
closure lead to the slot or signal. All other acts are checked when the rule runs (law L3), e.g. an act on a name that
the function itself binds.

Guarded code, too, is checked only when the rule runs. Code is guarded if it is in a branch whose test uses a global
boolean, ``hasattr`` or a variable of an enclosing function. For other values of this variable, the enclosing function
may make rules with other declarations. If such a branch returns or raises, the code after it is guarded as well. So is
the body of a ``try`` that handles the error of a missing name.
"""

from __future__ import annotations

import ast
import contextlib
import inspect
import textwrap
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, field
from types import FunctionType, ModuleType
from typing import Any, cast

from ravestate.declare.module import Module
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Slot
from ravestate.declare.wording import spelt
from ravestate.errors import nearest
from ravestate.policy.model import RulePlan

OWNERS: tuple[type[Any], ...] = (ModuleType, Module, Slot)
"""Types whose attributes can be read without side effects, apart from a lazy import."""

Source = Callable[[Any], str]
"""A function that returns the source text of a function, such as ``inspect.getsource``."""


@dataclass(slots=True)
class Acts:
    """The acts in a rule's function whose slot or signal is known: slot or signal → the line of its first act."""

    reads: dict[Slot[Any], int] = field(default_factory=dict[Slot[Any], int])
    writes: dict[Slot[Any], int] = field(default_factory=dict[Slot[Any], int])
    emits: dict[Signal[Any], int] = field(default_factory=dict[Signal[Any], int])
    payloads: dict[Signal[Any], int] = field(default_factory=dict[Signal[Any], int])
    forgotten: dict[str, int] = field(default_factory=dict[str, int])
    """Method of the context that the function calls without ``await`` → the line of the call."""
    replaced: dict[str, int] = field(default_factory=dict[str, int])
    """Attribute that holds a slot, and that the function assigns → the line of the assignment."""
    unknown: dict[str, int] = field(default_factory=dict[str, int])
    """Phrase about a missing name, with the most similar existing name → the line of the missing name."""


def acts_of(rule: RulePlan, source: Source) -> Acts:
    """Return the acts of a rule's function; none if there is no source, or if another decorator wraps the function."""
    acts = Acts()
    function = rule.rule.function
    if not isinstance(function, FunctionType) or hasattr(function, "__wrapped__"):
        return acts
    tree = None
    with contextlib.suppress(OSError, TypeError, SyntaxError):
        tree = ast.parse(textwrap.dedent(source(function)))
    if tree is None or not tree.body or not isinstance(tree.body[0], (ast.FunctionDef, ast.AsyncFunctionDef)):
        return acts
    reader = _Reader(function, tree.body[0], acts.unknown)
    for node in sorted(
        _own(tree.body[0], reader.variables),
        key=lambda node: (getattr(node, "lineno", 0), getattr(node, "col_offset", 0)),
    ):
        reader.note(node, acts)
    return acts


def undeclared(rule: RulePlan, acts: Acts) -> Iterator[str]:
    """Yield a phrase for each kind of act that the rule does not declare, with the argument that would declare it.

    Yield also a phrase for each payload of a signal that is not in the rule's condition.
    """
    declared = rule.rule
    kinds: tuple[tuple[str, dict[Any, int], Iterable[Any], Iterable[Any]], ...] = (
        ("reads", acts.reads, declared.reads, (*declared.reads, *declared.writes, *acts.writes)),
        ("writes", acts.writes, declared.writes, declared.writes),
        ("emits", acts.emits, declared.emits, declared.emits),
    )
    home = rule.name.partition(":")[0]
    for what, found, own, allowed in kinds:
        known = set(allowed)
        new = {thing: line for thing, line in found.items() if thing not in known}
        if new:
            names = [spelt(thing.name, home) for thing in (*own, *new)]
            argument = names[0] if len(names) == 1 else f"({', '.join(names)})"
            places = ", ".join(f"{thing.name} (line {line})" for thing, line in new.items())
            yield f"{what} {places} without declaring it: declare {what}={argument}"
    heard = {need.signal.signal for clause in rule.clauses for need in clause.needs}
    for signal, line in acts.payloads.items():
        if signal not in heard:
            yield f"asks for the payload of {signal} (line {line}), which is not in its condition: write when=... | {spelt(signal.name, home)}"


class _Reader:
    """Finds the slots and signals that the names in one function stand for."""

    def __init__(
        self, function: FunctionType, tree: ast.FunctionDef | ast.AsyncFunctionDef, unknown: dict[str, int]
    ) -> None:
        arguments = [*tree.args.posonlyargs, *tree.args.args]
        self._first = function.__code__.co_firstlineno - 1
        self._names = dict(function.__globals__)
        for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True):
            with contextlib.suppress(ValueError):  # the variable of the enclosing function has no value yet
                self._names[name] = cell.cell_contents
        self._unknown = unknown
        self._known = {*self._names, *function.__builtins__, *function.__code__.co_freevars}
        self._context = arguments[0].arg if arguments else ""
        self.variables = {
            name
            for name in function.__code__.co_freevars
            if not isinstance(self._names.get(name), (Slot, Signal, ModuleType))
        }
        self.variables |= {
            name for name in function.__code__.co_names if name == "hasattr" or isinstance(self._names.get(name), bool)
        }
        """Names whose value may guard a branch: variables of enclosing functions, constants, and ``hasattr``."""
        for node in ast.walk(tree):
            for name in _bound(node):
                if name == self._context and node is not arguments[0]:
                    self._context = ""  # the function binds the name to another value
                self._names.pop(name, None)
                self._known.add(name)

    def note(self, node: ast.AST, acts: Acts) -> None:
        """Add the act at a node of the function to `acts`, if there is one."""
        match node:
            case ast.Subscript(value=ast.Name(id=self._context), slice=slot, ctx=ast.Load()):
                self._enter(slot, Slot, acts.reads)
            case ast.Subscript(value=ast.Name(id=self._context), slice=slot, ctx=ast.Store()):
                self._enter(slot, Slot, acts.writes)
            case ast.Call(
                func=ast.Attribute(
                    value=ast.Subscript(value=ast.Name(id=self._context), slice=slot), attr="add" | "remove"
                )
            ):
                if getattr(self._resolved(slot), "kind", "") == "collection":
                    self._enter(slot, Slot, acts.writes)
            case ast.Call(
                func=ast.Attribute(value=ast.Name(id=self._context), attr="emit" | "payload" as method),
                args=[signal, *_],
            ):
                self._enter(signal, Signal, acts.emits if method == "emit" else acts.payloads)
            case ast.Call(func=ast.Attribute(value=ast.Name(id=self._context), attr="wipe"), args=[signal, *_]):
                self._resolved(signal)
            case ast.Expr(
                value=ast.Call(func=ast.Attribute(value=ast.Name(id=self._context), attr="sleep" | "quiet" as method))
            ):
                acts.forgotten.setdefault(method, self._first + node.lineno)
            case ast.Attribute(value=owner, attr=name, ctx=ast.Store()):
                if isinstance(inspect.getattr_static(self._resolved(owner), name, None), Slot):
                    acts.replaced.setdefault(ast.unparse(node), self._first + node.lineno)
            case _:
                pass

    def _enter(self, expression: ast.expr, kind: type[Any], found: dict[Any, int]) -> None:
        thing = self._resolved(expression)
        if isinstance(thing, kind):
            found.setdefault(thing, self._first + expression.lineno)

    def _resolved(self, expression: ast.expr) -> object:
        match expression:
            case ast.Name(id=name):
                if name not in self._known:
                    self._miss(expression, nearest(name, self._names))
                return self._names.get(name)
            case ast.Attribute(value=inner, attr=name):
                owner = self._resolved(inner)
                if not isinstance(owner, OWNERS):
                    return inspect.getattr_static(owner, name, None)
                with contextlib.suppress(Exception):  # a lazy import may fail
                    try:
                        return getattr(owner, name)
                    except AttributeError as error:
                        if error.name in (None, name):  # any other name means that a lazy import has failed
                            self._miss(expression, nearest(name, (n for n in dir(owner) if n[0] != "_")))
                return None
            case _:
                return None

    def _miss(self, expression: ast.expr, hint: str) -> None:
        line = self._first + expression.lineno
        self._unknown.setdefault(f"{ast.unparse(expression)} (line {line}), which does not exist{hint}", line)


def _own(root: ast.AST, variables: Collection[str]) -> Iterator[ast.AST]:
    """Yield a node and all nodes inside it, except guarded code, such as a branch whose test uses one of
    `variables`."""
    stack = [root]
    while stack:
        node = stack.pop()
        yield node
        decided = _is_decided(node, variables) or _expects_missing_names(node)
        for name, value in ast.iter_fields(node):
            if decided and name in ("body", "orelse", "cases"):
                continue
            for inner in cast("list[object]", value if isinstance(value, list) else [value]):
                if isinstance(inner, ast.AST):
                    stack.append(inner)
                    ends = isinstance(inner, ast.If) and isinstance(inner.body[-1], (ast.Return, ast.Raise))
                    if ends and _is_decided(inner, variables):
                        break  # this branch leaves the function, so the code after it is guarded, too


def _is_decided(node: ast.AST, variables: Collection[str]) -> bool:
    test = getattr(node, "subject" if isinstance(node, ast.Match) else "test", None)
    return isinstance(test, ast.AST) and any(
        isinstance(part, ast.Name) and part.id in variables for part in ast.walk(test)
    )


def _expects_missing_names(node: ast.AST) -> bool:
    return isinstance(node, ast.Try) and any(
        isinstance(part, ast.Name) and part.id in ("AttributeError", "NameError", "KeyError", "LookupError")
        for handler in node.handlers
        if handler.type is not None
        for part in ast.walk(handler.type)
    )


def _bound(node: ast.AST) -> Iterator[str]:
    """Yield the names that a node of a function's syntax tree binds."""
    match node:
        case ast.Name(id=name, ctx=ast.Store() | ast.Del()) | ast.arg(arg=name) | ast.MatchMapping(rest=str(name)):
            yield name
        case ast.alias(name=name, asname=other):
            yield other or name.partition(".")[0]
        case _:  # functions, classes, handlers and patterns
            name = getattr(node, "name", None)
            if isinstance(name, str):
                yield name
