"""``ravestate memory``: list, show, export, load and forget what an agent knows, and remove its memory."""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ravestate.cli import UsageError, use_utf8
from ravestate.declare.wording import cut
from ravestate.errors import PlatformError, RavestateError, nearest
from ravestate.folders import replace_file

if TYPE_CHECKING:
    from ravestate.modules.meta.ontology import Memory, Node, Settings


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _add_place(parser)
    does = parser.add_subparsers(dest="does", metavar="WHAT", required=True)
    listing = does.add_parser("list", help="list all nodes")
    listing.add_argument("type", nargs="?", default="", metavar="TYPE", help="list this type only, e.g. Person")
    listing.add_argument("--types", action="store_true", help="only count the nodes of each type")
    showing = does.add_parser("show", help="show a node with its relations")
    showing.add_argument("which", metavar="NAME|ID")
    exporting = does.add_parser("export", help="write the whole memory as JSON")
    exporting.add_argument("to", nargs="?", default="-", metavar="FILE", help="the file; standard output by default")
    loading = does.add_parser("load", help="add the nodes of an exported file")
    loading.add_argument("document", metavar="FILE", help="a file that export wrote; - for standard input")
    forgetting = does.add_parser("forget", help="forget a node, e.g. a person, with everything about it")
    forgetting.add_argument("which", metavar="NAME|ID")
    forgetting.add_argument("-y", "--yes", action="store_true", help="do not ask")
    resetting = does.add_parser("reset", help="remove all files of the memory, even damaged ones")
    resetting.add_argument("-y", "--yes", action="store_true", help="do not ask")
    for action in (listing, showing, exporting, loading, forgetting, resetting):
        _add_place(action, later=True)


def _add_place(parser: argparse.ArgumentParser, *, later: bool = False) -> None:
    """Add the options that choose a memory.

    With `later`, the options come after an action, such as ``list``. An option that is missing there keeps its value
    from before the action.
    """
    default = argparse.SUPPRESS if later else None
    parser.add_argument(
        "--path", metavar="FILE", default=default, help="the memory file; by default the file in the settings"
    )
    parser.add_argument(
        "-f", "--file", metavar="FILE", default=default, help="an agent file with the settings of ontology"
    )
    parser.add_argument(
        "--set",
        dest="later_sets" if later else "sets",
        action="append",
        default=[],
        metavar="ontology.KEY=VALUE",
        help="a setting, which overrides the file and the environment (may be repeated)",
    )


def run(options: argparse.Namespace) -> int:
    """Run the command, and return the exit code: 1 if the memory cannot be used, or if the user says no."""
    from ravestate.modules.meta.ontology.opening import open_memory, path_of

    settings = _settings(options)
    path = path_of(settings)
    if options.does == "reset":
        return _reset(path, options)
    if path is not None and not path.exists() and options.does != "load":
        raise RavestateError(
            f"there is no memory yet: {path} does not exist; name another file with --path FILE, or an agent file "
            f"with -f agent.yaml{_leftover(path)}"
        )
    memory = open_memory(settings)
    try:
        try:
            memory.opened().result()
        except PlatformError as error:  # name this command's option instead of that of `ravestate run`
            raise PlatformError(str(error).replace("--set ontology.path=", "--path ")) from error
        unseen = memory.undeclared().result()
        if unseen:
            print(
                f"ravestate memory: {memory.place} also has {', '.join(unseen)}, but no file declares these types, so they "
                "are hidden here: name the file of types with --set ontology.types=[FILE]",
                file=sys.stderr,
            )
        does = {"list": _list, "show": _show, "export": _export, "load": _load, "forget": _forget}
        return does[options.does](memory, options)
    finally:
        memory.close().result()


def _leftover(path: Path) -> str:
    """Return a hint about files that a deleted memory at this path has left behind; empty if there are none."""
    from ravestate.modules.meta.ontology.files import MemoryFiles

    names = ", ".join(file.name for file in MemoryFiles(path).present())
    return names and (
        f". An earlier memory has left {names}, which may contain personal data: to remove them, run ravestate memory "
        f"reset --path {path}"
    )


def _settings(options: argparse.Namespace) -> Settings:
    from ravestate.cli import agent
    from ravestate.modules import ontology
    from ravestate.settings import load_settings

    sets = [*options.sets, *options.later_sets]
    named = argparse.Namespace(modules=["ontology"], file=options.file, sets=sets, seed=None)
    given = dict(agent.load_agent(named).settings.get("ontology", {}))
    if options.path:
        given.update(path=options.path, url=None)
    return load_settings([ontology.module], {"ontology": given})["ontology"]


