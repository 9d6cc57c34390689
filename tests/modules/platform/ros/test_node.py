"""The agent's nodes together with real nodes of rospy and rclpy in other processes."""

import asyncio
import logging
import os
import signal
import xmlrpc.client
from typing import Any

import numpy
import pytest

from modules.platform.ros.networks import Network, Ros1, Ros2, opened, until
from ravestate.errors import PlatformError
from ravestate.modules.platform.ros import Node, quality

ALL = quality(None, depth=1000, latch=False)
LATCHED = quality("latched", depth=1, latch=True)


async def echo(node: Node) -> list[str]:
    """Send texts to the peer on /chat; return its answers on /back."""
    heard: list[str] = []
    node.subscribe("/back", "std_msgs/String", lambda message: heard.append(message.data), latest=False, qos=ALL)
    chat = node.advertise("/chat", "std_msgs/String", qos=ALL)
    await until(lambda: heard, lambda: chat.publish("are you there?"))
    for n in range(3):
        chat.publish({"data": f"text {n}"})
    await until(lambda: "echo text 2" in heard)
    return [text for text in heard if text.startswith("echo text")]


async def numbers(node: Node, got: list[int], count: int) -> list[int]:
    """Let the peer publish `count` numbers, 1,000 per second; return the numbers that arrived in `got`."""
    burst = node.advertise("/burst", "std_msgs/String", qos=ALL)
    await until(lambda: got, lambda: burst.publish("-1 1 0"))
    burst.publish(f"0 {count} 1000")
    await until(lambda: got[-1] == count - 1)
    return [n for n in got if n >= 0]


def test_messages_reach_another_node_and_its_answers_come_back(either: Network) -> None:
    async def main() -> None:
        async with either.lent() as node:
            assert await echo(node) == [f"echo text {n}" for n in range(3)]

    either.run(main)


def test_every_message_of_a_fast_topic_arrives_in_order(either: Network) -> None:
    async def main() -> None:
        async with either.lent() as node:
            got: list[int] = []
            node.subscribe(
                "/numbers", "std_msgs/Int32", lambda message: got.append(message.data), latest=False, qos=ALL
            )
            # A second channel of the topic skips messages. Even so, the first channel must get all of them.
            node.subscribe("/numbers", "std_msgs/Int32", lambda message: None, qos=ALL)
            assert await numbers(node, got, 400) == list(range(400))

    either.run(main)


def test_a_channel_with_a_rate_gets_only_some_messages_of_a_fast_topic(either: Network) -> None:
    async def main() -> None:
        async with either.lent() as node:
            got: list[int] = []
            node.subscribe("/numbers", "std_msgs/Int32", lambda message: got.append(message.data), rate=10, qos=ALL)
            some = await numbers(node, got, 300)
            assert len(some) < 15
            assert some == sorted(some)

    either.run(main)


def test_images_arrive_in_shared_memory_without_a_copy(either: Network) -> None:
    async def main() -> None:
        async with either.lent() as node:
            got: list[Any] = []
            node.subscribe("/images", "sensor_msgs/Image", got.append, latest=False, qos=ALL)
            show = node.advertise("/show", "std_msgs/Int32", qos=ALL)
            await until(lambda: len(got) >= 5, lambda: show.publish(2), 0.2)
            image = got[0]
            assert (image.height, image.width, image.encoding) == (480, 640, "rgb8")
            assert image.data.shape == (640 * 480 * 3,) and image.data.dtype == numpy.uint8
            assert not image.data.flags.owndata  # the array is a view of the shared memory

    either.run(main)


