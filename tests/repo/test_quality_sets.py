"""The sets that measure unseen sentences share none with examples, tests, or the training of networks."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from ravestate.language import plain
from ravestate.yaml_text import load_yaml
from repo.words import nodes

ROOT = Path(__file__).parents[2]
BLIND = ROOT / "tests" / "quality" / "blind"
_SITUATION = re.compile(r"\[[^\]]*\] ")
_MARK = re.compile(r"\[([^\[\]]*):[^\]]*\]")
"""A marked value: ``[Leeds:home]``."""
TRAINING = ROOT / "tools" / "networks"
LONGEST = 300


def _strings(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for inner in value.values():
            yield from _strings(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from _strings(inner)


def _sentences(file: Path) -> Iterator[str]:
    """Yield the sentences of a file of examples, a set, or a test."""
    text = file.read_text(encoding="utf-8")
    if file.suffix == ".tsv":
        for line in text.splitlines():
            if line.strip() and not line.startswith("#"):
                yield _SITUATION.sub("", line.partition("\t")[0])
    elif file.suffix == ".txt":
        for line in text.splitlines():
            if line.strip() and not line.startswith("#"):
                yield _MARK.sub(r"\1", _SITUATION.sub("", line))
    elif file.suffix == ".yaml":
        yield from _strings(load_yaml(text, file.name))
    else:
        for node in nodes(ast.parse(text)):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and len(node.value) < LONGEST:
                yield node.value


@pytest.fixture(scope="module")
def known() -> dict[str, Path]:
    """Return the plain form of every sentence outside the blind sets, with its file."""
    files = [*ROOT.glob("src/**/*.yaml"), *ROOT.glob("examples/**/*.yaml"), *ROOT.glob("tests/**/*.yaml")]
    files += [*ROOT.glob("tests/**/*.tsv"), *ROOT.glob("tests/**/*.py"), *ROOT.glob("src/**/*.py")]
    files += [*ROOT.glob("tests/quality/*.txt")]
    seen = (file for file in files if BLIND not in file.parents)
    found = {plain(sentence): file for file in seen for sentence in _sentences(file)}
    for file in ROOT.glob("src/**/bank/*.tsv"):
        for line in file.read_text(encoding="utf-8").splitlines():
            if line.strip() and not line.startswith("#"):
                found |= {plain(said): file for said in line.split("\t")[1].split("|")}
    return found


@pytest.mark.parametrize(
    ("name", "training"),
    [
        ("marked_rows.txt", "facts"),
        ("blind/facts.tsv", "facts"),
        ("answers_fresh_rows.tsv", "answers"),
        ("blind/answers.tsv", "answers"),
        ("kinds_fresh_rows.tsv", "kinds"),
        ("blind/kinds.tsv", "kinds"),
        ("responses_rows.tsv", "responses"),
    ],
)
def test_a_set_of_unseen_sentences_shares_none_with_the_training(name: str, training: str) -> None:
    learnt = {plain(text) for file in (TRAINING / training).rglob("*.t[sx][vt]") for text in _sentences(file)}
    shared = [text for text in _sentences(BLIND.parent / name) if plain(text) in learnt]
    assert len(shared) == 0, f"{len(shared)} of {name}"  # the message shows no sentence


def _asked(name: str) -> list[str]:
    file = BLIND / name
    if name == "followups.yaml":
        return [case["follow"] for case in load_yaml(file.read_text(encoding="utf-8"), name)["cases"]]
    if file.suffix == ".yaml":
        return [case["text"] for case in load_yaml(file.read_text(encoding="utf-8"), name)]
    return list(_sentences(file))


@pytest.mark.parametrize("name", sorted(file.name for file in BLIND.iterdir()))
def test_a_blind_set_shares_no_sentence_with_examples_other_sets_or_tests(name: str, known: dict[str, Path]) -> None:
    shared = Counter(known[form].name for form in map(plain, _asked(name)) if form in known)
    assert shared.total() == 0, f"{shared.total()} of {name}, also in {sorted(shared)}"  # the message shows no sentence


@pytest.mark.parametrize("name", sorted(file.name for file in BLIND.iterdir()))
def test_a_blind_set_has_at_least_a_hundred_different_sentences(name: str) -> None:
    sentences = [plain(sentence) for sentence in _asked(name)]
    count, different = len(sentences), len(set(sentences))
    assert count >= 100
    assert different == count or name == "followups.yaml"  # two conversations can have the same follow-up
