"""Intents: signals that a designer defines by example sentences."""

from __future__ import annotations

import contextlib
import dataclasses
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, cast

import ravestate as rs
from ravestate.errors import DeclarationError, PlatformError, nearest
from ravestate.language.examples import NONE, bundled, parse_examples
from ravestate.language.matcher import Match, Matcher, whole
from ravestate.policy.policy import Policy
from ravestate.yaml_text import load_yaml

from . import names
from .analysis import Analysis

Intents = Mapping[str, tuple[str, ...]]
"""Qualified name of an intent's signal → the intent's examples."""

OF_ACT = 12
"""About this many examples of each act of the user, such as *greeting*, compete with the designer's intents."""

_RULE = "learn_intents"


def intent(module: rs.Module, name: str, *, examples: Sequence[str] | str | Path) -> rs.Signal[Match]:
    """Declare a signal for utterances that resemble `examples`; its payload is the `Match`.

    All intents of a context compete with one another, with the user's acts (``acts.yaml``), and with everyday
    sentences. Each sentence raises only the signal of its best match. Two or three examples are enough for a start.

    Args:
        module: The module of the signal, which must require ``nlp``.
        name: The name of the signal within the module.
        examples: Sentences; or the path of a YAML file, relative to the caller's file. The YAML file has a list of
            sentences, or a mapping from names of intents to such lists.

    Raises:
        DeclarationError: There are no examples, the file is missing or has another form, the name is taken or ``none``, or
            `module` lacks ``nlp``.

    Example:
        ::

            hours = nlp.intent(museum, "opening_hours", examples=["when do you open", "how late are you open"])

            @museum.rule(when=hours, writes=rawio.output)
            async def tell_hours(ctx):
                ctx[rawio.output] = "From ten to six."
    """
    # Paths are relative to the caller's file, and messages name the place of the call.
    caller = sys._getframe(1)  # pyright: ignore[reportPrivateUsage]
    origin = f"{caller.f_code.co_filename}:{caller.f_lineno}"
    where = f"nlp.intent({module.name}, {name!r}) ({origin})"
    if not _requires_nlp(module):
        raise DeclarationError(f"{where}: the module needs nlp: write rs.Module({module.name!r}, requires=[..., nlp])")
    if name == NONE:
        raise DeclarationError(f"{where}: {NONE!r} stands for sentences without an intent: choose another name")
    if f"{module.name}:{name}" in (signal.name for signal in module.signals):
        raise DeclarationError(f"{where}: module {module.name} has a signal {name!r} already: choose another name")
    texts = _sentences(examples, name, Path(caller.f_code.co_filename).parent, where)
    signal = module.signal(name, payload=Match)
    signal.origin = origin
    declared = _declared(module)
    declared[signal.name] = texts

    def heard(seen: Analysis | None) -> bool:
        return seen is not None and signal.name in seen.intents

    @module.rule(when=names.analysis.changed.where(heard), emits=signal, name=f"hear_{name}")
    async def hear(ctx: rs.RuleContext) -> None:
        """Raise the signal of the intent."""
        seen = ctx.payload(names.analysis.changed)
        assert seen is not None
        ctx.emit(signal, dataclasses.replace(seen.intents[signal.name], entities=seen.entities))

    return signal


def intents_of(policy: Policy) -> dict[str, tuple[str, ...]]:
    """Return the examples of all intents of a policy."""
    found: dict[str, tuple[str, ...]] = {}
    for rule in policy.rules.values():
        found |= getattr(rule.function, "declared", {})
    return found


def doubtful_examples(intents: Intents) -> Iterator[tuple[str, str, str]]:
    """Yield each example of an intent that equals or resembles an example of another intent.

    Each item is a tuple: the example, the name of its intent, and the name of the other intent. Without the sentence
    model, yield only examples that are the same word for word.
    """
    owners: dict[str, str] = {}
    for name, texts in intents.items():
        for text in texts:
            owner = owners.setdefault(whole(text), name)
            if owner != name:
                yield text, owner, name
    with contextlib.suppress(PlatformError):
        matcher = intent_matcher([intents])
        confusions = matcher.confusions() if matcher else []
        written = {whole(text): text for texts in intents.values() for text in texts}
        yield from ((written[text], own, other) for text, own, other in confusions if {own, other} <= intents.keys())


def intent_matcher(intents: Iterable[Intents]) -> Matcher | None:
    """Return the matcher of all `intents`; None if there are none. Contexts with the same intents share a matcher."""
    joined = tuple(item for some in intents for item in some.items())
    return _matcher(joined) if joined else None


@lru_cache(maxsize=32)
def _matcher(intents: tuple[tuple[str, tuple[str, ...]], ...]) -> Matcher:
    """Return a matcher of intents and acts. An act that shares an example with an intent does not compete at all.

    A designer writes few examples, but an act (such as *greeting*) has hundreds. If all examples competed, acts would
    always win. So only `OF_ACT` examples of each act compete.
    """
    taken = {whole(text) for _, texts in intents for text in texts}
    acts = bundled("acts")
    rivals = {
        name: texts[:: max(1, len(texts) // OF_ACT)]
        for name, texts in acts.classes.items()
        if taken.isdisjoint(map(whole, texts))
    }
    none = [text for text in (*bundled("everyday").none, *bundled("none").none) if whole(text) not in taken]
    return Matcher({**rivals, **dict(intents)}, none, centre=0.0)


def _requires_nlp(module: rs.Module) -> bool:
    return any(required is names.module or _requires_nlp(required) for required in module.requires)


def _declared(module: rs.Module) -> dict[str, tuple[str, ...]]:
    """Return the examples of the module's intents, so that the caller can add more.

    The first call for a module declares the rule that publishes the examples.
    """
    for rule in module.rules:
        if rule.name == f"{module.name}:{_RULE}":
            return cast("Any", rule.function).declared

    async def publish(ctx: rs.RuleContext) -> None:
        """Publish the examples of the module's intents."""
        ctx[names.intents].add(module.name, dict(declared))

    declared: dict[str, tuple[str, ...]] = {}
    cast("Any", publish).declared = declared
    # The rules of all modules write the same slot. Without detachment, they would exclude each other (law L10).
    module.rule(when=rs.startup.detached(), writes=names.intents, detached=True, background=True, name=_RULE)(publish)
    return declared


def _sentences(examples: Sequence[str] | str | Path, name: str, folder: Path, where: str) -> tuple[str, ...]:
    """Return the examples as a tuple. If `examples` is a path, read them from that file."""
    found: Any = examples
    source = where
    if isinstance(examples, (str, Path)):
        file = folder / examples
        source = f"{where}: {file}"
        try:
            found = load_yaml(file.read_text(encoding="utf-8"), str(file))
        except (OSError, UnicodeDecodeError) as error:
            raise DeclarationError(
                f"{where}: the file {str(file)!r} cannot be read ({error}): write the path relative to the Python file, or "
                'examples=["one sentence", "another one"]'
            ) from error
        except PlatformError as error:
            raise DeclarationError(f"{where}: {error}") from error
        if isinstance(found, Mapping):
            classes = parse_examples(cast("Any", found), source).classes
            if name not in classes:
                raise DeclarationError(
                    f"{source}: no examples of {name!r}{nearest(name, classes)}: write {name}: [a sentence, another one]"
                )
            return classes[name]
    if not found:
        raise DeclarationError(f"{source}: there are no examples: write two or more sentences that a user may say")
    texts = cast("Iterable[Any]", found) if isinstance(found, Sequence) else ()
    return parse_examples({name: list(texts)}, source).classes[name]
