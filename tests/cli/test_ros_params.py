"""Settings from a real parameter server of ROS 1."""

import xmlrpc.client
from collections.abc import Iterator

import pytest

from modules.platform.ros.networks import Ros1
from ravestate.cli.ros_args import translate


@pytest.fixture
def server(monkeypatch: pytest.MonkeyPatch) -> Iterator[xmlrpc.client.ServerProxy]:
    network = Ros1()
    monkeypatch.setenv("ROS_MASTER_URI", network.environment["ROS_MASTER_URI"])
    with xmlrpc.client.ServerProxy(network.environment["ROS_MASTER_URI"]) as made:
        yield made
    network.stop()


def test_the_private_parameters_of_a_node_become_settings(server: xmlrpc.client.ServerProxy) -> None:
    server.setParam("/roslaunch", "/robot/guide/idle/bored_after", 9.0)
    server.setParam("/roslaunch", "/robot/guide/rate", 3)  # no module has this name
    server.setParam("/roslaunch", "/use_sim_time", True)
    assert translate(["run", "guide.py", "__name:=guide", "__ns:=/robot", "__log:=/tmp/log"]) == [
        "run", "guide.py", "--set", "idle.bored_after=9.0", "--set", "ros1.use_sim_time=true", "--set", "ros1.node=guide",
        "--set", "ros1.namespace=/robot",
    ]  # fmt: skip
    assert translate(["run", "guide.py", "__name:=other"])[2:] == [
        "--set", "ros1.use_sim_time=true", "--set", "ros1.node=other",
    ]  # fmt: skip


def test_without_a_ros_master_no_parameters_become_settings(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_MASTER_URI", "http://127.0.0.1:1")
    assert translate(["run", "__name:=guide"]) == ["run", "--set", "ros1.node=guide"]
