"""Phrases by intent and language, from YAML files. An intent is a meaning that the agent wants to express.

A file maps each intent to its languages, and each language to phrases. Parameters are in braces:

```yaml
greet:
  en:
    - Hello!
    - Hello {name}, good to see you.
  de: [Hallo!, "Schön, dich zu sehen, {name}."]
farewell: Goodbye!           # without a language: the default language
```

Several files make one phrase book. For the same intent and language, the phrases of a later file *replace* the phrases
of earlier files. With ``!add``, the phrases of the later file are added to them:

```yaml
greet:
  en: !add [Ahoy!]
```

Every value is text: ``no`` is the Norwegian language, and ``1`` is a phrase. ``{{`` and ``}}`` stand for single braces.
"""

from __future__ import annotations

import random
import string
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.resources.abc import Traversable
from pathlib import Path

import yaml

from ravestate.errors import DeclarationError, RuleError, nearest
from ravestate.modules._yaml import fault, kind_of, read_nodes

Source = Path | Traversable | str


@dataclass(frozen=True, slots=True)
class Template:
    """A phrase with parameters in braces, and the names of the parameters."""

    text: str
    parameters: frozenset[str]


@dataclass(frozen=True, slots=True)
class Phrase:
    """A phrase with values in place of its parameters, and the text of its template."""

    text: str
    template: str


class PhraseBook:
    """A collection of phrases by intent and language.

    Example:
        >>> book = PhraseBook({"greet": {"en": ["Hello {name}!"]}}, language="en-GB")
        >>> book.choose("greet", {"name": "Ada"}, random.Random(1)).text
        'Hello Ada!'
    """

    def __init__(
        self, phrases: Mapping[str, Mapping[str, Sequence[str]]], *, language: str = "en", default_language: str = "en"
    ) -> None:
        """Make a book from texts: intent → language → texts.

        Args:
            phrases: The texts.
            language: The language to speak. If ``de-AT`` has no phrase, ``de`` is next, then the default language.
            default_language: The language for intents without phrases in `language`.

        Raises:
            DeclarationError: The braces in a phrase do not contain a name.
        """
        self.language = _tag(language)
        self.default_language = _tag(default_language)
        self._phrases: dict[str, dict[str, tuple[Template, ...]]] = {
            intent: {_tag(tag): tuple(map(_template, texts)) for tag, texts in languages.items()}
            for intent, languages in phrases.items()
        }

    @classmethod
    def load(cls, sources: Iterable[Source], language: str = "en", *, default_language: str = "en") -> PhraseBook:
        """Return a book of the phrases in YAML files, read in the given order. The module's docstring shows the format.

        Phrases without a language in the files are in the default language.

        Raises:
            DeclarationError: A file is invalid; the message names file and line.
            PlatformError: A file is missing or cannot be read.
        """
        book = cls({}, language=language, default_language=default_language)
        for source in sources:
            file = Path(source).expanduser() if isinstance(source, str) else source
            book._merge(str(source), read_nodes(file, "file of phrases"))
        return book

    @property
    def intents(self) -> tuple[str, ...]:
        """All intents, in the order of the files."""
        return tuple(self._phrases)

    @property
    def languages(self) -> tuple[str, ...]:
        """All languages in which any intent has phrases, sorted."""
        return tuple(sorted({tag for languages in self._phrases.values() for tag in languages}))

    def templates(self, intent: str, language: str | None = None) -> tuple[Template, ...]:
        """Return the phrases for `intent` in `language`, by default the language of the book.

        If there are none, return the phrases in the first fallback language that has some.

        Raises:
            RuleError: There is no such intent, or none of these languages has a phrase for it.
        """
        languages = self._phrases.get(intent)
        if languages is None:
            known = ", ".join(self._phrases) or "none"
            raise RuleError(
                f"there are no phrases for the intent {intent!r}{nearest(intent, self._phrases)} "
                f"(known: {known}). To add it, write in your phrases file:\n{intent}:\n"
                f"  {self.language}: [...]"
            )
        tried = list(_fallbacks(_tag(language) if language else self.language, self.default_language))
        for tag in tried:
            if found := languages.get(tag):
                return found
        raise RuleError(
            f"the intent {intent!r} has no phrases in {' or '.join(tried)}, only in "
            f"{', '.join(languages) or 'no language'}. To add them, write in your phrases file:\n{intent}:\n"
            f"  {tried[0]}: [...]"
        )

    def choose(
        self,
        intent: str,
        parameters: Mapping[str, object],
        rng: random.Random,
        last: str | None = None,
        *,
        language: str | None = None,
    ) -> Phrase:
        """Choose a phrase at random, and fill in its parameters.

        A phrase is eligible if all its parameters have values; None counts as missing. If a phrase begins with a
        parameter, its first word gets a capital letter, unless the word has one already, like *eBay*. The template
        `last`, which was used the last time, is not chosen again if another template is eligible.

        Raises:
            RuleError: There is no such intent or language, or each phrase needs a parameter without a value.
        """
        templates = self.templates(intent, language)
        given = {name: value for name, value in parameters.items() if value is not None}
        eligible = [template for template in templates if template.parameters <= given.keys()]
        if not eligible:
            needed = min((template.parameters - given.keys() for template in templates), key=len)
            known = {name for template in templates for name in template.parameters}
            hints = "".join(nearest(name, sorted(needed)) for name in sorted(given.keys() - known))
            raise RuleError(
                f"each phrase for the intent {intent!r} lacks a parameter; give {', '.join(sorted(needed))} "
                f"(given: {', '.join(given) or 'none'}{hints}), or add a phrase that needs none"
            )
        fresh = [template for template in eligible if template.text != last] or eligible
        chosen = rng.choice(fresh)
        values = {name: str(given[name]) for name in chosen.parameters}
        return Phrase(_begun(chosen.text, chosen.text.format_map(values)), chosen.text)

    def _merge(self, name: str, root: yaml.Node | None) -> None:
        if root is None:
            return
        for key, languages in _entries(name, root, "a file of phrases maps intents to languages"):
            intent = self._phrases.setdefault(_text_of(name, key, "an intent is a text"), {})
            if kind_of(languages) != "mapping":  # without a language: the default language
                self._put(name, intent, self.default_language, languages)
                continue
            for tag, phrases in _entries(name, languages, "an intent maps languages to phrases"):
                self._put(name, intent, _tag(_text_of(name, tag, "a language is a text")), phrases)

    def _put(self, name: str, intent: dict[str, tuple[Template, ...]], tag: str, node: yaml.Node) -> None:
        added = _added(name, node)
        items: list[yaml.Node] = node.value if kind_of(node) == "sequence" else [node]
        templates: list[Template] = []
        for item in items:
            text = _text_of(name, item, "a phrase is a text").strip()
            if not text:
                raise fault(name, item, "a phrase is empty")
            try:
                templates.append(_template(text))
            except DeclarationError as error:
                raise fault(name, item, str(error)) from None
        if not templates:
            raise fault(name, node, "there are no phrases: write some, or remove the language")
        before = intent.get(tag, ()) if added else ()
        intent[tag] = (*before, *templates)


