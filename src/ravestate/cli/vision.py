"""``ravestate vision``: say whose faces are in pictures, learn a face, and check the camera."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ravestate.cli import UsageError
from ravestate.errors import PlatformError, RavestateError

if TYPE_CHECKING:
    from ravestate.modules.meta.ontology import Memory, Node
    from ravestate.modules.modality.visionio.eye import Eye
    from ravestate.modules.modality.visionio.face import Vector

UNKNOWN = "unknown"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    checking = actions.add_parser("check", help="show the camera and the vision worker, and how to get what is missing")
    telling = actions.add_parser(
        "who",
        help="say whose faces are in pictures: a line for each face",
        description="Print a line for each face: the name or 'unknown', the distance to the nearest face in memory, the "
        "box (x,y,width,height in pixels), and the file. Exit code 1: a file could not be read.",
    )
    learning = actions.add_parser(
        "learn",
        help="remember a person's face from pictures of them",
        description="Store a person's face in memory. Each picture must show one face, theirs. Ask the person first.",
    )
    learning.add_argument("name", metavar="NAME", help="the person's name")
    for action in (telling, learning):
        action.add_argument("files", nargs="+", type=Path, metavar="FILE", help="a picture: JPEG, PNG, WebP, ...")
        action.add_argument("--path", metavar="FILE", help="the memory file; by default the file in the settings")
    for action in (checking, telling, learning):
        action.add_argument("-f", "--file", metavar="FILE", help="an agent file with the settings")
        action.add_argument(
            "--set", dest="sets", action="append", default=[], metavar="MODULE.KEY=VALUE",
            help="a setting, e.g. visionio.threshold=0.5 (may be repeated)",
        )  # fmt: skip


def run(options: argparse.Namespace) -> int:
    settings = _settings(options)
    if options.action == "check":
        return _check(settings["visionio"])
    for file in options.files:
        if not file.is_file():
            raise UsageError(
                f"{file} is a folder: name the pictures in it" if file.is_dir() else f"there is no file {file}"
            )
    return (_who if options.action == "who" else _learn)(options, settings)


def _settings(options: argparse.Namespace) -> dict[str, Any]:
    from ravestate.cli import agent
    from ravestate.modules import ontology, visionio
    from ravestate.settings import load_settings

    named = argparse.Namespace(modules=["ontology", "visionio"], file=options.file, sets=options.sets, seed=None)
    given = {name: dict(values) for name, values in agent.load_agent(named).settings.items()}
    if getattr(options, "path", None):
        given.setdefault("ontology", {}).update(path=options.path, url=None)
    wanted = {name: given.get(name, {}) for name in ("ontology", "visionio")}
    return dict(load_settings([ontology.module, visionio.module], wanted))


def _check(settings: Any) -> int:
    from ravestate.modules.modality.visionio.eye import Eye
    from ravestate.modules.modality.visionio.places import default_camera, eyes_python

    good = True
    try:
        print(f"interpreter  {eyes_python(settings.python)}")
        eye = Eye(settings.python)
        try:
            eye.process.start()
            print("worker       finds and recognises faces")
        finally:
            eye.close()
    except PlatformError as error:
        print(f"worker       MISSING: {error}")
        good = False
    source = settings.source if settings.source != "default" else default_camera()
    print(
        f"camera       {source}"
        if source
        else "camera       none: name a device, a video or a folder in visionio.source"
    )
    return 0 if good else 1


def _who(options: argparse.Namespace, settings: dict[str, Any]) -> int:
    from ravestate.modules.modality.visionio import people

    code = 0
    threshold = settings["visionio"].threshold
    with _eye(settings["visionio"]) as eye, _memory(settings["ontology"], make=False) as memory:
        for file in options.files:
            try:
                found = _faces(eye, file)
            except PlatformError as error:
                print(f"ravestate vision: {file}: {str(error).removeprefix('visionio: ')}", file=sys.stderr)
                code = 1
                continue
            if not found:
                print(f"ravestate vision: {file}: there is no face in it", file=sys.stderr)
            for face in found:
                name, distance = UNKNOWN, None
                if memory is not None:
                    vector: Vector = tuple(face["vector"])
                    name, distance = memory.together(
                        lambda graph, v=vector: _name(people, graph, v, threshold)
                    ).result()
                box = ",".join(map(str, face["box"]))
                print(f"{name:<20} {'-' if distance is None else f'{distance:.3f}':>5}  {box}  {file}", flush=True)
    return code


def _name(people: Any, graph: Any, vector: Vector, threshold: float) -> tuple[str, float | None]:
    """Return the name of the person to whom a face's vector belongs, and the distance to the nearest face in memory."""
    found = people.nearest(graph, vector, threshold)
    if found is not None:
        return _shown(found.person), found.distance
    return UNKNOWN, people.least(graph, vector)


