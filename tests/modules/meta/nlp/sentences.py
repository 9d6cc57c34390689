"""Sentences for the tests: in tables beside them, or as trees that are written by hand."""

from pathlib import Path

from ravestate.modules.meta.nlp.tree import Word


def table(name: str) -> list[tuple[str, str]]:
    """The rows of ``<name>.tsv``."""
    lines = (Path(__file__).parent / f"{name}.tsv").read_text(encoding="utf-8").splitlines()
    return [(sentence, expected) for sentence, _, expected in (line.partition("\t") for line in lines)]


def words(notation: str) -> list[Word]:
    """Words without a pipeline: ``my/PRON/poss>1 name/NOUN:NN/nsubj>2``."""
    found: list[Word] = []
    start = 0
    for index, item in enumerate(notation.split()):
        text, pos, relation = item.rsplit("/", 2)
        pos, _, tag = pos.partition(":")
        dep, _, head = relation.partition(">")
        found.append(Word(index, text, text.lower(), pos, tag, dep, int(head), start))
        start += len(text) + 1
    return found
