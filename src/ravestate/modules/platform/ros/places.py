"""Find the ROS installation on this machine, and the interpreter and the environment for a bridge.

A bridge is a process that runs a ROS library for the agent.
"""

from __future__ import annotations

import contextlib
import os
import shlex
import shutil
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path

from ravestate.errors import PlatformError
from ravestate.folders import user_folder

CHILDREN = Path(__file__).with_name("children")

PATIENCE = 10.0
"""If an interpreter does not say within this many seconds that it has a package, assume that it lacks the package."""

ROS1_MEND = "ROS 1 needs rospy: apt-get install python3-rospy ros-core, or name the Python that has it in ros1.python"
ROS2_MEND = (
    "ROS 2 needs rclpy: source your ROS 2 installation, or `make ros`, or pip install ros-rclpy ros-rmw-fastrtps-cpp "
    "ros-std-msgs in an environment and name its Python in ros2.python. For topics alone, pip install cyclonedds is enough"
)


@dataclass(frozen=True, slots=True)
class Place:
    """A bridge's program, with the interpreter and the environment of a ROS installation.

    Attributes:
        name: The name of the ROS version in messages: ``ros1`` or ``ros2``.
        program: The file's name in the folder `CHILDREN`.
        python: The interpreter.
        setup: A shell script to source first; None if there is none.
        environment: Environment variables to set.
        mend: The remedy. The message about a failed start ends with it.
    """

    name: str
    program: str
    python: str
    setup: Path | None = None
    environment: Mapping[str, str] = field(default_factory=dict[str, str])
    mend: str = ""

    def command(self, fd: int) -> list[str]:
        """Return the command that runs the program. `fd` is the file descriptor of its pipe."""
        line = [self.python, str(CHILDREN / self.program), str(fd)]
        if self.setup is None:
            return line
        return ["bash", "-c", f"source {shlex.quote(str(self.setup))} && exec {shlex.join(line)}"]

    @property
    def folders(self) -> list[Path]:
        """The folders with packages of message definitions."""
        paths = [Path(path) for path in os.environ.get("ROS_PACKAGE_PATH", "").split(":") if path]
        for variable in ("AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH"):
            paths += [Path(path) / "share" for path in os.environ.get(variable, "").split(":") if path]
        if self.setup is not None:
            paths.append(self.setup.parent / "share")
        return [*paths, Path(self.python).parent.parent / "share"]


def ros1_place(python: Path | None) -> Place:
    """Return the place of rospy.

    If `python` is given, this interpreter runs the bridge, unchecked. Otherwise, the search order is: the sourced
    ROS 1, a ROS 1 in /opt/ros, and Debian's rospy.

    Raises:
        PlatformError: The search finds no rospy.
    """
    if python is not None:
        return Place("ros1", "ros1_node.py", str(python.expanduser()), mend=f". {ROS1_MEND}")
    if os.environ.get("ROS_VERSION") == "1":
        return Place("ros1", "ros1_node.py", _system_python())
    for setup in sorted(Path("/opt/ros").glob("*/setup.bash"), reverse=True):
        if any(setup.parent.glob("lib/python3*/*-packages/rospy")):
            return Place("ros1", "ros1_node.py", _system_python(), setup)
    if Path("/usr/lib/python3/dist-packages/rospy").is_dir():
        return Place("ros1", "ros1_node.py", "/usr/bin/python3")
    raise PlatformError(ROS1_MEND)


def ros2_place(python: Path | None, backend: str = "auto") -> Place:
    """Return the place of rclpy or DDS.

    If `python` is given, this interpreter runs the bridge. With the backend ``auto``, the bridge then uses rclpy, or
    DDS if the interpreter has only DDS.

    Without `python`, the search order for rclpy is: the sourced ROS 2, a ROS 2 in /opt/ros, the agent's own environment,
    and the environment of ``make ros``. For DDS, it is: the agent's own environment, and the environment of ``make ros``.
    The backend ``auto`` looks for rclpy first, then for DDS.

    Args:
        python: The interpreter that the settings name, or None.
        backend: ``auto``, ``rclpy`` or ``dds``.

    Raises:
        PlatformError: The search finds nothing for this backend.
    """
    if python is not None:
        named = str(python.expanduser())
        only_dds = backend == "auto" and not _has(named, "rclpy") and _has(named, "cyclonedds")
        return _dds(named) if only_dds or backend == "dds" else _ros2(named)
    apart = [Path(sys.prefix).parent / ".venvs" / "ros2", user_folder("data") / "ros2"]
    if backend in ("auto", "rclpy"):
        if os.environ.get("ROS_VERSION") == "2":
            return _ros2(_system_python())
        for setup in sorted(Path("/opt/ros").glob("*/setup.bash"), reverse=True):
            if any(setup.parent.glob("lib/python3*/*-packages/rclpy")):
                return _ros2(_system_python(), setup)
        if find_spec("rclpy") is not None:
            return _ros2(sys.executable)
        for folder in apart:
            if any(folder.glob("lib/python3*/site-packages/rclpy")):
                return _ros2(str(folder / "bin" / "python"))
    if backend in ("auto", "dds"):
        if find_spec("cyclonedds") is not None:
            return _dds(sys.executable)
        for folder in apart:
            if any(folder.glob("lib/python3*/site-packages/cyclonedds")):
                return _dds(str(folder / "bin" / "python"))
    raise PlatformError(ROS2_MEND)


def _ros2(python: str, setup: Path | None = None) -> Place:
    return Place("ros2", "ros2_node.py", python, setup, mend=f". {ROS2_MEND}")


def _dds(python: str) -> Place:
    return Place("ros2", "dds_node.py", python, mend=". DDS needs cyclonedds: pip install cyclonedds")


def _has(python: str, package: str) -> bool:
    """Return whether an interpreter can find a package."""
    code = f"import importlib.util, sys; sys.exit(importlib.util.find_spec({package!r}) is None)"
    with contextlib.suppress(OSError, subprocess.TimeoutExpired):
        return subprocess.run([python, "-c", code], capture_output=True, timeout=PATIENCE, check=False).returncode == 0
    return False


def _system_python() -> str:
    """Return the system's interpreter, for which ROS is built. ``PATH`` may lead to another interpreter."""
    return "/usr/bin/python3" if Path("/usr/bin/python3").exists() else shutil.which("python3") or sys.executable