def _learn(options: argparse.Namespace, settings: dict[str, Any]) -> int:
    from math import dist

    from ravestate.modules.modality.visionio import people

    name, vision = options.name.strip(), settings["visionio"]
    if not name:
        raise UsageError("the name is empty")
    vectors: list[tuple[float, Vector]] = []
    with _eye(vision) as eye:
        for file in options.files:
            try:
                found = _faces(eye, file)
            except PlatformError as error:
                raise UsageError(f"{file}: {str(error).removeprefix('visionio: ')}") from None
            if len(found) != 1:
                problem = (
                    f"has {len(found)} faces: crop it to the face of {name}"
                    if found
                    else "has no face that can be found"
                )
                raise UsageError(f"{file} {problem}")
            [face] = found
            vector: Vector = tuple(face["vector"])
            if vectors and (far := min(dist(vector, other) for _, other in vectors)) > vision.threshold:
                raise UsageError(f"{file} shows a different person from {options.files[0]} (distance {far:.3f})")
            if face["quality"] < vision.quality:
                print(
                    f"ravestate vision: {file}: left out, because the face is hard to see (quality {face['quality']:.2f})",
                    file=sys.stderr,
                )
                continue
            vectors.append((face["quality"], vector))
    if not vectors:
        raise RavestateError(f"nothing was learnt: no picture shows the face of {name} well enough")
    with _memory(settings["ontology"], make=True) as memory:
        assert memory is not None
        person = _person(memory, name)
        other = memory.together(lambda graph: people.nearest(graph, vectors[0][1], vision.threshold)).result()
        if other is not None and other.person.id != person.id and _shown(other.person).casefold() != name.casefold():
            # If one face had two names, the agent would recognise neither person.
            raise RavestateError(
                f"nothing was learnt: memory knows this face as {_shown(other.person)} (distance {other.distance:.3f}). If that "
                "is wrong, first run: ravestate memory forget NAME"
            )
        _, filed = memory.together(lambda graph: people.keep(graph, person, vectors, vision.most)).result()
    print(f"learnt {filed} view{'' if filed == 1 else 's'} of {name}")
    return 0


def _person(memory: Memory, name: str) -> Node:
    """Return the person of this name in memory, or a new person of this name."""
    from ravestate.modules.meta.ontology import Node

    found = [one for one in memory.find("Person").result() if str(one.get("name", "")).casefold() == name.casefold()]
    if len(found) > 1:
        raise RavestateError(f"memory knows {len(found)} people called {name}: use a name that only one person has")
    return found[0] if found else Node("Person", {"name": name})


def _faces(eye: Eye, file: Path) -> list[dict[str, Any]]:
    from ravestate.modules.modality.visionio.frames import Frame

    try:
        data = file.read_bytes()
    except OSError as error:
        raise PlatformError(f"visionio: the file cannot be read: {error.strerror}") from None
    seen = eye.look_now(["faces"], {"thorough": 2, "most": 1000}, frame=Frame(data))
    return [] if seen is None else seen["faces"]


@contextmanager
def _eye(settings: Any) -> Generator[Eye]:
    from ravestate.modules.modality.visionio.eye import Eye

    eye = Eye(settings.python)
    try:
        yield eye
    finally:
        eye.close()


@contextmanager
def _memory(settings: Any, *, make: bool) -> Generator[Memory | None]:
    """Open the memory, and yield it. Yield None if there is no memory and `make` is false."""
    from ravestate.modules.meta.ontology.opening import open_memory, path_of

    path = path_of(settings)
    if path is not None and not path.exists() and not make:
        print(f"ravestate vision: there is no memory in {path}, so no face is known", file=sys.stderr)
        yield None
        return
    memory = open_memory(settings)
    try:
        memory.opened().result()
        yield memory
    finally:
        memory.close().result()


def _shown(person: Node) -> str:
    from ravestate.modules._text import printable

    return printable(str(person.get("name") or UNKNOWN))
