"""Read YAML that users write. Refuse repeated keys, and texts that are too deep or too large.

Errors name the file and, where possible, the line. A few lines of aliases can stand for billions of values ("billion
laughs"), and deep nesting exhausts the stack. The loaders here refuse both immediately. If a mapping has a key twice,
PyYAML would silently drop the first value. Keys such as ``1`` and ``0x1`` are equal for `load_yaml`; for
`compose_yaml`, they are two different texts.
"""

from __future__ import annotations

import contextlib
from typing import Any, cast

import yaml
from yaml.composer import Composer
from yaml.constructor import SafeConstructor
from yaml.resolver import BaseResolver, Resolver

from ravestate.errors import DeclarationError

DEEPEST = 50
"""The maximum depth of nesting in a YAML text."""

DIGITS = 300
"""The maximum number of characters in a number."""

LARGEST = 100_000
"""The maximum number of values in a YAML text. Each alias counts as all the values that it stands for."""

MERGE = "tag:yaml.org,2002:merge"  # the tag of the key ``<<``, which copies the items of another mapping

RESPELT = tuple(f"tag:yaml.org,2002:{kind}" for kind in ("bool", "int", "float", "null", "timestamp"))
"""The tags of the values that have several spellings, such as ``1`` and ``0x1``."""


def load_yaml(text: str, name: str) -> Any:
    """Return the value of a YAML text, such as a mapping, a list, a text or a number; `None` if the text is empty.

    If the text is not valid, repeats a key, nests too deeply, or stands for too many values, raise a
    `DeclarationError`. Its message begins with `name`, the name of the file.
    """
    try:
        with contextlib.suppress(yaml.YAMLError):  # the slower loader below has better error messages
            return yaml.load(text, _value_loader)
        return yaml.load(text, _SafeLoader)
    except yaml.YAMLError as error:
        raise _fault(error, text, name) from None
    except ValueError as error:  # such as the 30th of February, or a number of 5,000 digits
        raise DeclarationError(f"{name}: not valid YAML ({error})") from None


def compose_yaml(text: str, name: str) -> yaml.Node | None:
    """Return the root node of a YAML text; `None` if it is empty. Each node has its line, and every scalar is text.

    For `name` and the errors, see `load_yaml`.
    """
    try:
        with contextlib.suppress(yaml.YAMLError):
            return yaml.compose(text, Loader=_text_loader)
        return yaml.compose(text, Loader=_TextLoader)
    except yaml.YAMLError as error:
        raise _fault(error, text, name) from None


class _Bounded(Composer):
    """A composer that counts levels and values and refuses too many of them. It refuses repeated keys, too."""

    depth = count = 0

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        event = cast("Any", self).peek_event()  # the loader inherits this method from its parser
        sizes: dict[object, int] = self.__dict__.setdefault("sizes", {})  # anchor → the size of its finished node
        before = self.count
        self.depth += 1
        if self.depth > DEEPEST:
            raise _RefusedError(f"nested more than {DEEPEST} levels deep", event)
        node = super().compose_node(parent, index)
        self.depth -= 1
        if not isinstance(event, yaml.AliasEvent):
            if isinstance(node, yaml.MappingNode):
                self._refuse_repeated_keys(node)
            self.count += 1
            sizes[event.anchor] = self.count - before
        elif event.anchor in sizes:
            self.count += sizes[event.anchor]
        else:
            raise _RefusedError(f"alias *{event.anchor} refers to itself", event)
        if self.count > LARGEST:
            raise _RefusedError(f"more than {LARGEST:,} values once the aliases are followed", event)
        return node

    def _refuse_repeated_keys(self, mapping: yaml.MappingNode) -> None:
        """Refuse equal keys, even in different spellings. A mapping may have several merge keys (``<<``)."""
        first: dict[object, yaml.ScalarNode] = {}
        for key, _ in cast("list[tuple[yaml.Node, yaml.Node]]", mapping.value):
            if not isinstance(key, yaml.ScalarNode) or key.tag == MERGE:
                continue
            value: object = (key.tag, key.value)
            if key.tag in RESPELT and isinstance(self, SafeConstructor):
                value = cast("Any", self).construct_object(key)
            if value in first:
                line, spelling = first[value].start_mark.line + 1, first[value].value
                found = f"{key.value!r} is here twice (first in line {line}): write it once"
                if spelling != key.value:
                    found = f"{key.value!r} is the same key as {spelling!r} in line {line}: write it once"
                raise _RefusedError(found, key)
            first[value] = key


class _Values(SafeConstructor):
    def construct_number(self, node: yaml.ScalarNode) -> Any:
        """Return the number in a node. Refuse a long number, because PyYAML may need minutes to read it.

        An example is a long number in base 60: ``59:59:...``.
        """
        if len(node.value) > DIGITS:
            raise yaml.constructor.ConstructorError(
                None, None, f"a number of more than {DIGITS} digits", node.start_mark
            )
        kind = str(node.tag).rpartition(":")[2]
        return getattr(self, f"construct_yaml_{kind}")(node)


for _tag in ("tag:yaml.org,2002:int", "tag:yaml.org,2002:float"):
    cast("Any", _Values).add_constructor(_tag, _Values.construct_number)


class _SafeLoader(_Bounded, _Values, yaml.SafeLoader):
    pass


class _TextLoader(_Bounded, yaml.BaseLoader):
    pass


_value_loader: Any = _SafeLoader
_text_loader: Any = _TextLoader
if yaml.__with_libyaml__:
    _Events: Any = cast("Any", yaml.cyaml).CParser

    class _FastTextLoader(_Bounded, _Events, BaseResolver):
        """A `_TextLoader` with the parser of libyaml. It is seven times as fast."""

        def __init__(self, stream: str) -> None:
            _Events.__init__(self, stream)
            Composer.__init__(self)
            BaseResolver.__init__(self)

    class _FastSafeLoader(_Bounded, _Values, _Events, Resolver):
        """A `_SafeLoader` with the parser of libyaml."""

        def __init__(self, stream: str) -> None:
            _Events.__init__(self, stream)
            Composer.__init__(self)
            SafeConstructor.__init__(self)
            Resolver.__init__(self)

    _value_loader, _text_loader = _FastSafeLoader, _FastTextLoader


class _RefusedError(yaml.MarkedYAMLError):
    def __init__(self, problem: str, place: Any) -> None:
        super().__init__(None, None, problem, place.start_mark)


def _fault(error: yaml.YAMLError, text: str, name: str) -> DeclarationError:
    if not isinstance(error, yaml.MarkedYAMLError):  # this error has a position instead of a mark
        line = text.count("\n", 0, getattr(error, "position", 0)) + 1
        return DeclarationError(f"{name}:{line}: not valid YAML (a control character)")
    mark = error.problem_mark or error.context_mark
    place = name if mark is None else f"{name}:{mark.line + 1}"
    if isinstance(error, _RefusedError):
        return DeclarationError(f"{place}: {error.problem}")
    reason = ", ".join(filter(None, (error.context, error.problem)))
    hint = "Put quotes around a text that contains : or #, or begins with a brace"
    return DeclarationError(f"{place}: not valid YAML ({reason}). {hint}")
