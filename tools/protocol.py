"""Write the TypeScript of a web protocol from its Python records.

    python tools/protocol.py            write each file in FILES
    python tools/protocol.py --check    exit code 1 if a file is out of date; the tests do the same

A source is any module that has pydantic `TypeAdapter`s: of models, of dataclasses, or of unions of them. The tool reads
their JSON schemas. The first lines of a docstring, its ``Attributes:`` and the docstrings of constants become comments.
"""

from __future__ import annotations

import argparse
import ast
import importlib
import inspect
import itertools
import json
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

from pydantic import TypeAdapter

ROOT = Path(__file__).parents[1]
WIDTH = 110
"""The maximum length of a line, as in ``frontend/biome.json``."""

Schema = Mapping[str, Any]


@dataclass(frozen=True)
class Source:
    """The part of Python modules that a TypeScript file holds.

    Attributes:
        modules: The modules' dotted names. The first one has the types, and each may have constants.
        types: The name of each exported type, and the attribute of the first module that has its `TypeAdapter`.
        constants: Attributes that are exported as they are; JSON must be able to hold them.
        checked: One of the `types`. The exported ``FIELDS`` lists its frames' required fields, for a run-time check.
    """

    modules: tuple[str, ...]
    types: Mapping[str, str]
    constants: tuple[str, ...] = ()
    checked: str = ""


FILES = {
    "frontend/src/lib/protocol.ts": Source(
        ("ravestate.modules.platform.webio.frames", "ravestate.modules.platform.webio.fields"),
        types={"ClientFrame": "CLIENT", "ServerFrame": "SERVER"},
        constants=("VERSION", "LONGEST_TEXT", "LONGEST_PICTURE", "CLOSING_CODES"),
        checked="ServerFrame",
    ),
    "frontend/src/board/protocol.ts": Source(
        ("ravestate.board.protocol",),
        types={"ClientFrame": "CLIENT", "ServerFrame": "SERVER"},
        constants=("VERSION", "CLOSING_CODES", "LOSSES", "VERDICTS"),
    ),
}


def typescript(source: Source) -> str:
    """Return the TypeScript of a source."""
    modules = [importlib.import_module(name) for name in source.modules]
    module = modules[0]
    adapters: dict[str, TypeAdapter[Any]] = {name: getattr(module, at) for name, at in source.types.items()}
    found, whole = TypeAdapter.json_schemas([(name, "validation", made) for name, made in adapters.items()])
    records: Mapping[str, Schema] = whole.get("$defs", {})
    order = sorted(records, key=lambda name: _line_of(module, name))
    parts = [f"// Written by tools/protocol.py from {source.modules[0]}: change that file, and run the tool."]
    documented = {name: text for each in modules for name, text in _constants(inspect.getsource(each))}
    values = {name: value for each in modules for name, value in vars(each).items()}
    parts += [
        f"{_comment(documented.get(name, ''))}export const {name} = {_literal(values[name])};"
        for name in source.constants
    ]
    parts += [_interface(name, records[name]) for name in order]
    parts += [_union(name, found[name, "validation"]) for name in adapters]
    if source.checked:
        parts.append(_fields(source.checked, found[source.checked, "validation"], records))
    return "\n\n".join(parts) + "\n"


def _line_of(module: Any, name: str) -> int:
    try:
        return inspect.getsourcelines(getattr(module, name))[1]
    except (AttributeError, OSError, TypeError):  # a record of another module comes first
        return 0


def _constants(code: str) -> Iterator[tuple[str, str]]:
    """Yield the name and the docstring of each constant of a module."""
    body = ast.parse(code).body
    for one, other in itertools.pairwise(body):
        match one, other:
            case (
                ast.Assign(targets=[ast.Name(id=name)]) | ast.AnnAssign(target=ast.Name(id=name)),
                ast.Expr(value=ast.Constant(value=str(text))),
            ):
                yield name, text
            case _:
                pass


# ------------------------------------------------------------------------------------ declarations


def _interface(name: str, schema: Schema) -> str:
    if "properties" not in schema:
        return _comment(schema.get("description", "")) + _union(name, schema)
    text, _, section = schema.get("description", "").partition("\n\nAttributes:\n")
    documented = dict(re.findall(r"^ {4}(\w+): ((?:.|\n {5,})+)", section, re.MULTILINE))
    lines = [f"{_comment(text)}export interface {name} {{"]
    fields: Mapping[str, Schema] = schema["properties"]
    for field in sorted(fields, key=lambda field: "const" not in fields[field]):  # the type comes first
        kind = fields[field]
        optional = field not in schema.get("required", ()) and "const" not in kind
        sort = _type(_without_null(kind) if optional else kind)
        lines.append(f"{_comment(documented.get(field, ''), 2)}  {_key(field)}{'?' * optional}: {sort};")
    return "\n".join((*lines, "}"))


