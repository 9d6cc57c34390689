"""Tables of sentences beside the tests: a sentence, a tab, what is to be seen in it."""

from pathlib import Path


def table(name: str) -> list[tuple[str, str]]:
    """The rows of ``<name>.tsv``."""
    lines = (Path(__file__).parent / f"{name}.tsv").read_text(encoding="utf-8").splitlines()
    return [(sentence, expected) for sentence, _, expected in (line.partition("\t") for line in lines)]