def _begun(template: str, text: str) -> str:
    """Return the text, with a capital letter if its template begins with a parameter: *Chess? You must show me*.

    A word like *eBay* stays as it is.
    """
    first = text.split(maxsplit=1)[0] if template.startswith("{") and text.strip() else ""
    return text[:1].upper() + text[1:] if first.islower() else text


def _tag(language: str) -> str:
    """Return the normal form of a language's tag: ``de_at`` is ``de-AT``."""
    first, *rest = language.strip().replace("_", "-").split("-")
    return "-".join([first.lower(), *(part.upper() if len(part) == 2 else part.title() for part in rest)])


def _fallbacks(language: str, default: str) -> Iterator[str]:
    seen: set[str] = set()
    for whole in (language, default):
        parts = whole.split("-")
        for length in range(len(parts), 0, -1):
            tag = "-".join(parts[:length])
            if tag not in seen:
                seen.add(tag)
                yield tag


def _template(text: str) -> Template:
    names: set[str] = set()
    try:
        for _, name, form, conversion in string.Formatter().parse(text):
            if name is None:
                continue
            if not name.isidentifier() or form or conversion:
                whole = name + (f"!{conversion}" if conversion else "") + (f":{form}" if form else "")
                raise ValueError(f"{{{whole}}} is not a parameter")
            names.add(name)
    except ValueError as error:
        raise DeclarationError(
            f"the braces in {text!r} name no parameter ({error}): write {{name}}, or {{{{ for a brace"
        ) from None
    return Template(text, frozenset(names))


def _added(name: str, node: yaml.Node) -> bool:
    tag = str(node.tag)
    if tag.startswith("!") and tag != "!add":
        raise fault(name, node, f"the only tag is !add, not {tag}{nearest(tag, ['!add'])}")
    return tag == "!add"


def _entries(name: str, node: yaml.Node, meaning: str) -> Iterator[tuple[yaml.Node, yaml.Node]]:
    if kind_of(node) != "mapping":
        raise fault(name, node, f"{meaning}, but this is not a mapping: write for example\ngreet:\n  en: [Hello!]")
    if _added(name, node):
        raise fault(name, node, "!add goes in front of phrases: write en: !add [...]")
    yield from node.value


def _text_of(name: str, node: yaml.Node, meaning: str) -> str:
    if kind_of(node) != "scalar":
        hint = "put quotes around a text that has : or begins with braces"
        raise fault(name, node, f"{meaning}, but this is a {kind_of(node)}; {hint}")
    return str(node.value)