def test_a_service_answers_and_a_call_to_a_silent_service_times_out(either: Network) -> None:
    async def main() -> None:
        async with either.lent() as node:
            lamp = node.client("/lamp", "std_srvs/SetBool", timeout=10.0)
            answer = await lamp.call({"data": True})
            assert (answer.success, answer.message) == (True, "on")
            answers = await asyncio.gather(*(lamp.call(bool(n % 2)) for n in range(6)))
            assert [each.message for each in answers] == ["off", "on"] * 3
            silent = node.client("/silent", "std_srvs/SetBool", timeout=0.2)
            with pytest.raises(PlatformError, match=r"/silent did not answer within 0.2 s"):
                await silent.call(True)
            nobody = node.client("/nobody", "std_srvs/SetBool", timeout=2.0)
            with pytest.raises(PlatformError, match="nobody offers the service /nobody"):
                await nobody.call(True)
            with pytest.raises(PlatformError, match="has no field 'date'; did you mean 'data'"):
                await lamp.call({"date": True})

    either.run(main)


def test_calls_that_time_out_leave_no_threads_in_the_bridge(ros1_network: Network) -> None:
    async def main() -> None:
        async with ros1_network.lent() as node:
            await node.client("/lamp", "std_srvs/SetBool", timeout=10.0).call(True)
            threads = f"/proc/{node.pid}/task"
            before = len(os.listdir(threads))
            silent = node.client("/silent", "std_srvs/SetBool", timeout=0.3)
            calls = asyncio.gather(*(silent.call(True) for _ in range(20)), return_exceptions=True)
            await until(lambda: len(os.listdir(threads)) >= before + 15)
            await calls
            await until(lambda: len(os.listdir(threads)) < before + 5)

    ros1_network.run(main)


def test_a_service_of_the_agent_can_be_called_over_the_network(either: Network) -> None:
    async def main() -> None:
        async with either.lent() as node:

            async def serve(request: Any) -> dict[str, Any]:
                return {"success": not request.data, "message": "ours"}

            node.offer("/ours", "std_srvs/SetBool", serve)
            answer = await node.client("/ours", "std_srvs/SetBool", timeout=10.0).call(False)
            assert (answer.success, answer.message) == (True, "ours")

    either.run(main)


def test_a_killed_bridge_is_restarted_with_all_its_channels(either: Network, caplog: pytest.LogCaptureFixture) -> None:
    async def main() -> None:
        async with either.lent() as node:
            heard: list[str] = []
            node.subscribe("/back", "std_msgs/String", lambda message: heard.append(message.data), qos=ALL)
            chat = node.advertise("/chat", "std_msgs/String", qos=ALL)
            sign = node.advertise("/sign", "std_msgs/String", latch=True, qos=LATCHED)
            sign.publish("open")
            await until(lambda: heard, lambda: chat.publish("before"))
            assert node.pid is not None
            before = node.restarts
            asyncio.get_running_loop().call_soon(os.kill, node.pid, signal.SIGKILL)
            with pytest.raises(PlatformError, match="killed by signal 9"):
                await node.client("/silent", "std_srvs/SetBool", timeout=30.0).call(True)
            await until(lambda: "echo after" in heard, lambda: chat.publish("after"))
            assert node.restarts == before + 1
            signs: list[str] = []
            node.subscribe("/sign", "std_msgs/String", lambda message: signs.append(message.data), qos=LATCHED)
            await until(lambda: signs)  # the new bridge has latched the message again
            assert signs == ["open"]

    with caplog.at_level(logging.CRITICAL, "ravestate"):
        either.run(main)


def test_a_message_of_the_wrong_type_is_reported_and_dropped(either: Network, caplog: pytest.LogCaptureFixture) -> None:
    async def main() -> None:
        async with either.lent() as node:
            got: list[Any] = []
            node.subscribe("/wrong", "std_msgs/String", got.append, qos=ALL)
            await until(lambda: "/Float32" in caplog.text)
            assert not got

    either.run(main)
    wrong = "std_msgs/Float32" if either.version == 1 else "std_msgs/msg/Float32"
    assert (
        "/wrong: /peer" in caplog.text
        and f"publishes {wrong}, " in caplog.text
        and f"write type='{wrong}'" in caplog.text
    )


def test_a_message_type_that_is_not_installed_is_read_from_its_definition_file(ros1_network: Network) -> None:
    async def main() -> None:
        async with ros1_network.lent() as node:
            got: list[Any] = []
            node.subscribe("/own", "robot_msgs/Reading", got.append, qos=ALL)
            await until(lambda: got)
            assert (got[0].value, got[0].unit) == (7, "warm")

    ros1_network.run(main)


