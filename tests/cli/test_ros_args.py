"""The arguments that launch files of ROS pass to a node."""

from pathlib import Path

import pytest

from ravestate.cli.ros_args import translate
from ravestate.errors import UsageError


@pytest.mark.parametrize(
    ("given", "wanted"),
    [
        (["run", "guide.py"], ["run", "guide.py"]),
        (
            ["run", "guide.py", "--ros-args", "-p", "idle.bored_after:=9", "-r", "/chat:=/talk", "-r", "__ns:=/robot"],
            [
                "run", "guide.py", "--set", "idle.bored_after=9", "--set", "ros2.namespace=/robot", "--set",
                'ros2.remap={"/chat": "/talk"}',
            ],
        ),
        (
            ["run", "guide.py", "_idle.bored_after:=9", "chat:=talk", "__name:=guide", "__log:=/tmp/log"],
            ["run", "guide.py", "--set", "idle.bored_after=9", "--set", "ros1.node=guide", "--set", 'ros1.remap={"chat": "talk"}'],
        ),
        (
            ["run", "guide.py", "--ros-args", "--log-level", "info", "--disable-rosout-logs", "-p", "use_sim_time:=true"],
            ["run", "guide.py", "--set", "ros2.use_sim_time=true"],
        ),
        (
            ["run", "--ros-args", "--remap", "a:=b", "--", "guide.py"],
            ["run", "guide.py", "--set", 'ros2.remap={"a": "b"}'],
        ),
    ],
)  # fmt: skip
def test_parameters_and_remappings_become_settings(given: list[str], wanted: list[str]) -> None:
    assert translate(given) == wanted


FILE = """
/**:
  ros__parameters:
    use_sim_time: true
    idle: {bored_after: 9.0}
/robot/guide:
  ros__parameters:
    roboyio.robot: turtlebot
    rate: 3
    qos_overrides: {/chat: {depth: 3}}
/other:
  ros__parameters:
    idle.bored_after: 1.0
"""


def test_a_parameter_file_of_a_launch_file_becomes_settings(tmp_path: Path) -> None:
    file = tmp_path / "launch_params"
    file.write_text(FILE)
    given = ["run", "guide.py", "--ros-args", "-r", "__node:=guide", "-r", "__ns:=/robot", "--params-file", str(file)]
    assert translate([*given, "-p", "idle.bored_after:=5"])[2:] == [
        "--set", "ros2.use_sim_time=true", "--set", "idle.bored_after=9.0", "--set", 'roboyio.robot="turtlebot"',
        "--set", "ros2.node=guide", "--set", "ros2.namespace=/robot", "--set", "idle.bored_after=5",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "words"), [("[1]", "not a parameter file"), ("/**: {a: 1}", "has no ros__parameters")]
)
def test_a_wrong_parameter_file_is_refused(tmp_path: Path, text: str, words: str) -> None:
    file = tmp_path / "params.yaml"
    file.write_text(text)
    with pytest.raises(UsageError, match=words):
        translate(["run", "--ros-args", "--params-file", str(file)])
    with pytest.raises(UsageError, match="cannot read the parameter file"):
        translate(["run", "--ros-args", "--params-file", str(tmp_path / "none")])
