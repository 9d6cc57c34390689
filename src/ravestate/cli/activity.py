"""``ravestate activity``: name the activity that a person performs in a recording, and teach an activity."""

from __future__ import annotations

import argparse
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ravestate.cli import UsageError
from ravestate.errors import PlatformError

if TYPE_CHECKING:
    from ravestate.modules.modality.activity import Pose, Recogniser

UNKNOWN = "unknown"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    guessing = actions.add_parser(
        "guess",
        help="name the activity that a person performs in a video or a file of landmarks",
        description="Print a line for each window of a few seconds: its beginning and end (seconds), the activity or "
        "'unknown', and the confidence. Exit code 1: no body can be seen.",
    )
    guessing.add_argument("file", type=Path, metavar="FILE", help="a video, or landmarks (.npz)")
    teaching = actions.add_parser(
        "teach",
        help="teach an activity with recordings of it",
        description="Learn an activity from recordings, and keep their landmarks, not their pictures. Cut each recording to the "
        "time in which the person performs the activity. A few seconds are enough, but several recordings are better.",
    )
    teaching.add_argument("name", metavar="NAME", help="the name as it is spoken, such as 'playing the flute'")
    teaching.add_argument("files", nargs="+", type=Path, metavar="FILE", help="a video, or landmarks (.npz)")
    listing = actions.add_parser("list", help="list the activities that the agent knows")
    forgetting = actions.add_parser("forget", help="forget an activity that the agent was taught")
    forgetting.add_argument("name", metavar="NAME", help="its name, as `list` shows it")
    for action in (guessing, teaching, listing, forgetting):
        action.add_argument("--folder", type=Path, metavar="FOLDER", help="the folder of taught activities")
    for action in (guessing, teaching):
        action.add_argument("--python", type=Path, metavar="FILE", help="the interpreter of the vision worker")


def run(options: argparse.Namespace) -> int:
    from ravestate.modules.modality import activity
    from ravestate.modules.modality.activity.files import folder_of
    from ravestate.settings import load_settings

    given = {"folder": options.folder} if options.folder else {}
    settings = load_settings([activity.module], {"activity": given})["activity"]
    assert isinstance(settings, activity.Settings)
    folder = folder_of(settings.folder)
    for file in [options.file] if options.action == "guess" else options.files if options.action == "teach" else []:
        if not file.is_file():
            raise UsageError(f"{file} is a folder: name a file" if file.is_dir() else f"there is no file {file}")
    if options.action == "teach":
        return _teach(options, folder, settings)
    if options.action == "forget":
        return _forget(options.name, folder)
    known = _recogniser(folder)
    if options.action == "list":
        for name in known.names:
            print(f"{name}{'  (taught)' if name in known.taught else ''}")
        return 0
    return _guess(options, known, settings)


def _recogniser(folder: Path) -> Recogniser:
    from ravestate.modules.modality.activity import Recogniser
    from ravestate.modules.modality.activity.files import taught_in

    known = Recogniser()
    for file, fault in taught_in(folder, known):
        print(f"ravestate activity: {file} is left out: {fault}", file=sys.stderr)
    return known


def _guess(options: argparse.Namespace, known: Recogniser, settings: Any) -> int:
    from ravestate.modules._text import printable
    from ravestate.modules.modality.activity.windows import windows

    poses = _poses(options.file, options.python)
    for part in windows(poses, settings.window, settings.window / 2):
        seen = known.recognise(part)
        name = printable(seen.name) or UNKNOWN
        print(f"{part[0].at:6.1f} {part[-1].at:6.1f}  {seen.confidence:4.0%}  {name}", flush=True)
    if not poses:
        print(f"ravestate activity: no body can be seen in {options.file}", file=sys.stderr)
    return 0 if poses else 1


def _teach(options: argparse.Namespace, folder: Path, settings: Any) -> int:
    from ravestate.modules.modality.activity import Recogniser
    from ravestate.modules.modality.activity.files import clean, keep
    from ravestate.modules.modality.activity.windows import windows

    name = clean(options.name)
    if not name:
        raise UsageError("the name is empty")
    known = Recogniser()
    parts: list[Sequence[Pose]] = []
    for file in options.files:
        found = [
            one
            for one in windows(_poses(file, options.python), settings.window, settings.window)
            if known.teach(name, one)
        ]
        if not found:
            raise PlatformError(f"activity: {file} shows too little of a body: nothing was learnt")
        parts += found
    for part in parts:
        keep(folder, name, part)
    print(f"learnt {name} from {len(parts)} demonstration{'' if len(parts) == 1 else 's'}, in {folder}")
    unlike = sum(known.recognise(part).name != name for part in parts)
    if unlike:
        print(
            f"ravestate activity: {unlike} of {len(parts)} demonstrations would not be recognised: film only one person, from the "
            f"front, without other movements. First forget these demonstrations: ravestate activity forget {shlex.quote(name)}",
            file=sys.stderr,
        )
    return 0


def _forget(given: str, folder: Path) -> int:
    from ravestate.errors import nearest
    from ravestate.modules.modality.activity.files import clean, files_of

    taught = files_of(folder)
    name = clean(given)
    if name not in taught:
        raise UsageError(f"no activity {name!r} was taught{nearest(name, taught)} (in {folder})")
    for file in taught[name]:
        file.unlink(missing_ok=True)
    print(f"forgot {name}: {len(taught[name])} demonstration{'' if len(taught[name]) == 1 else 's'}")
    return 0


def _poses(file: Path, python: Path | None) -> list[Pose]:
    from ravestate.modules.modality.activity.video import poses_in

    shows = sys.stderr.isatty()

    def progress(at: float) -> None:
        if shows:
            print(f"\r{file.name}: {at:.1f} s", end="", file=sys.stderr, flush=True)

    try:
        return poses_in(file, python, progress)
    finally:
        if shows:
            print("\r\x1b[K", end="", file=sys.stderr)