def test_messages_pass_while_the_bridge_is_stopped(ros1_network: Network) -> None:
    async def main() -> None:
        async with ros1_network.lent() as node:
            heard: list[str] = []
            node.subscribe(
                "/back", "std_msgs/String", lambda message: heard.append(message.data), latest=False, qos=ALL
            )
            chat = node.advertise("/chat", "std_msgs/String", qos=ALL)
            await until(lambda: heard, lambda: chat.publish("one"))
            assert node.pid is not None
            os.kill(node.pid, signal.SIGSTOP)
            try:
                chat.publish("two")
                await until(lambda: "echo two" in heard)
            finally:
                os.kill(node.pid, signal.SIGCONT)

    ros1_network.run(main)


def test_a_later_channel_of_a_topic_gets_the_latched_message(ros1_network: Network) -> None:
    async def main() -> None:
        async with ros1_network.lent() as node:
            got: list[Any] = []
            first = node.subscribe("/own", "robot_msgs/Reading", got.append, qos=ALL)
            await until(lambda: got)
            node.subscribe("/own", "robot_msgs/Reading", got.append, qos=ALL)
            await until(lambda: len(got) == 2)
            first.close()
            again = node.subscribe("/own", "robot_msgs/Reading", lambda _: got.append("never"), qos=ALL)
            again.close()  # in the same turn of the loop, so it gets no message
            node.subscribe("/own", "robot_msgs/Reading", got.append, qos=ALL)
            await until(lambda: len(got) == 3)
            assert [message.value for message in got] == [7, 7, 7]

    ros1_network.run(main)


def test_clock_messages_arrive_even_if_the_parameter_use_sim_time_is_set(ros1_network: Network) -> None:
    async def main() -> None:
        async with opened(ros1_network.node()) as node:
            got: list[Any] = []
            node.subscribe("/clock", "rosgraph_msgs/Clock", got.append, qos=ALL)
            speed = node.advertise("/speed", "std_msgs/Float32", qos=ALL)
            await until(lambda: got, lambda: speed.publish(1.0))

    with xmlrpc.client.ServerProxy(ros1_network.environment["ROS_MASTER_URI"]) as master:
        master.setParam("/test", "/use_sim_time", True)
        try:
            ros1_network.run(main)
        finally:
            master.deleteParam("/test", "/use_sim_time")


def test_two_nodes_exchange_messages_over_dds_without_ros(ros2_network: Network) -> None:
    async def main() -> None:
        async with ros2_network.lent(backend="dds") as one, opened(ros2_network.node(backend="dds")) as other:
            got: list[Any] = []
            other.subscribe("/own", "robot_msgs/Reading", got.append, qos=ALL)
            own = one.advertise("/own", "robot_msgs/Reading", qos=ALL)
            await until(lambda: got, lambda: own.publish({"value": 7, "unit": "warm"}))
            assert (got[0].value, got[0].unit) == (7, "warm")
            client = one.client("/lamp", "std_srvs/SetBool", timeout=5.0)
            with pytest.raises(PlatformError, match=r"DDS alone .* carries only topics"):
                await client.call(True)

    ros2_network.run(main)


def test_a_node_with_the_dds_backend_exchanges_messages_with_a_real_node(ros2_network: Network) -> None:
    async def main() -> None:
        async with ros2_network.lent(backend="dds") as node:
            assert await echo(node) == [f"echo text {n}" for n in range(3)]

    ros2_network.run(main)


def test_an_incompatible_quality_of_service_is_reported_with_the_right_profile(
    ros2_network: Network, caplog: pytest.LogCaptureFixture
) -> None:
    async def main() -> None:
        async with ros2_network.lent() as node:
            node.subscribe("/sensor", "std_msgs/Int32", print, qos=ALL)
            await until(lambda: "qos='sensor_data'" in caplog.text)
            got: list[Any] = []
            node.subscribe("/sensor", "std_msgs/Int32", got.append, qos=quality("sensor_data", depth=1, latch=False))
            await until(lambda: got)

    ros2_network.run(main)


