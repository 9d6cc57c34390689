"""The arguments that launch files of ROS pass to a node, as settings of an agent."""

from __future__ import annotations

import json
from collections.abc import Sequence

SPECIAL = {"__ns": "namespace", "__node": "node", "__name": "node"}
"""The special names of a remapping → the settings of ``ros1`` and ``ros2``."""

IGNORED = ("__log", "__master", "__ip", "__hostname")
"""Arguments of ROS 1 that say nothing about the agent."""


def translate(arguments: Sequence[str]) -> list[str]:
    """Return a command line in which arguments of ROS are options ``--set``.

    ROS 2: ``--ros-args -p module.key:=value -r /from:=/to -r __ns:=/robot --``. ROS 1: ``_module.key:=value``,
    ``/from:=/to``, ``__name:=guide``. A parameter is a setting of a module.
    """
    rest: list[str] = []
    settings: list[tuple[str, str]] = []
    remap: dict[str, dict[str, str]] = {}
    version, option = "ros1", ""
    for argument in arguments:
        if argument == "--ros-args":
            version = "ros2"
        elif version == "ros2" and argument == "--":
            version = "ros1"
        elif version == "ros2" and argument in ("-p", "--param", "-r", "--remap"):
            option = argument.lstrip("-")[0]
        elif ":=" in argument and not argument.startswith("-"):
            name, _, value = argument.partition(":=")
            if name in SPECIAL:
                settings.append((f"{version}.{SPECIAL[name]}", value))
            elif option == "p" or (version == "ros1" and name.startswith("_") and name not in IGNORED):
                settings.append((name.removeprefix("_"), value))
            elif name not in IGNORED:
                remap.setdefault(version, {})[name] = value
            option = ""
        else:
            rest.append(argument)
    settings += [(f"{version}.remap", json.dumps(names)) for version, names in remap.items()]
    return [*rest, *(part for name, value in settings for part in ("--set", f"{name}={value}"))]
