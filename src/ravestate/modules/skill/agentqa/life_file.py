"""Read the agent's life, its facts and topics, from YAML files. The module's own ``life.yaml`` shows the format."""

from __future__ import annotations

import re
import string
from collections.abc import Iterator
from dataclasses import replace
from datetime import date
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from ravestate.errors import DeclarationError, nearest
from ravestate.language.examples import bundled
from ravestate.modules._yaml import fault, kind_of, read_text
from ravestate.yaml_text import compose_yaml

from .life import Fact, Life, Topic, whole_words

if TYPE_CHECKING:
    import yaml

COUNTED = ("age", "mood", "time", "date", "memory")
"""Parameters of phrases whose values come from the clock or from slots, not from the file."""
KNOWN = ("name", "born", *COUNTED)
"""Parameters that any phrase may have, besides the facts of the file."""
NAMED = ("it", "that")
"""Parameters of the phrases under ``named``: answers to a question that names a value of a fact."""

_PARTS = ("facts", "topics", "others")
_ADDED = ("questions", "remarks", "acts")
"""Parts of a topic to which a designer's file adds."""
_TOLD = ("phrases", "otherwise", "unnamed")
"""Parts of a topic that a designer's file replaces."""


def read_life(own: Path | None = None) -> Life:
    """Read the agent's life from the module's file, with the changes in the designer's file `own`.

    A fact in the designer's file replaces the module's fact; the value ``~`` removes the fact. A topic of the same name
    adds questions, remarks and acts to the module's topic; the value ``~`` removes the topic. Its ``phrases`` replace all
    answers of the module's topic. Topics with other names are new, and questions in ``others`` are added.

    Raises:
        DeclarationError: The designer's file has a mistake; the message names the line.
        PlatformError: The designer's file cannot be read.
    """
    built_in = files("ravestate.modules.skill.agentqa") / "life.yaml"
    life = _parsed("life.yaml", built_in.read_text(encoding="utf-8"), None)
    if own is None:
        return life
    own = own.expanduser()
    return _parsed(str(own), read_text(own, "file"), life)


@lru_cache(maxsize=32)
def _parsed(name: str, text: str, base: Life | None) -> Life:
    root = compose_yaml(text, name)
    life = base or Life({}, {})
    return life if root is None else _Reader(name).life(root, life)