def test_an_action_gives_feedback_and_a_result_and_can_be_cancelled(ros2_network: Network) -> None:
    async def main() -> None:
        async with ros2_network.lent() as node:
            action = node.action("/count", "test_msgs/Fibonacci", timeout=10.0)
            feedback: list[Any] = []
            result = await action.call({"order": 6}, feedback.append)
            assert list(result.sequence) == [0, 1, 1, 2, 3, 5]
            assert feedback
            cancelled: list[str] = []
            node.subscribe(
                "/cancelled", "std_msgs/String", lambda message: cancelled.append(message.data),
                qos=LATCHED,
            )  # fmt: skip
            feedback.clear()
            goal = asyncio.ensure_future(action.call(1000, feedback.append))
            await until(lambda: feedback)
            goal.cancel()
            await until(lambda: cancelled)

    ros2_network.run(main)


def test_the_graph_names_topics_services_and_types(either: Network) -> None:
    async def main() -> None:
        async with either.lent() as node:
            own = node.advertise("/only_ours", "std_msgs/String", qos=ALL)
            found: dict[str, Any] = {}

            async def look() -> None:
                graph = await node.graph()
                found.update({row["name"]: row for kind in ("topics", "services") for row in graph[kind]})

            while not found.get("/lamp", {}).get("servers") or not found.get("/back", {}).get("publishers"):
                await look()
            assert found["/back"]["publishers"] == 1
            assert found["/back"]["types"] in (["std_msgs/String"], ["std_msgs/msg/String"])
            assert found["/lamp"]["types"] in (["std_srvs/SetBool"], ["std_srvs/srv/SetBool"])
            assert found["/lamp"]["servers"] == 1
            assert found.get(own.name, {"publishers": 0})["publishers"] == 0  # the graph counts only other nodes

    either.run(main)


def test_a_node_reconnects_after_a_restart_of_the_master_and_the_peer(caplog: pytest.LogCaptureFixture) -> None:
    network = Ros1()

    async def main() -> None:
        async with opened(network.node()) as node:
            heard: list[str] = []
            node.subscribe("/back", "std_msgs/String", lambda message: heard.append(message.data), qos=ALL)
            chat = node.advertise("/chat", "std_msgs/String", qos=ALL)
            await asyncio.to_thread(network.start_peer)
            await until(lambda: heard, lambda: chat.publish("one"))
            network.stop()
            await until(lambda: "master" in caplog.text and "is gone" in caplog.text)
            network.start_master()
            await asyncio.to_thread(network.start_peer)
            heard.clear()
            await until(lambda: heard, lambda: chat.publish("two"))
            assert heard[0] == "echo two"

    try:
        asyncio.run(main())
    finally:
        network.stop()


def test_a_node_reconnects_after_a_restart_of_the_peer(either: Network) -> None:
    async def main() -> None:
        async with either.lent() as node:
            heard: list[str] = []
            node.subscribe("/back", "std_msgs/String", lambda message: heard.append(message.data), qos=ALL)
            chat = node.advertise("/chat", "std_msgs/String", qos=ALL)
            await until(lambda: heard, lambda: chat.publish("one"))
            await asyncio.to_thread(either.stop_peer)  # with SIGKILL
            await asyncio.to_thread(either.start_peer)
            heard.clear()
            await until(lambda: heard, lambda: chat.publish("two"))
            assert heard[0] == "echo two"

    either.run(main)


def test_without_ros_the_error_says_what_to_install() -> None:
    async def main(network: type[Ros1] | type[Ros2]) -> None:
        settings = network.module.Settings(python="/nowhere/python")
        node = network.module.make_node(settings)
        with pytest.raises(PlatformError, match="/nowhere/python"):
            await node.graph()
        await node.close()

    for network in (Ros1, Ros2):
        asyncio.run(main(network))
