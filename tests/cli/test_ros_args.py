"""The arguments that launch files of ROS pass to a node."""

import pytest

from ravestate.cli.ros_args import translate


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
            ["run", "--ros-args", "--remap", "a:=b", "--", "guide.py"],
            ["run", "guide.py", "--set", 'ros2.remap={"a": "b"}'],
        ),
    ],
)  # fmt: skip
def test_parameters_and_remappings_become_settings(given: list[str], wanted: list[str]) -> None:
    assert translate(given) == wanted
