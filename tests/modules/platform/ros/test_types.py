"""Message types and their definitions, and messages made from plain data."""

from pathlib import Path
from typing import Any

import numpy
import pytest

from modules.platform.ros.networks import OWN
from ravestate.errors import PlatformError
from ravestate.modules.platform.ros.definitions import Definitions
from ravestate.modules.platform.ros.types import Types, plain

VALUES: list[tuple[str, Any, Any]] = [
    ("std_msgs/String", {"data": "hällo"}, {"data": "hällo"}),
    ("std_msgs/String", "short", {"data": "short"}),
    ("std_msgs/Float64", 3, {"data": 3.0}),
    ("std_msgs/Float64", numpy.int64(3), {"data": 3.0}),
    ("std_msgs/Empty", None, {}),
    ("geometry_msgs/Twist", {"linear": {"x": 1}}, {"linear": {"x": 1.0, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": 0.0}}),
    ("std_msgs/ColorRGBA", {"r": numpy.float32(0.5)}, {"r": 0.5, "g": 0.0, "b": 0.0, "a": 0.0}),
    ("std_msgs/UInt8MultiArray", {"data": b"\x01\x02"}, {"layout": {"dim": [], "data_offset": 0}, "data": [1, 2]}),
    ("std_msgs/UInt8MultiArray", {"data": numpy.arange(8, dtype=numpy.uint8).reshape(2, 2, 2)}, {"layout": {"dim": [], "data_offset": 0}, "data": [0, 1, 2, 3, 4, 5, 6, 7]}),
    ("std_msgs/Float32MultiArray", {"data": numpy.arange(6, dtype=numpy.float32)[::3]}, {"layout": {"dim": [], "data_offset": 0}, "data": [0.0, 3.0]}),
]  # fmt: skip


@pytest.mark.parametrize("version", [1, 2])
@pytest.mark.parametrize(("name", "value", "wanted"), VALUES)
def test_plain_data_can_be_encoded_as_a_message_and_decoded_again(
    version: Any, name: str, value: Any, wanted: Any
) -> None:
    types = Types(version)
    full = types.require(name)
    message = types.decode(types.encode(value, full), full)
    assert plain(message) == wanted
    assert types.encode(message, full) == types.encode(value, full)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("std_msgs/String", {"dat": "x"}, "no field 'dat'; did you mean 'data'"),
        ("std_msgs/String", {"data": 3}, r"std_msgs/msg/String.data takes string, not 3"),
        ("geometry_msgs/Twist", 3, "takes the fields linear: geometry_msgs/Vector3"),
        ("geometry_msgs/Twist", {"linear": {"x": "fast"}}, r"linear.x takes float64, not 'fast'"),
        ("std_msgs/UInt8", {"data": 300}, "does not fit"),
        ("std_msgs/UInt8MultiArray", {"data": numpy.array([1, 300])}, "data takes uint8, not 300"),
        ("std_msgs/UInt8MultiArray", {"data": [0.5]}, "data takes uint8, not 0.5"),
        ("std_msgs/Int32MultiArray", {"data": numpy.array([numpy.nan])}, "data takes int32, not nan"),
        ("geometry_msgs/PoseWithCovariance", {"covariance": numpy.eye(5)}, "takes 36 values, not 25"),
        ("sensor_msgs/CameraInfo", {"header": {"stamp": {"sec": True}}}, "takes int32, not True"),
        ("std_msgs/Float32", {"data": True}, "takes float32, not True"),
        ("std_msgs/Float64", {"data": 10**400}, "takes float64, not 1000"),
    ],
)
def test_the_error_names_a_value_that_does_not_fit_its_field(name: str, value: Any, words: str) -> None:
    types = Types(2)
    with pytest.raises(PlatformError, match=words):
        types.encode(value, types.require(name))


def test_definition_files_are_read_with_the_types_that_they_contain() -> None:
    for version in (1, 2):
        types = Types(version, Definitions((OWN,)))  # type: ignore[arg-type]
        name = types.require("robot_msgs/History", "srv")
        assert types.describe(f"{name}_Request") == "last: robot_msgs/Reading"
        answer = types.message({"all": [{"value": 1, "unit": "V"}, {"value": 2}], "done": True}, f"{name}_Response")
        again = types.decode(types.encode(answer, f"{name}_Response"), f"{name}_Response")
        assert plain(again) == {"all": [{"value": 1, "unit": "V"}, {"value": 2, "unit": ""}], "done": True}


def test_the_checksums_of_types_are_those_of_ros_1() -> None:
    types = Types(1)
    known = {
        "std_srvs/SetBool": "09fb03525b03e7ea1fd3992bafd87e16",
        "std_srvs/Trigger": "937c9679a518e3a18d831e57125ea522",
        "std_srvs/Empty": "d41d8cd98f00b204e9800998ecf8427e",
    }
    for name, md5 in known.items():
        assert types.ros1_definition(types.require(name, "srv"))[1] == md5
    types.definitions.add(OWN)
    types.require("actionlib/Test", "action")
    for name, md5 in {
        "actionlib/msg/TestActionGoal": "348369c5b403676156094e8c159720bf",
        "actionlib/msg/TestActionResult": "3d669e3a63aa986c667ea7b0f46ce85e",
        "actionlib/msg/TestActionFeedback": "6d3d0bf7fb3dda24779c010a9f3eb7cb",
    }.items():
        assert types.ros1_definition(name)[1] == md5
    assert types.ros1_definition("sensor_msgs/msg/Image")[1] == "060021388200f6f0f447d0fcd9c64743"


def test_an_unknown_or_broken_definition_is_an_error_with_a_reason(tmp_path: Path) -> None:
    with pytest.raises(PlatformError, match=r"no definition of std_msgs/msg/Strin: .*ros2.definitions"):
        Types(2).require("std_msgs/Strin")
    (tmp_path / "Bad.msg").write_text("int32 32 32")
    (tmp_path / "Half.srv").write_text("int32 a")
    types = Types(2, Definitions((tmp_path,)))
    with pytest.raises(PlatformError, match="definition of own_msgs/msg/Bad is wrong"):
        types.require("own_msgs/Bad")
    with pytest.raises(PlatformError, match="has 1 parts instead of 2"):
        types.require("own_msgs/Half", "srv")
    with pytest.raises(PlatformError, match="there is no file or folder"):
        Types(2, Definitions((tmp_path / "none",))).require("own_msgs/Bad")
    with pytest.raises(PlatformError, match="write PACKAGE/NAME"):
        Types(2).require("String")


def test_bytes_that_do_not_fit_the_type_are_refused() -> None:
    with pytest.raises(PlatformError, match="not of the type std_msgs/msg/String"):
        Types(2).decode(b"\x00\x01\x00\x00\xff\xff\xff\xff", "std_msgs/msg/String")
