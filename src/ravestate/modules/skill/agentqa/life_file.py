"""A life in YAML files that users may edit. The module's own ``life.yaml`` shows the format."""

from __future__ import annotations

import re
import string
from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import date
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from ravestate.errors import nearest
from ravestate.language.examples import bundled
from ravestate.modules._yaml import fault, kind_of, read_text
from ravestate.yaml_text import compose_yaml

from .life import Fact, Life, Topic

if TYPE_CHECKING:
    import yaml

COUNTED = ("age", "mood", "time", "date", "memory")
"""Parameters of phrases that come from the clock or from slots."""
KNOWN = ("name", "born", *COUNTED)
"""Parameters that any phrase may have."""
NAMED = ("it", "that")
"""Parameters of phrases for a question that names a value."""

_PARTS = ("facts", "topics", "others")
_PARTS_OF_TOPIC = ("questions", "remarks", "acts", "phrases", "otherwise", "named", "unnamed")


def read_life(own: Path | None = None) -> Life:
    """Read the agent's life: the module's file, changed by the user's `own`.

    A fact of the own file replaces the module's, and ``~`` removes it. A topic adds its questions and remarks to the
    module's, and replaces the phrases; ``~`` removes it. Other topics are new.

    Raises:
        DeclarationError: The file has a mistake; the message names the line.
        PlatformError: The file cannot be read.
    """
    built_in = files("ravestate.modules.skill.agentqa") / "life.yaml"
    life = _parsed("life.yaml", built_in.read_text(encoding="utf-8"), None)
    if own is None:
        return life
    own = own.expanduser()
    return _parsed(str(own), read_text(own, "file"), life)


# -------------------------------------------------------------------------------------- one file


@lru_cache(maxsize=32)
def _parsed(name: str, text: str, base: Life | None) -> Life:
    root = compose_yaml(text, name)
    facts = dict(base.facts) if base else {}
    topics = dict(base.topics) if base else {}
    others = base.others if base else ()
    if root is None:
        return Life(facts, topics, others)
    parts = dict(_entries(name, root, _PARTS, "the file has facts, topics and others, and"))
    if (node := parts.get("facts")) is not None:
        for key, value in _entries(name, node, None, "facts have names: hobbies: [chess], and"):
            fact = _fact(name, key, value)
            facts.pop(key, None)
            if fact is not None:
                facts[key] = fact
        if "name" not in facts:
            raise fault(name, node, "the agent needs a name: write\nfacts:\n  name: Robin")
    if (node := parts.get("others")) is not None:
        others += _texts(name, node, "questions")
    if (node := parts.get("topics")) is not None:
        known = _Known(name, (*facts, *(base.facts if base else ()), *KNOWN))
        for key, value in _entries(name, node, None, "topics have names: shoes: {questions: ...}, and"):
            if _is_null(value):
                topics.pop(key, None)
            else:
                topics[key] = _topic(key, value, topics.get(key), known)
    return Life(facts, topics, others)


@dataclass(frozen=True, slots=True)
class _Known:
    """The facts that the phrases of a file may use."""

    file: str
    facts: tuple[str, ...]

    def check(self, node: yaml.Node, more: tuple[str, ...] = ()) -> tuple[str, ...]:
        """Return the phrases of a node, whose parameters are facts."""
        found = _texts(self.file, node, "phrases")
        known = (*self.facts, *more)
        items: list[yaml.Node] = node.value if kind_of(node) == "sequence" else [node]
        for item in items:
            try:
                parts = list(string.Formatter().parse(item.value))
            except ValueError as error:
                raise fault(
                    self.file, item, f"the braces in {item.value!r} name no fact ({error}): write {{hobbies}}"
                ) from None
            for _, parameter, form, conversion in parts:
                if parameter is not None and (parameter not in known or form or conversion):
                    raise fault(
                        self.file,
                        item,
                        f"{{{parameter}}} in {item.value!r} is not a fact{nearest(parameter, known)}; it would stand under "
                        f"facts:\n  {parameter or 'hobbies'}: ...",
                    )
        return found


