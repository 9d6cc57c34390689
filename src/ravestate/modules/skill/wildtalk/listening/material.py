"""The authored phrases of the listening skill, read from its YAML files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

from ravestate.errors import DeclarationError
from ravestate.yaml_text import compose_yaml

from .phrases import Line, Phrases, roles_in

_NOT_GROUPS = frozenset(("nouns", "verbs", "tone"))


@dataclass(frozen=True, slots=True)
class Row:
    """A row of the table of answers (order.yaml)."""

    needs: frozenset[str]
    without: frozenset[str]
    group: str


class Material:
    """All phrases, shared by all contexts."""

    def __init__(self) -> None:
        self.responses = _phrases("responses")
        """Kind of reply → its replies."""
        self.asked, self.areas = _phrases("asked"), _phrases("areas")
        self.vague = self.asked.pop("vague").words
        """Nouns that name nothing in particular, such as *thing*."""
        self.area_by_word = {word: one.name for one in reversed(self.areas.values()) for word in one.words}
        self.picks: Mapping[str, Sequence[str]] = _read("picks")
        self.plain = _phrases("plain")
        self.order = [_row(row) for row in _read("order")]
        self.shows: Mapping[str, Any] = _read("shows")
        self.tongues = {name: frozenset[str](words) for name, words in _read("tongues").items()}


@cache
def material() -> Material:
    """Return the phrases."""
    return Material()


def _row(row: Mapping[str, str]) -> Row:
    tags = row["if"].split()
    without = frozenset(tag[1:] for tag in tags if tag.startswith("-"))
    return Row(frozenset(tag for tag in tags if tag[0] != "-"), without, row["say"])


def _phrases(name: str) -> dict[str, Phrases]:
    found: dict[str, Phrases] = {}
    for key, value in _read(name).items():
        groups = {group: _lines(lines, key) for group, lines in value.items() if group not in _NOT_GROUPS}
        words = frozenset((*value.get("nouns", ()), *value.get("verbs", ())))
        found[key] = Phrases(key, groups, value.get("tone", ""), words)
    return found


def _lines(listed: Any, key: str) -> tuple[Line, ...]:
    found: list[Line] = []
    for one in listed:
        value: Mapping[str, Any] = {"say": one} if isinstance(one, str) else one
        if "say" not in value:
            raise DeclarationError(f"listening: a phrase of {key!r} lacks its text: {value!r}")
        text = str(value["say"])
        then = {name: tuple(value[name]) for name in ("yes", "no", "unsure", "any") if name in value}
        roles = roles_in(" ".join((text, *(one for texts in then.values() for one in texts))))
        found.append(Line(text, roles, then, value.get("start", "")))
    return tuple(found)


def _read(name: str) -> Any:
    file = files(__package__ or "") / f"{name}.yaml"
    return _plain(compose_yaml(file.read_text(encoding="utf-8"), file.name))


def _plain(node: Any) -> Any:
    """Return the value of a YAML node. Every scalar is a text, even *yes* and *no*."""
    if node.id == "mapping":
        return {_plain(key): _plain(value) for key, value in node.value}
    return [_plain(one) for one in node.value] if node.id == "sequence" else node.value
