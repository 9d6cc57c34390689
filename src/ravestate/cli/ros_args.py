"""Convert the arguments that a ROS launch file passes to a node into settings of an agent."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ravestate.cli.ros_params import from_file, from_server, setting

SPECIAL = {"__ns": "namespace", "__node": "node", "__name": "node"}
"""Special name in a remapping → the setting of ``ros1`` or ``ros2`` that it sets."""

IGNORED = ("__log", "__master", "__ip", "__hostname")
"""Arguments of ROS 1 that say nothing about the agent."""

OPTIONS = {
    "-p": "parameter", "--param": "parameter", "-r": "remap", "--remap": "remap", "--params-file": "file",
    "--log-level": "", "--log-config-file": "", "-e": "", "--enclave": "", "--log-file-name": "",
}  # fmt: skip
"""Option of ROS 2 that takes a value → the kind of the value; empty if the value says nothing about the agent."""


def translate(arguments: Sequence[str]) -> list[str]:
    """Return the command line with options ``--set`` in place of ROS arguments.

    Arguments of ROS 2 look like ``--ros-args -p module.key:=value --params-file FILE -r /from:=/to -r __ns:=/robot
    --``. Arguments of ROS 1 look like ``_module.key:=value``, ``/from:=/to`` or ``__name:=guide``. A parameter becomes
    a setting of a module. If the arguments give ``__name``, as those of roslaunch do, the node's parameters on the
    parameter server become settings, too.

    Raises:
        UsageError: A parameter file is missing or wrong.
    """
    rest: list[str] = []
    settings: list[tuple[str, str]] = []
    files: list[Path] = []
    remap: dict[str, dict[str, str]] = {}
    version, option = "ros1", "remap"
    for argument in arguments:
        name, sign, value = argument.partition(":=")
        if argument == "--ros-args":
            version = "ros2"
        elif version == "ros2" and argument == "--":
            version, option = "ros1", "remap"
        elif version == "ros2" and argument in OPTIONS:
            option = OPTIONS[argument]
            continue
        elif version == "ros2" and argument.startswith(("--enable-", "--disable-")):
            pass
        elif version == "ros2" and option == "file":
            files.append(Path(argument))
        elif sign and not argument.startswith("-"):
            private = version == "ros1" and name.startswith("_") and not name.startswith("__")
            if name in SPECIAL:
                settings.append((f"{version}.{SPECIAL[name]}", value))
            elif option == "parameter" or private:
                name = name.removeprefix("_")
                settings.append((setting(version, name) or name, value))
            elif name not in IGNORED:
                remap.setdefault(version, {})[name] = value
        elif version == "ros1" or option:
            rest.append(argument)
        option = "remap"
    settings = [*_parameters(dict(settings), files), *settings]
    settings += [(f"{version}.remap", json.dumps(names)) for version, names in remap.items()]
    return [*rest, *(part for name, value in settings for part in ("--set", f"{name}={value}"))]


def _parameters(given: dict[str, str], files: Sequence[Path]) -> list[tuple[str, str]]:
    """Return the settings of parameter files, and of the parameter server if roslaunch has named the node."""
    found: list[tuple[str, Any]] = []
    for file in files:
        found += from_file(file, given.get("ros2.node", "ravestate"), given.get("ros2.namespace", ""))
    if "ros1.node" in given:
        namespace = given.get("ros1.namespace") or os.environ.get("ROS_NAMESPACE", "")
        found += from_server(given["ros1.node"], namespace)
    return [(name, json.dumps(value)) for name, value in found]