def _topic(key: str, node: yaml.Node, before: Topic | None, known: _Known) -> Topic:
    parts = dict(_entries(known.file, node, _PARTS_OF_TOPIC, f"the topic {key} has questions and phrases, and"))
    topic = before or Topic(key, (), ())
    if "questions" in parts:
        topic = replace(topic, questions=(*topic.questions, *_texts(known.file, parts["questions"], "questions")))
    if "remarks" in parts:
        topic = replace(topic, remarks=(*topic.remarks, *_expressions(known.file, parts["remarks"], "remarks")))
    if "acts" in parts:
        topic = replace(topic, acts=(*topic.acts, *_acts(known.file, parts["acts"])))
    if "phrases" in parts:
        topic = replace(topic, phrases=known.check(parts["phrases"]), otherwise=(), named=(), unnamed=())
    if "otherwise" in parts:
        topic = replace(topic, otherwise=known.check(parts["otherwise"]))
    if "named" in parts:
        named: list[tuple[str, tuple[str, ...]]] = []
        for fact, phrases in _entries(known.file, parts["named"], known.facts, "it has a fact and phrases, and"):
            named.append((fact, known.check(phrases, NAMED)))
        topic = replace(topic, named=tuple(named))
    if "unnamed" in parts:
        topic = replace(topic, unnamed=known.check(parts["unnamed"]))
    for part, there in (
        ("questions", topic.questions or topic.remarks or topic.acts),
        ("phrases", topic.phrases),
    ):
        if not there:
            raise fault(known.file, node, f"the topic {key} has no {part}: write\n{key}:\n  {part}: [...]")
    return topic


def _expressions(file: str, node: yaml.Node, part: str) -> tuple[str, ...]:
    found = _texts(file, node, part)
    items: list[yaml.Node] = node.value if kind_of(node) == "sequence" else [node]
    for item, expression in zip(items, found, strict=True):
        try:
            re.compile(expression)
        except re.error as error:
            raise fault(
                file,
                item,
                f"{expression!r} is not a regular expression ({error}): write for example i am (so )?sad",
            ) from None
    return found


def _acts(file: str, node: yaml.Node) -> tuple[str, ...]:
    known = [*bundled("acts").classes, *bundled("feelings").classes]
    found = _texts(file, node, "acts")
    for act in found:
        if act not in known:
            raise fault(file, node, f"{act!r} is no act or feeling{nearest(act, known)}: {', '.join(known)}")
    return found


def _fact(name: str, key: str, node: yaml.Node) -> Fact | None:
    if key in COUNTED:
        instead = "born: 2024-03-01" if key == "age" else "another name"
        raise fault(name, node, f"{key} is computed, and cannot be written here: write {instead}")
    if _is_null(node):
        return None
    if key in ("name", "born") and kind_of(node) != "scalar":
        raise fault(name, node, f"{key} is one text, not a {kind_of(node)}")
    if kind_of(node) == "mapping":
        return tuple((other, _text(name, value)) for other, value in _entries(name, node, None, "it has pairs, and"))
    if kind_of(node) == "sequence":
        return _texts(name, node, "texts", empty=True)
    text = _text(name, node)
    if key == "born":
        try:
            date.fromisoformat(text)
        except ValueError:
            raise fault(name, node, f"born: {text!r} is not a date: write for example 2024-03-01") from None
    return text


# ------------------------------------------------------------------------------------------ YAML


def _is_null(node: yaml.Node) -> bool:
    return kind_of(node) == "scalar" and not getattr(node, "style", None) and node.value in ("", "~", "null")


def _entries(
    name: str, node: yaml.Node, allowed: tuple[str, ...] | None, meaning: str
) -> Iterator[tuple[str, yaml.Node]]:
    if kind_of(node) != "mapping":
        raise fault(name, node, f"{meaning} this is a {kind_of(node)}")
    seen: set[str] = set()
    for key, value in node.value:
        word = _text(name, key)
        if allowed is not None and word not in allowed:
            raise fault(name, key, f"{word!r} means nothing here{nearest(word, allowed)}: {', '.join(allowed[:12])}")
        if allowed is None and not word.replace(" ", "_").replace("-", "_").isidentifier():
            raise fault(name, key, f"{word!r} is not a name: letters, digits and _")
        if word in seen:
            raise fault(name, key, f"{word!r} is here a second time")
        seen.add(word)
        yield word, value


def _texts(name: str, node: yaml.Node, what: str, *, empty: bool = False) -> tuple[str, ...]:
    items: list[yaml.Node] = node.value if kind_of(node) == "sequence" else [node]
    if not items and not empty:
        raise fault(name, node, f"there are no {what}: write some, or leave it out")
    return tuple(_text(name, item) for item in items)


def _text(name: str, node: yaml.Node) -> str:
    if kind_of(node) != "scalar":
        raise fault(
            name,
            node,
            f"this must be a text, not a {kind_of(node)}; quote a text with :, or with braces in front",
        )
    text = str(node.value).strip()
    if not text or _is_null(node):
        raise fault(name, node, "this must be a text, and it is empty")
    return text
