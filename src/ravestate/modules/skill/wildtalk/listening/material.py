"""The authored phrases of the listening skill, read from its YAML files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from typing import Any

from ravestate.errors import DeclarationError
from ravestate.language.examples import bundled
from ravestate.language.matcher import Matcher
from ravestate.yaml_text import compose_yaml

from .bank import Bank, read_bank
from .moment import Line, Moment, roles_in
from .state import LASTING

PREFIX = "reply:"
"""The beginning of the name of a kind of reply, because other moments may have the same name."""
AGREEING = frozenset(("are", "were", "have", "do"))
MOMENTS = ("about_the_talk", "advice", "everyday", "grown", "young", "questions", "life", "reactions", "moments")
"""The files of moments (situations in a conversation). Each moment names the moves that its phrases suit."""
_NOT_GROUPS = frozenset(("examples", "nouns", "verbs", "tone", "lasts", "heads", "moves", "least", "after"))


@dataclass(frozen=True, slots=True)
class Row:
    """A row of the table of answers (order.yaml)."""

    needs: frozenset[str]
    without: frozenset[str]
    group: str
    lists: tuple[str, ...] = ()
    weak: bool = False


class Material:
    """All phrases, shared by all contexts. The matchers learn their examples when they are first used."""

    def __init__(self) -> None:
        self.feelings = _moments("feelings")
        self.acts = {**self.feelings, **_moments("acts")}
        files = {file: _moments(file) for file in MOMENTS}
        self.none = files["moments"].pop("none").examples
        """Sentences that belong to no moment."""
        self.moments = {name: one for file in MOMENTS for name, one in files[file].items()}
        none = (*self.none, *bundled("none").none)
        self.matchers = [
            Matcher({one.name: one.examples for one in moments.values()}, none, least=0.45)
            for moments in files.values()
        ]
        """One matcher per file, because several small matchers learn faster than one large matcher."""
        self.bank: Bank = read_bank()
        self.heads = {name: frozenset[str](words) for name, words in _read("heads").items()}
        self.replies = _moments("replies")
        self.responses = {name: replace(one, name=PREFIX + name) for name, one in _moments("responses").items()}
        self.asked, self.areas = _moments("asked"), _moments("areas")
        self.vague = self.asked.pop("vague").words
        """Nouns that name nothing, such as *thing*."""
        self.area_by_word = {word: one.name for one in reversed(self.areas.values()) for word in one.words}
        self.picks: Mapping[str, Sequence[str]] = _read("picks")
        self.plain = {**_moments("plain"), **self.replies}
        self.taking_up = _moments("taking_up")
        """Phrases with a gap for the highlight, questions, and remarks that take up a statement."""
        self.order = [_row(row) for row in _read("order")]
        self.shows: Mapping[str, Any] = _read("shows")
        self.tongues = {name: frozenset[str](words) for name, words in _read("tongues").items()}
        self.beings: Mapping[str, tuple[str, str]] = {
            noun: (kind, gender)
            for kind, genders in _read("beings").items()
            for gender, nouns in genders.items()
            for noun in nouns
        }
        self.living = frozenset(self.beings)


@cache
def material() -> Material:
    """Return the phrases."""
    return Material()


def _row(row: Mapping[str, str]) -> Row:
    tags, (group, *lists) = row["if"].split(), row["say"].split()
    without = frozenset(tag[1:] for tag in tags if tag.startswith("-"))
    return Row(frozenset(tag for tag in tags if tag[0] != "-"), without, group, tuple(lists), "weak" in row)


def _moments(name: str) -> dict[str, Moment]:
    found: dict[str, Moment] = {}
    for key, value in _read(name).items():
        groups = {group: _lines(lines, key) for group, lines in value.items() if group not in _NOT_GROUPS}
        lasts = int(value.get("lasts", LASTING))
        found[key] = Moment(
            key,
            groups,
            value.get("tone", ""),
            lasts,
            tuple(value.get("examples", ())),
            frozenset(value.get("nouns", ())),
            frozenset(value.get("verbs", ())),
            frozenset(value.get("moves", ())),
            value.get("after", ""),
            float(value.get("least", 0.0)),
            value.get("heads", ""),
        )
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
