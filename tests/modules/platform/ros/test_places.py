"""The place of a bridge: its program fits the packages of the interpreter that the settings name."""

import sys
from pathlib import Path

import pytest

from ravestate.modules.platform.ros.places import ros2_place


def interpreter(folder: Path, *packages: str) -> Path:
    """Return a Python that has these packages."""
    for package in packages:
        (folder / f"{package}.py").touch()
    python = folder / "python"
    python.write_text(f'#!/bin/sh\nPYTHONPATH="{folder}" exec "{sys.executable}" "$@"\n', encoding="utf-8")
    python.chmod(0o700)
    return python


@pytest.mark.parametrize(
    ("packages", "backend", "program"),
    [
        (("rclpy", "cyclonedds"), "auto", "ros2_node.py"),
        (("rclpy",), "auto", "ros2_node.py"),
        (("cyclonedds",), "auto", "dds_node.py"),
        (("cyclonedds",), "rclpy", "ros2_node.py"),
        (("rclpy",), "dds", "dds_node.py"),
        ((), "auto", "ros2_node.py"),
    ],
)
def test_the_packages_of_a_named_python_decide_between_rclpy_and_dds(
    tmp_path: Path, packages: tuple[str, ...], backend: str, program: str
) -> None:
    python = interpreter(tmp_path, *packages)
    place = ros2_place(python, backend)
    assert (place.program, place.python) == (program, str(python))


def test_a_named_python_that_does_not_exist_stays_the_place_so_that_the_error_names_it() -> None:
    assert ros2_place(Path("/nowhere/python")).python == "/nowhere/python"