def _list(memory: Memory, options: argparse.Namespace) -> int:
    type = options.type
    if type and type not in memory.types:
        raise UsageError(f"there is no type {type!r}{nearest(type, memory.types)}")
    nodes = memory.find(type).result() if type else _everything(memory)
    if options.types:
        for name, count in sorted(Counter(node.type for node in nodes).items()):
            print(f"{name:<16} {count}")
    else:
        for node in nodes:
            print(f"{node.type:<16} {_name(node):<24} {node.id}")
    print(f"{_count(len(nodes))} in {memory.place}", file=sys.stderr)
    return 0


def _show(memory: Memory, options: argparse.Namespace) -> int:
    node = _chosen(memory, options.which)
    print(f"{node.type} {_name(node)}  {node.id}")
    for key, value in node.properties.items():
        print(f"  {key}: {_shown(value)}")
    for relation in memory.relations(node).result():
        more = "".join(f", {key}: {_shown(value)}" for key, value in relation.properties.items())
        if relation.source.id == node.id:
            print(f"  {relation.name} -> {relation.target.type} {_name(relation.target)}{more}")
        else:
            print(f"  <- {relation.name} {relation.source.type} {_name(relation.source)}{more}")
    return 0


def _export(memory: Memory, options: argparse.Namespace) -> int:
    document = memory.export().result()
    text = json.dumps(document, ensure_ascii=False, indent=2) + "\n"
    if options.to == "-":
        use_utf8()
        sys.stdout.write(text)
        return 0
    target = Path(options.to)
    try:
        replace_file(target, text.encode(), mode=0o600)  # the document has personal data
    except OSError as error:
        raise UsageError(f"cannot write {target}: {error.strerror}") from None
    print(f"wrote {target}: {_count(len(document['nodes']))}")
    return 0


def _load(memory: Memory, options: argparse.Namespace) -> int:
    use_utf8()
    try:
        text = sys.stdin.read() if options.document == "-" else Path(options.document).read_text(encoding="utf-8")
        document: Any = json.loads(text)
    except OSError as error:
        raise UsageError(f"cannot read {options.document}: {error.strerror}") from None
    except ValueError as error:
        raise UsageError(f"{options.document} is not JSON: {error}") from None
    print(f"loaded {_count(memory.load(document).result())}")
    return 0


def _forget(memory: Memory, options: argparse.Namespace) -> int:
    node = _chosen(memory, options.which)
    going = memory.only_about(node).result()
    if not options.yes:
        for one in going:
            print(f"{one.type:<16} {_name(one):<24} {one.id}")
        if not _confirmed(f"Forget {'this' if len(going) == 1 else 'these'}, with all relations?"):
            print("nothing was forgotten")
            return 1
    print(f"forgot {_count(len(memory.forget(node).result()))}")
    return 0


def _reset(path: Path | None, options: argparse.Namespace) -> int:
    from ravestate.modules.meta.ontology.files import MemoryFiles

    if path is None:
        raise UsageError("reset removes files, and this memory is on a server: empty its database there")
    files = MemoryFiles(path)
    present = files.present()
    if not present:
        raise RavestateError(f"there is no memory at {path}; name another file with --path FILE")
    if files.in_use():
        raise RavestateError(f"memory {path} is in use by another process: end that agent first")
    if not options.yes:
        print(*present, sep="\n")
        if not _confirmed(f"Remove {'this file' if len(present) == 1 else 'these files'}, with the whole memory?"):
            print("nothing was removed")
            return 1
    try:
        for file in files.remove():
            print(f"removed {file}")
    except OSError as error:
        raise RavestateError(f"cannot remove {error.filename}: {error.strerror}") from None
    return 0


def _confirmed(question: str) -> bool:
    try:
        return input(f"{question} [y/N] ").strip().lower() in ("y", "yes")
    except EOFError:
        print()
        return False


def _everything(memory: Memory) -> list[Node]:
    found = {node.id: node for type in memory.types for node in memory.find(type).result()}
    return sorted(found.values(), key=lambda node: (node.type, node.id))


def _chosen(memory: Memory, which: str) -> Node:
    """Return the node with this id, or the only node with this name. Upper and lower case do not matter in names."""
    node = memory.get(which).result()
    if node is not None:
        return node
    nodes = _everything(memory)
    wanted = which.strip().casefold()
    found = [node for node in nodes if str(node.get("name", "")).strip().casefold() == wanted]
    if not found:
        names = [str(node["name"]) for node in nodes if node.get("name")]
        raise UsageError(f"no node is called {which!r}{nearest(which, names)}")
    if len(found) > 1:
        ids = "".join(f"\n  {node.id}" for node in found)
        raise UsageError(f"{len(found)} nodes are called {which!r}: give the id of one{ids}")
    return found[0]


def _count(number: int) -> str:
    return f"{number} node{'' if number == 1 else 's'}"


def _name(node: Node) -> str:
    return _shown(node.get("name", "(no name)"))


def _shown(value: object) -> str:
    """Return a value as text in one line of at most 200 characters, safe for a terminal."""
    from ravestate.modules._text import printable

    return cut(" ".join(printable(str(value)).split()), 200)
