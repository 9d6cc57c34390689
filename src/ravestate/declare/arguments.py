"""Checks of the arguments of a declaration. The error messages say what to write instead."""

from __future__ import annotations

import contextlib
import inspect
from collections.abc import Callable
from functools import wraps
from typing import Any, ParamSpec, TypeVar, cast

from ravestate.declare.condition import Condition
from ravestate.declare.rule import Rule
from ravestate.declare.settings import Number, SettingRef, type_of_number
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Slot
from ravestate.declare.wording import place_of_call, spelt
from ravestate.errors import DeclarationError, nearest

T = TypeVar("T")
P = ParamSpec("P")
R = TypeVar("R")


def keywords(*options: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Return a decorator that makes a method refuse an unknown keyword; the message suggests a similar known one.

    `options` are keywords that the method accepts in addition to those in its signature.
    """

    def decorate(method: Callable[P, R]) -> Callable[P, R]:
        code = method.__code__
        known = (*code.co_varnames[1 : code.co_argcount + code.co_kwonlyargcount], *options)

        @wraps(method)
        def checked(*args: P.args, **kwargs: P.kwargs) -> R:
            for keyword in kwargs:
                if keyword not in known:
                    owner = getattr(args[0], "name", None)
                    what = f"{owner}.{method.__name__}" if owner else "rs.Module"
                    raise DeclarationError(
                        f"{what} ({place_of_call()}) has no argument {keyword!r}{nearest(keyword, known)}"
                    )
            return method(*args, **kwargs)

        return checked

    return decorate


def check_name(name: object, what: str) -> None:
    """Refuse an invalid `name`; the message begins with `what`, such as ``Module``."""
    if not isinstance(name, str) or not name.replace("-", "_").isidentifier():
        raise DeclarationError(
            f"{what}: {name!r} is not a name: use letters, digits, '_' and '-', beginning with a letter"
        )


def check_options(keep: object = "all", limit: object = 1, *, what: str) -> None:
    """Refuse invalid values of the options `keep` and `limit`; the message begins with `what`, the declared name."""
    if keep not in ("all", "latest"):
        raise DeclarationError(f"{what}: keep={keep!r}: write keep='all' or keep='latest'")
    if not isinstance(limit, int) or limit < 1:
        raise DeclarationError(f"{what}: limit={limit!r}: write a whole number of at least 1")


def check_function(function: object, title: str, *, named: bool, where: str, decorator: str) -> None:
    """Refuse a value that cannot be a rule's function.

    `title` is the rule's name, and `named` says whether it comes from ``name=``. The messages use `where`, the place of
    the declaration, and `decorator`, the decorator as the user types it.
    """
    if isinstance(function, Rule):
        raise DeclarationError(
            f"{function.name} ({function.origin}) is a rule already: combine both conditions with |, or write "
            "a second function"
        )
    if not callable(function):
        raise DeclarationError(f"{decorator} must decorate a function, not {function!r}")
    if not named and not title.isidentifier():  # a lambda, a partial or a callable object
        raise DeclarationError(f"{where} has no name of its own: write name='...'")
    check_name(title, where)
    if inspect.isgeneratorfunction(function) or inspect.isasyncgenfunction(function):
        raise DeclarationError(
            f"{where} is a generator, but a rule returns only once: use ctx[slot] = value instead of yield"
        )
    # If another decorator wraps the function, the engine calls the wrapper. So the wrapper's signature counts, not the
    # wrapped function's.
    try:
        signature = inspect.signature(function, follow_wrapped=False)
    except Exception:  # a function of C has no signature; Python 3.14 may fail to evaluate an annotation
        return
    try:
        signature.bind(None)
    except TypeError:
        raise DeclarationError(f"{where} gets one argument, the context: write def {title}(ctx)") from None


def condition(value: object, what: str, where: str, home: str) -> Condition:
    """Return `value` if it is a condition; refuse any other value.

    The message uses `what`, the argument's name, and `where`, the place of the declaration. In the code that it
    suggests, a slot of the module `home` appears without that module's prefix.
    """
    if isinstance(value, Slot):
        slot = cast("Slot[Any]", value)
        raise DeclarationError(f"{where}: {what}={slot!r} is a slot: write {what}={spelt(slot.name, home)}.changed")
    if not isinstance(value, Condition):
        raise DeclarationError(f"{where}: {what}={value!r} is not a condition: combine signals with & and |")
    return value


def number(value: object, what: str, where: str) -> Number:
    """Return a number as a float, or a setting unchanged; refuse any other value."""
    if isinstance(value, bool) or not isinstance(value, type_of_number):
        raise DeclarationError(f"{where}: {what}={value!r} is not a number; write {what}=1.0 or a setting")
    return value if isinstance(value, SettingRef) else float(value)


def several(values: Any, kind: type[T], what: str, where: str, home: str) -> tuple[T, ...]:
    """Return slots or signals as a tuple without duplicates; refuse values of another `kind`.

    `values` is one slot or signal, or an iterable of them, which may be empty. `what`, `where` and `home` are as for
    `condition`.
    """
    if isinstance(values, kind):
        return (values,)
    found: tuple[Any, ...] = (values,)
    if not isinstance(values, str):
        with contextlib.suppress(TypeError):
            found = tuple(values)
    for value in found:
        if not isinstance(value, kind):
            hint = ""
            if isinstance(value, Signal):
                hint = ": `reads` and `writes` take slots, `emits` takes signals"
            elif isinstance(value, Slot):
                name = cast("Slot[Any]", value).name
                hint = f": a rule that writes a slot raises its signals; use writes={spelt(name, home)}"
            raise DeclarationError(f"{where}: {what}={value!r} is not a {kind.__name__.lower()}{hint}")
    return tuple(dict.fromkeys(found))
