"""The rule that puts an intent into words. Here, an intent is a meaning that the agent wants to express."""

from __future__ import annotations

from functools import lru_cache
from importlib.resources import files
from pathlib import Path

import ravestate as rs
from ravestate.errors import RuleError
from ravestate.modules import rawio

from .intents import Intent
from .names import intent, last, module
from .phrases import PhraseBook

HERE = "ravestate.modules.meta.verbaliser"


@module.rule(when=intent.changed, writes=(rawio.output, last))
async def verbalise(ctx: rs.RuleContext) -> None:
    """Say a phrase for the intent. Among several phrases, avoid the one that was used the last time for this intent."""
    meant = as_intent(ctx.payload(intent.changed))
    settings = ctx.settings
    if meant.phrases is not None:
        book = PhraseBook({meant.name: meant.phrases}, language=settings.language)
    else:
        own = settings.phrases if meant.file is None else (meant.file, *settings.phrases)
        # The book is cached by these paths, and a relative path would depend on the working folder.
        here = tuple(path.expanduser().absolute() for path in own)
        book = phrase_book(meant.package, here, settings.language)
    phrase = book.choose(meant.name, meant.parameters, ctx.random, ctx[last].get(meant.name))
    ctx[rawio.output] = phrase.text
    ctx[last].add(meant.name, phrase.template)


def as_intent(value: object) -> Intent:
    """Return a value of the slot `intent` as an `Intent`. Refuse a value that is neither an `Intent` nor a name."""
    if isinstance(value, Intent):
        return value
    if isinstance(value, str) and value:
        return Intent(value)
    raise RuleError(
        f"verbaliser.intent was set to {value!r}: write the name of an intent, or "
        "verbaliser.Intent('greet', {'name': 'Ada'})"
    )


@lru_cache(maxsize=256)
def phrase_book(package: str | None, own: tuple[Path, ...], language: str) -> PhraseBook:
    """Return a book of the built-in phrases, the phrases of `package`, and the files `own` (absolute paths).

    For the same intent and language, the phrases of a later source in this list replace the phrases of earlier sources.
    All contexts of the process share the book. So the process does not notice later changes of the files.
    """
    packages = (HERE,) if package in (None, HERE) else (HERE, package)
    try:
        inside = [files(name) / "phrases.yaml" for name in packages]
    except ImportError as error:
        raise RuleError(f"verbaliser.Intent: there is no package {package!r}; write package=__package__") from error
    return PhraseBook.load([*inside, *own], language)
