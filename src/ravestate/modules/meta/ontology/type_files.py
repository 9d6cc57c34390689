"""Files of types: YAML files that together declare one `Types`.

::

    Boat:
      is: Thing                         # the parent type
      has: {length: number}             # properties and their kinds
      relations:
        sails_to: [City, Country]       # to nodes of these types, and their subtypes
        insured_by: {to: Company, has: {since: date}}

A later file extends the earlier files; it cannot remove or contradict their declarations.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import TYPE_CHECKING

from ravestate.errors import DeclarationError, nearest
from ravestate.modules._yaml import fault, kind_of, line_of, read_nodes

from .types import KINDS, Kind, Relating, Type, Types

if TYPE_CHECKING:
    import yaml

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,62}")
OF_A_TYPE = ("is", "has", "relations")
OF_A_RELATION = ("to", "has")


def read_types(paths: Iterable[Path | Traversable]) -> Types:
    """Read files in the given order, and return the types that they declare together.

    Raises:
        DeclarationError: A file is invalid or contradicts another file; the message names file and line.
        PlatformError: A file is missing or cannot be read.
    """
    reader = _Reader()
    for file in paths:
        reader.read(str(file), read_nodes(file, "file of types"))
    return reader.finish()


def types_in(paths: Iterable[Path]) -> Types:
    """Return the built-in types together with the types of files. Read each file once, and again after a change.

    Raises:
        DeclarationError: A file is invalid or contradicts another file.
        PlatformError: A file cannot be read.
    """
    return _read(tuple((path.expanduser(), _state_of(path.expanduser())) for path in paths))


@lru_cache(maxsize=8)  # cached, because each visitor of a web page opens memory
def _read(own: tuple[tuple[Path, object], ...]) -> Types:
    built_in = files("ravestate.modules.meta.ontology") / "types.yaml"
    return read_types([built_in, *(path for path, _ in own)])


def _state_of(path: Path) -> object:
    """Return a value that changes when the file changes."""
    try:
        stat = path.stat()
    except OSError:  # reading the file will report the problem
        return None
    return stat.st_ino, stat.st_size, stat.st_mtime_ns


class _Reader:
    """Collects the content of files, with the line of each declaration."""

    def __init__(self) -> None:
        self._places: dict[str, str] = {}
        """Name of a type or relation → the first ``file:line`` that declares it."""
        self._parents: dict[str, tuple[str, str]] = {}
        self._has: dict[str, dict[str, Kind]] = {}
        self._ends: dict[str, dict[tuple[str, str], str]] = {}
        self._relation_has: dict[str, dict[str, Kind]] = {}
        self._kinds: dict[tuple[bool, str], tuple[str, Kind, str]] = {}
        """(Whether a property belongs to a relation, its name in lower case) → its spelling, kind and ``file:line``."""

    def read(self, file: str, root: yaml.Node | None) -> None:
        if root is None:
            return
        for key, name, body in _entries(file, root, "a file of types maps types to their parts"):
            self._name(file, key, name, self._has, self._ends)
            self._has.setdefault(name, {})
            if kind_of(body) == "scalar" and not body.value:
                continue  # the type has neither parent, properties nor relations
            for part, value in _parts(file, body, name, "type", OF_A_TYPE).items():
                if part == "is":
                    self._set_parent(file, name, value)
                elif part == "has":
                    self._add_properties(file, value, name, self._has[name], relation=False)
                else:
                    self._add_relations(file, name, value)

    def finish(self) -> Types:
        ends = [(child, "is a", parent, place) for child, (parent, place) in self._parents.items()]
        ends += [(name, "goes to", end[1], place) for name, to in self._ends.items() for end, place in to.items()]
        for name, verb, type, place in ends:
            if type not in self._has:
                problem = f"{name} {verb} {type!r}, which is not a type{nearest(type, self._has)}"
                raise DeclarationError(f"{place}: {problem}")
        for child, (_, place) in self._parents.items():
            line = [child]
            while line[-1] in self._parents:
                line.append(self._parents[line[-1]][0])
                if line[-1] in line[:-1]:
                    raise DeclarationError(f"{place}: {' is a '.join(line)}: types must not form a cycle")
        return Types(
            {name: Type(name, self._parents.get(name, (None, ""))[0], has) for name, has in self._has.items()},
            {name: Relating(name, frozenset(to), self._relation_has[name]) for name, to in self._ends.items()},
        )

    # ------------------------------------------------------------------------------- parts

    def _set_parent(self, file: str, name: str, node: yaml.Node) -> None:
        parent = _text(file, node, f"the parent of {name} is one type")
        said = self._parents.get(name)
        if said is not None and said[0] != parent:
            raise fault(file, node, f"{name} is a {said[0]} already ({said[1]}), and can have only one parent")
        self._parents[name] = (parent, line_of(file, node))

    def _add_relations(self, file: str, source: str, node: yaml.Node) -> None:
        for key, name, value in _entries(file, node, "relations map names to types"):
            self._name(file, key, name, self._ends, self._has)
            properties = self._relation_has.setdefault(name, {})
            targets = value
            if kind_of(value) == "mapping":
                parts = _parts(file, value, name, "relation", OF_A_RELATION)
                if "to" not in parts:
                    raise fault(file, key, f"relation {name} has no target: write {name}: {{to: Thing}}")
                targets = parts["to"]
                if "has" in parts:
                    self._add_properties(file, parts["has"], name, properties, relation=True)
            ends = self._ends.setdefault(name, {})
            for item in targets.value if kind_of(targets) == "sequence" else [targets]:
                ends.setdefault((source, _text(file, item, f"{name} goes to types")), line_of(file, item))

    def _add_properties(self, file: str, node: yaml.Node, owner: str, into: dict[str, Kind], *, relation: bool) -> None:
        for key, name, value in _entries(file, node, f"{owner} has properties by name"):
            _check_name(file, key, name, "property")
            if name.lower() == "id":
                raise fault(file, key, f"{owner}.{name}: every node has an id already; choose another name")
            kind = _text(file, value, f"{owner}.{name} has a kind")
            if kind not in KINDS:
                problem = f"{kind!r} is not a kind{nearest(kind, KINDS)} (kinds: {', '.join(KINDS)})"
                raise fault(file, value, f"{owner}.{name}: {problem}")
            into[name] = found = KINDS[KINDS.index(kind)]
            spelt, known, where = self._kinds.setdefault((relation, name.lower()), (name, found, line_of(file, key)))
            if (spelt, known) != (name, found):
                problem = f"{owner}.{name} is {found}, and {spelt} is {known} at {where}: choose another name"
                raise fault(file, key, problem)

    def _name(
        self, file: str, node: yaml.Node, name: str, among: Mapping[str, object], others: Mapping[str, object]
    ) -> None:
        """Register the name of a type or relation.

        A type and a relation may not share a name. Two names may not differ by capital letters alone.
        """
        _check_name(file, node, name, "type or relation")
        for other in (*among, *others):
            if other.lower() == name.lower() and (other != name or other in others):
                place = self._places[other]
                problem = "are too similar: names of types and relations must differ by more than capital letters"
                raise fault(file, node, f"{name} and {other} ({place}) {problem}")
        self._places.setdefault(name, line_of(file, node))


# ------------------------------------------------------------------------------------- YAML


def _entries(file: str, node: yaml.Node, meaning: str) -> Iterator[tuple[yaml.Node, str, yaml.Node]]:
    if kind_of(node) != "mapping":
        example = "write for example\nBoat:\n  has: {length: number}"
        raise fault(file, node, f"{meaning}, but this is not a mapping: {example}")
    for key, value in node.value:
        yield key, _text(file, key, "a name is a text"), value


def _parts(file: str, node: yaml.Node, owner: str, what: str, known: tuple[str, ...]) -> dict[str, yaml.Node]:
    """Return the parts of the declaration of a type or relation, by their keys; refuse keys that are not `known`."""
    parts: dict[str, yaml.Node] = {}
    for key, part, body in _entries(file, node, f"{owner} has keys and values"):
        if part not in known:
            problem = f"{owner} has no {part!r}{nearest(part, known)} (a {what} has: {', '.join(known)})"
            raise fault(file, key, problem)
        parts[part] = body
    return parts


def _text(file: str, node: yaml.Node, meaning: str) -> str:
    if kind_of(node) != "scalar":
        raise fault(file, node, f"{meaning}, but this is a {kind_of(node)}")
    return str(node.value)


def _check_name(file: str, node: yaml.Node, name: str, what: str) -> None:
    if not NAME.fullmatch(name):
        rule = "use at most 63 letters from A to Z, digits and '_', and begin with a letter"
        raise fault(file, node, f"{name!r} is not a name for a {what}: {rule}")
