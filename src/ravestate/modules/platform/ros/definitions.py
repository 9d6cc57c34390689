"""The definitions of messages, services and actions: ``.msg``, ``.srv`` and ``.action`` files."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from ravestate.errors import PlatformError

ENDINGS = {"msg": ".msg", "srv": ".srv", "action": ".action"}

PARTS = {"srv": ("Request", "Response"), "action": ("Goal", "Result", "Feedback")}
"""Kind of definition → the ends of the names of the messages in its file, in the file's order."""

COMMON = {
    "std_srvs/srv/Empty": "---",
    "std_srvs/srv/SetBool": "bool data\n---\nbool success\nstring message",
    "std_srvs/srv/Trigger": "---\nbool success\nstring message",
}
"""The definitions of the services that most robots offer. A machine without the package std_srvs uses these."""


def full_name(name: str, kind: str = "msg") -> str:
    """Return the full name of a type: ``std_msgs/msg/String`` for ``std_msgs/String``.

    Args:
        name: A name with one or two slashes.
        kind: The middle of the full name (``msg``, ``srv`` or ``action``), if `name` has only one slash.

    Raises:
        PlatformError: The name does not look like the name of a type.
    """
    parts = name.split("/") if isinstance(name, str) else []  # pyright: ignore[reportUnnecessaryIsInstance]
    if len(parts) == 2:
        parts.insert(1, kind)
    if len(parts) != 3 or not all(part.replace("_", "a").isalnum() for part in parts) or parts[1] not in ENDINGS:
        raise PlatformError(f"{name!r} is not the name of a {kind} type: write PACKAGE/NAME, such as std_msgs/String")
    return "/".join(parts)


class Definitions:
    """The definition files in some folders.

    Args:
        own: The user's files, or folders that hold them.
        folders: A function that returns the folders with packages: ``FOLDER/PACKAGE/msg/NAME.msg``.
    """

    def __init__(self, own: Iterable[Path] = (), folders: Callable[[], Iterable[Path]] = tuple) -> None:
        self._own = [path.expanduser() for path in own]
        self._folders = folders

    def add(self, path: Path) -> None:
        """Add a file, or a folder of files."""
        if path not in self._own:
            self._own.append(path)

    def text(self, name: str) -> str | None:
        """Return the text of the definition of a type, given by its full name; None if there is no definition.

        Raises:
            PlatformError: A file or folder of the user is missing, or a definition file is unreadable.
        """
        package, kind, short = name.split("/")
        for path in self._files(package, kind, short):
            if path.is_file():
                try:
                    return path.read_text("utf-8")
                except (OSError, UnicodeDecodeError) as error:
                    raise PlatformError(f"cannot read the definition {path}: {error}") from error
        return COMMON.get(name)

    def _files(self, package: str, kind: str, short: str) -> Iterator[Path]:
        file = f"{short}{ENDINGS[kind]}"
        for path in self._own:
            if path.is_file():
                if path.name == file:
                    yield path
                continue
            if not path.is_dir():
                raise PlatformError(f"there is no file or folder {path}: see the setting `definitions`")
            yield path / package / kind / file
            if path.name == package:
                yield path / kind / file
            yield path / kind / file
            yield path / file
        for folder in self._folders():
            yield folder / package / kind / file


GOAL_TOPICS = {
    "ActionGoal": "std_msgs/Header header\nactionlib_msgs/GoalID goal_id\n{}Goal goal",
    "ActionResult": "std_msgs/Header header\nactionlib_msgs/GoalStatus status\n{}Result result",
    "ActionFeedback": "std_msgs/Header header\nactionlib_msgs/GoalStatus status\n{}Feedback feedback",
}
"""The messages of an action's topics in ROS 1. Key: the end of the message's name. Value: the text of the message's
definition; ``{}`` is the place of the action's name."""


def part_names(name: str, version: int) -> list[str]:
    """Return the full names of the messages in the definition of a service or an action, in the definition's order."""
    package, kind, short = name.split("/")
    if kind == "action" and version == 1:
        return [f"{package}/msg/{short}{title}" for title in PARTS[kind]]
    return [f"{name}_{title}" for title in PARTS[kind]]


def messages(name: str, text: str, version: int) -> Iterator[tuple[str, str]]:
    """Yield the full name and the text of each message in a definition.

    For an action of ROS 1, also yield the messages of its topics.

    Raises:
        PlatformError: A service or an action has too few or too many parts.
    """
    kind = name.split("/")[1]
    if kind == "msg":
        yield name, text
        return
    parts: list[list[str]] = [[]]
    for line in text.splitlines():
        if line.strip() == "---":
            parts.append([])
        else:
            parts[-1].append(line)
    titles = PARTS[kind]
    if len(parts) != len(titles):
        raise PlatformError(
            f"the definition of {name} has {len(parts)} parts instead of {len(titles)} ({', '.join(titles)})"
        )
    for full, lines in zip(part_names(name, version), parts, strict=True):
        yield full, "\n".join(lines)
    if kind == "action" and version == 1:
        package, _, short = name.split("/")
        for title, topic in GOAL_TOPICS.items():
            yield f"{package}/msg/{short}{title}", topic.format(short)