def _union(name: str, schema: Schema) -> str:
    kind = _type(schema)
    line = f"export type {name} = {kind};"
    if len(line) <= WIDTH:
        return line
    return "\n  | ".join((f"export type {name} =", *kind.split(" | "))) + ";"


def _fields(name: str, schema: Schema, records: Mapping[str, Schema]) -> str:
    """Return the required fields of each frame, each with the result of ``typeof``."""
    frames: dict[str, dict[str, str]] = {}
    for reference in schema.get("oneOf", (schema,)):
        record = records[reference["$ref"].rpartition("/")[2]]
        kinds = {field: _typeof(record["properties"][field]) for field in record.get("required", ())}
        tag = record["properties"]["type"]["const"]
        frames[tag] = {field: kind for field, kind in kinds.items() if kind and field != "type"}
    comment = _comment(f"The fields that each {name} must have, by what `typeof` calls them.")
    return f'{comment}export const FIELDS: Record<{name}["type"], Record<string, string>> = {_literal(frames)};'


# ------------------------------------------------------------------------------------ types


def _type(schema: Schema) -> str:
    if "$ref" in schema:
        return str(schema["$ref"]).rpartition("/")[2]
    if "const" in schema:
        return json.dumps(schema["const"])
    if "enum" in schema:
        return " | ".join(map(json.dumps, schema["enum"]))
    if several := schema.get("anyOf") or schema.get("oneOf"):
        return " | ".join(dict.fromkeys(map(_type, several)))
    match schema.get("type"):
        case "string" | "boolean" | "null" as kind:
            return kind
        case "integer" | "number":
            return "number"
        case "array" if "prefixItems" in schema:
            return f"[{', '.join(map(_type, schema['prefixItems']))}]"
        case "array":
            kind = _type(schema.get("items", {}))
            return f"({kind})[]" if " | " in kind else f"{kind}[]"
        case "object":
            values = schema.get("additionalProperties")
            return f"Record<string, {_type(cast('Schema', values)) if isinstance(values, dict) else 'unknown'}>"
        case _:
            return "unknown"


def _without_null(schema: Schema) -> Schema:
    if "anyOf" not in schema:
        return schema
    return {"anyOf": [kind for kind in schema["anyOf"] if kind.get("type") != "null"]}


def _typeof(schema: Schema) -> str:
    """Return the result of ``typeof`` for a value; empty if there are several possible results."""
    if "$ref" in schema:
        return "object"
    kind = str(schema.get("type", ""))
    return {"integer": "number", "array": "object"}.get(kind, kind)


# ------------------------------------------------------------------------------------ text


def _literal(value: Any, indent: int = 0) -> str:
    if not isinstance(value, dict):
        return json.dumps(value, ensure_ascii=False)
    if not value:
        return "{}"
    pad = " " * (indent + 2)
    entries = cast("dict[str, Any]", value).items()
    inner = "".join(f"{pad}{_key(key)}: {_literal(entry, indent + 2)},\n" for key, entry in entries)
    return f"{{\n{inner}{' ' * indent}}}"


def _key(name: str) -> str:
    return name if name.isidentifier() else json.dumps(name)


def _comment(text: str, indent: int = 0) -> str:
    """Return a JSDoc comment and a line feed; empty for an empty text."""
    text = re.split(r"\n\n(?:Args|Raises|Returns|Example):\n", text)[0]
    plain = re.sub(r"``(.+?)``", r"`\1`", text).strip()
    pad = " " * indent
    paragraphs = [" ".join(part.split()) for part in plain.split("\n\n") if part]
    if not paragraphs:
        return ""
    if len(paragraphs) == 1:
        return f"{pad}/** {paragraphs[0]} */\n"
    return f"{pad}/**\n{pad} * " + f"\n{pad} *\n{pad} * ".join(paragraphs) + f"\n{pad} */\n"


def main(arguments: Sequence[str]) -> int:
    """Write the files, or check them; return the exit code."""
    parser = argparse.ArgumentParser(description="Write the TypeScript of a web protocol from its Python records.")
    parser.add_argument("--check", action="store_true", help="write nothing; exit code 1 if a file is out of date")
    check = parser.parse_args(arguments).check
    for name, source in FILES.items():
        file, made = ROOT / name, typescript(source)
        if not check:
            file.write_text(made, encoding="utf-8")
        elif file.read_text(encoding="utf-8") != made:
            print(f"{name} is out of date: run python tools/protocol.py")
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