class _Reader:
    """A reader of one file. Its messages about mistakes name the file."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._known: tuple[str, ...] = KNOWN
        """The facts that phrases may use."""

    def life(self, root: yaml.Node, base: Life) -> Life:
        """Return the life `base` with the changes of the file."""
        facts, topics, others = dict(base.facts), dict(base.topics), base.others
        parts = dict(self._entries(root, _PARTS, "the file has facts, topics and others, but"))
        if "facts" in parts:
            for key, value in self._entries(parts["facts"], None, "facts have names: hobbies: [chess], but"):
                fact = self._fact(key, value)
                facts.pop(key, None)
                if fact is not None:
                    facts[key] = fact
            if "name" not in facts:
                raise self._fault(parts["facts"], "the agent needs a name: write\nfacts:\n  name: Robin")
        if "others" in parts:
            others += self._texts(parts["others"], "questions")
        if "topics" in parts:
            self._known = (*facts, *base.facts, *KNOWN)
            meaning = "topics have names: shoes: {questions: ...}, but"
            for key, value in self._entries(parts["topics"], None, meaning):
                before = topics.pop(key, None) if _is_null(value) else topics.get(key)
                if not _is_null(value):
                    topics[key] = self._topic(key, value, before or Topic(key, (), ()))
        return Life(facts, topics, others)

    def _fact(self, key: str, node: yaml.Node) -> Fact | None:
        if key in COUNTED:
            instead = "born: 2024-03-01" if key == "age" else "another name"
            raise self._fault(node, f"{key} is computed, and cannot be written here: write {instead}")
        if _is_null(node):
            return None
        if key in ("name", "born") and kind_of(node) != "scalar":
            raise self._fault(node, f"{key} is one text, not a {kind_of(node)}")
        if kind_of(node) == "mapping":
            return tuple((other, self._text(value)) for other, value in self._entries(node, None, "it has pairs, but"))
        if kind_of(node) == "sequence":
            return self._texts(node, "texts", empty=True)
        text = self._text(node)
        if key == "born":
            try:
                date.fromisoformat(text)
            except ValueError:
                raise self._fault(node, f"born: {text!r} is not a date: write for example 2024-03-01") from None
        return text

    def _topic(self, key: str, node: yaml.Node, topic: Topic) -> Topic:
        meaning = f"the topic {key} has questions and phrases, but"
        parts = dict(self._entries(node, (*_ADDED, *_TOLD, "named"), meaning))
        added = {part: (*getattr(topic, part), *self._texts(parts[part], part)) for part in _ADDED if part in parts}
        if "phrases" in parts:
            topic = replace(topic, otherwise=(), named=(), unnamed=())
        told = {part: self._phrases(parts[part]) for part in _TOLD if part in parts}
        topic = replace(topic, **added, **told)
        if "named" in parts:
            entries = self._entries(parts["named"], self._known, "it has a fact and phrases, but")
            topic = replace(topic, named=tuple((fact, self._phrases(phrases, NAMED)) for fact, phrases in entries))
        heard = topic.questions or topic.remarks or topic.acts
        if not heard or not topic.phrases:
            part = "phrases" if heard else "questions"
            raise self._fault(node, f"the topic {key} has no {part}: write\n{key}:\n  {part}: [...]")
        return topic

    def _phrases(self, node: yaml.Node, more: tuple[str, ...] = ()) -> tuple[str, ...]:
        """Return the phrases of a node. Each parameter of a phrase must be a fact or one of `more`."""
        known = (*self._known, *more)
        for item in _items(node):
            try:
                parts = list(string.Formatter().parse(item.value)) if kind_of(item) == "scalar" else []
            except ValueError as error:
                problem = f"the braces in {item.value!r} name no fact ({error}): write {{hobbies}}"
                raise self._fault(item, problem) from None
            for _, parameter, form, conversion in parts:
                if parameter is not None and (parameter not in known or form or conversion):
                    problem = f"{{{parameter}}} in {item.value!r} is not a fact{nearest(parameter, known)}"
                    raise self._fault(item, f"{problem}; to add it, write\nfacts:\n  {parameter or 'hobbies'}: ...")
        return self._texts(node, "phrases")

    def _texts(self, node: yaml.Node, part: str, *, empty: bool = False) -> tuple[str, ...]:
        if not _items(node) and not empty:
            raise self._fault(node, f"there are no {part}: write some, or leave it out")
        return tuple(self._checked(item, part) for item in _items(node))

    def _checked(self, node: yaml.Node, part: str) -> str:
        """Return a text; a remark must be a regular expression, and an act must be known."""
        text = self._text(node)
        if part == "remarks":
            try:
                whole_words(text)
            except re.error as error:
                problem = f"{text!r} is not a regular expression ({error}): write for example i am (so )?sad"
                raise self._fault(node, problem) from None
        elif part == "acts" and text not in (known := [*bundled("acts").classes, *bundled("feelings").classes]):
            raise self._fault(node, f"{text!r} is not an act or a feeling{nearest(text, known)}: {', '.join(known)}")
        return text

    def _entries(
        self, node: yaml.Node, allowed: tuple[str, ...] | None, meaning: str
    ) -> Iterator[tuple[str, yaml.Node]]:
        if kind_of(node) != "mapping":
            raise self._fault(node, f"{meaning} this is a {kind_of(node)}")
        for key, value in node.value:
            word = self._text(key)
            if allowed is not None and word not in allowed:
                raise self._fault(
                    key, f"{word!r} means nothing here{nearest(word, allowed)}: {', '.join(allowed[:12])}"
                )
            if allowed is None and not word.replace(" ", "_").replace("-", "_").isidentifier():
                raise self._fault(key, f"{word!r} is not a name: letters, digits and _")
            yield word, value

    def _text(self, node: yaml.Node) -> str:
        if kind_of(node) != "scalar":
            problem = (
                f"this must be a text, not a {kind_of(node)}; quote a text that has a colon or begins with a brace"
            )
            raise self._fault(node, problem)
        text = str(node.value).strip()
        if not text or _is_null(node):
            raise self._fault(node, "this must be a text, but it is empty")
        return text

    def _fault(self, node: yaml.Node, problem: str) -> DeclarationError:
        return fault(self._file, node, problem)


def _is_null(node: yaml.Node) -> bool:
    return kind_of(node) == "scalar" and not getattr(node, "style", None) and node.value in ("", "~", "null")


def _items(node: yaml.Node) -> list[yaml.Node]:
    return node.value if kind_of(node) == "sequence" else [node]
