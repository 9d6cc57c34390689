"""How an intent becomes an utterance."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import ravestate as rs
from ravestate.modules import rawio

from . import Settings, intent, last, module
from .intent import Intent
from .phrases import PhraseBook

HERE = "ravestate.modules.meta.verbaliser"


@module.rule(when=intent.changed, writes=(rawio.output, last))
async def word(ctx: rs.RuleContext) -> rs.Resign | None:
    """Choose a phrase, never the same twice running, and say it."""
    meant = ctx.payload(intent.changed)
    if not meant:
        return rs.Resign("nothing is meant")
    if isinstance(meant, str):
        meant = Intent(meant)
    settings: Settings = ctx.settings
    own = () if meant.phrases is None else (meant.phrases,)
    book = _book((*own, *settings.files), settings.language)
    phrase = book.choose(meant.name, meant.parameters, ctx.random, ctx[last].get(meant.name))
    ctx[last] = {**ctx[last], meant.name: phrase.template}
    ctx[rawio.output] = phrase.text
    return None


@lru_cache(maxsize=256)
def _book(files: tuple[Path, ...], language: str) -> PhraseBook:
    """Books are read once per process: contexts share them, and never change them."""
    return PhraseBook.load(files, language)
