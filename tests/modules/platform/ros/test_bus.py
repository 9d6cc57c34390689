"""Nodes on the built-in bus."""

import asyncio
import socket
from typing import Any

import pytest

from modules.platform.ros.networks import PATIENCE, opened, until
from ravestate.errors import PlatformError
from ravestate.modules import ros1, ros2
from ravestate.modules.platform.ros import Bus, Node, quality

ALL = quality(None, depth=10, latch=False)
LATCHED = quality("latched", depth=1, latch=True)


def on(bus: Bus) -> Node:
    return ros2.make_node(ros2.Settings(backend="bus", bus=bus.address))


def test_topics_services_and_the_graph_work_on_the_bus() -> None:
    async def main() -> None:
        async with Bus(0) as bus, opened(on(bus)) as robot, opened(on(bus)) as agent:
            heard: list[str] = []
            robot.subscribe("/chat", "std_msgs/String", lambda message: heard.append(message.data), qos=ALL)

            async def serve(request: Any) -> dict[str, Any]:
                if not request.data:
                    raise ValueError("the lamp is broken")
                return {"success": True, "message": "on"}

            robot.offer("/lamp", "std_srvs/SetBool", serve)
            await until(lambda: bus.find("server", "/lamp"))
            chat = agent.advertise("/chat", "std_msgs/String", qos=ALL)
            chat.publish("hello")
            lamp = agent.client("/lamp", "std_srvs/SetBool", timeout=5.0)
            assert (await lamp.call(True)).message == "on"
            with pytest.raises(PlatformError, match="the lamp is broken"):
                await lamp.call(False)
            with pytest.raises(PlatformError, match="nobody offers /other"):
                await agent.client("/other", "std_srvs/SetBool", timeout=5.0).call(True)
            assert heard == ["hello"]
            graph = await agent.graph()
            assert graph["topics"] == [
                {"name": "/chat", "types": ["std_msgs/msg/String"], "publishers": 0, "subscribers": 1}
            ]
            assert graph["services"] == [{"name": "/lamp", "types": ["std_srvs/srv/SetBool"], "servers": 1}]

    asyncio.run(main())


def test_a_late_subscriber_gets_a_large_latched_message() -> None:
    async def main() -> None:
        async with Bus(0) as bus, opened(on(bus)) as one, opened(on(bus)) as other:
            image = one.advertise("/image", "sensor_msgs/Image", latch=True, qos=LATCHED)
            image.publish({"height": 2, "width": 500_000, "data": bytes(range(250)) * 4_000})
            await until(lambda: bus.find("publisher", "/image"))
            got: list[Any] = []
            other.subscribe("/image", "sensor_msgs/Image", got.append, qos=LATCHED)
            await until(lambda: got)
            assert got[0].data.tobytes() == bytes(range(250)) * 4_000

    asyncio.run(main())


def test_a_late_subscriber_of_another_type_gets_a_warning_instead_of_a_latched_message(
    caplog: pytest.LogCaptureFixture,
) -> None:
    async def main() -> None:
        async with Bus(0) as bus, opened(on(bus)) as one, opened(on(bus)) as other:
            sign = one.advertise("/sign", "std_msgs/String", qos=LATCHED)
            sign.publish("abc")
            await until(lambda: bus.find("publisher", "/sign"))
            heard: list[Any] = []
            other.subscribe("/sign", "std_msgs/Float64", heard.append, qos=LATCHED)
            signs: list[str] = []
            other.subscribe("/sign", "std_msgs/String", lambda message: signs.append(message.data), qos=LATCHED)
            await until(lambda: signs)  # all that the bus sends to the earlier subscriber has come, too
            assert (signs, heard) == (["abc"], [])
            assert "/sign carries std_msgs/msg/String, not std_msgs/msg/Float64" in caplog.text
            assert "a message is not of the type" not in caplog.text

    asyncio.run(main())


def test_a_node_waits_for_its_bus_and_reconnects_after_a_restart() -> None:
    async def main() -> None:
        async with Bus(0) as bus:
            port = int(bus.address.rpartition(":")[2])
        node = ros2.make_node(ros2.Settings(backend="bus", bus=f"127.0.0.1:{port}"))
        async with opened(node):
            heard: list[str] = []
            node.subscribe("/chat", "std_msgs/String", lambda message: heard.append(message.data), qos=ALL)
            for n in range(2):
                async with Bus(port) as bus, opened(on(bus)) as other:
                    await until(lambda: bus.find("subscriber", "/chat"))  # on the new bus
                    other.advertise("/chat", "std_msgs/String", qos=ALL).publish(f"round {n}")
                    await until(lambda: f"round {n}" in heard)  # noqa: B023
            assert heard == ["round 0", "round 1"]

    asyncio.run(main())


