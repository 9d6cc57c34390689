"""Fixtures: a real network of ROS 1 and a real network of ROS 2, each with another node."""

from collections.abc import Iterator

import pytest

from modules.platform.ros.networks import Network, network


@pytest.fixture(scope="session")
def ros1_network() -> Iterator[Network]:
    with network(1) as made:
        yield made


@pytest.fixture(scope="session")
def ros2_network() -> Iterator[Network]:
    with network(2) as made:
        yield made


@pytest.fixture(params=[1, 2], ids=["ros1", "ros2"])
def either(request: pytest.FixtureRequest) -> Network:
    return request.getfixturevalue(f"ros{request.param}_network")
