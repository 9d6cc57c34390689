"""The data files of robots."""

from pathlib import Path
from types import SimpleNamespace
from typing import Literal

import pytest

from ravestate.errors import DeclarationError
from ravestate.modules.platform.roboyio.robot import Direction, load_robot


@pytest.mark.parametrize("name", ["roboy", "turtlebot"])
def test_the_data_files_of_the_built_in_robots_are_complete(name: str) -> None:
    robot = load_robot(name)
    assert robot.hear and robot.speak and robot.express and robot.head["yaw"].low < 0 < robot.head["yaw"].high
    assert set(robot.express.faces) == {"neutral", "happy", "shy", "surprised", "affectionate", "sad", "thinking"}


def test_the_data_file_of_roboy_has_the_names_of_its_topics_and_services() -> None:
    robot = load_robot("roboy")
    assert robot.hear and robot.hear.topic == "/roboy/cognition/speech/recognition"
    assert robot.speak and robot.speak.service == "/roboy/cognition/speech/synthesis/talk"
    assert robot.express and robot.express.service == "/roboy/cognition/face/show_emotion"
    assert robot.head["yaw"].topic == "/sphere_head_axis0/sphere_head_axis0/target"


def test_directions_in_degrees_become_radians_between_minus_pi_and_pi() -> None:
    port = Direction(topic="/d", type="std_msgs/Int32", field="data", unit="degrees")

    class Message:
        data = 270

    assert port.radians(Message()) == pytest.approx(-1.5708, abs=1e-3)
    assert port.pack(3) == {"data": 3}


@pytest.mark.parametrize("unit", ["radians", "degrees"])
@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_a_sensor_that_sends_no_number_gives_no_direction(unit: Literal["radians", "degrees"], value: float) -> None:
    port = Direction(topic="/d", type="std_msgs/Float32", field="data", unit=unit)
    assert port.radians(SimpleNamespace(data=value)) is None


def test_wrong_robot_names_and_files_are_refused_with_a_message(tmp_path: Path) -> None:
    with pytest.raises(DeclarationError, match="did you mean 'roboy'"):
        load_robot("robby")
    file = tmp_path / "robot.yaml"
    file.write_text("name: X\nhear: {topic: /a, service: /b, type: std_msgs/String, field: data}\n")
    with pytest.raises(DeclarationError, match=r"hear: .*either `topic` or `service`"):
        load_robot(str(file))
    file.write_text("name: X\nspeek: {topic: /a, type: std_msgs/String, field: data}\n")
    with pytest.raises(DeclarationError, match="speek"):
        load_robot(str(file))