def test_a_node_that_is_closed_while_it_connects_closes_its_socket(monkeypatch: pytest.MonkeyPatch) -> None:
    tried: list[socket.socket] = []

    async def never(sock: socket.socket, address: Any) -> None:
        tried.append(sock)
        await asyncio.get_running_loop().create_future()

    async def main() -> None:
        monkeypatch.setattr(asyncio.get_running_loop(), "sock_connect", never)
        async with opened(ros2.make_node(ros2.Settings(backend="bus"))) as node:
            node.start()
            await until(lambda: tried)
        await until(lambda: tried[0].fileno() == -1)

    asyncio.run(asyncio.wait_for(main(), PATIENCE))


def test_wrong_types_and_addresses_are_refused_with_a_reason(caplog: pytest.LogCaptureFixture) -> None:
    async def main() -> None:
        async with Bus(0) as bus, opened(on(bus)) as one, opened(on(bus)) as other:
            one.subscribe("/chat", "std_msgs/Int32", print, qos=ALL)
            await until(lambda: bus.find("subscriber", "/chat"))
            other.advertise("/chat", "std_msgs/String", qos=ALL).publish("hello")
            await until(lambda: "/chat carries std_msgs/msg/String, not std_msgs/msg/Int32" in caplog.text)
        for address in ("here", "127.0.0.1:99999"):
            node = ros1.make_node(ros1.Settings(backend="bus", bus=address))
            with pytest.raises(PlatformError, match="write HOST:PORT"):
                node.start()
        async with opened(ros1.make_node(ros1.Settings(backend="bus", bus="no..host:7411"))) as node:
            node.start()
            await until(lambda: "waits for the bus at no..host:7411" in caplog.text)
        with (
            socket.create_server(("127.0.0.1", 0)) as taken,
            pytest.raises(PlatformError, match="does another stand-in robot run"),
        ):
            async with Bus(taken.getsockname()[1]):
                pass

    async def limited() -> None:
        async with asyncio.timeout(PATIENCE):
            await main()

    asyncio.run(limited())


def test_a_channel_with_a_rate_limit_skips_messages_but_never_the_latest() -> None:
    async def main() -> None:
        async with Bus(0) as bus, opened(on(bus)) as one, opened(on(bus)) as other:
            newest: list[int] = []
            every: list[int] = []
            one.subscribe("/number", "std_msgs/Int32", lambda message: newest.append(message.data), rate=5, qos=ALL)
            one.subscribe(
                "/number", "std_msgs/Int32", lambda message: every.append(message.data), latest=False, qos=ALL
            )
            await until(lambda: len(bus.find("subscriber", "/number")) == 2)
            number = other.advertise("/number", "std_msgs/Int32", qos=ALL)
            for n in range(200):
                number.publish(n)
            await until(lambda: newest and newest[-1] == 199)
            assert every == list(range(200))
            assert len(newest) == 2  # the first message, and the last one after the pause

    asyncio.run(main())


def test_the_calls_of_a_server_that_goes_away_fail_immediately() -> None:
    async def main() -> None:
        async with Bus(0) as bus, opened(on(bus)) as robot, opened(on(bus)) as agent:
            asked = asyncio.Event()

            async def serve(request: Any) -> Any:
                asked.set()
                await asyncio.get_running_loop().create_future()

            robot.offer("/lamp", "std_srvs/SetBool", serve)
            await until(lambda: bus.find("server", "/lamp"))
            short = agent.client("/lamp", "std_srvs/SetBool", timeout=0.05)
            with pytest.raises(PlatformError, match="did not answer within"):
                await short.call(True)
            await until(lambda: not bus.calls)  # the bus has dropped the call
            lamp = agent.client("/lamp", "std_srvs/SetBool", timeout=60.0)
            asked.clear()
            call = asyncio.ensure_future(lamp.call(True))
            await asked.wait()
            await robot.close()
            with pytest.raises(PlatformError, match="the node of the service is gone"):
                await call
            await until(lambda: not bus.calls)

    asyncio.run(main())
