"""How much time does an agent add to a message of ROS, and does it keep up with fast topics?

- Share: a text goes to an echo node and back, and then a rule sends the next text. The floor is a bare rospy or rclpy
  node that does the same. Our share is the difference: the agent, and in ROS 2 two hops to the bridge. (The bridge is a
  process that connects the agent with ROS.)
- Stream: numbers come a thousand times a second. One slot takes all of them, another the latest. None may be lost, out
  of order or left waiting. Neither the agent nor its bridge may grow after the first quarter of the numbers.
- Images: 640x480 colour images come 30 times a second. The number of copies is the number of bytes that the bridge
  writes, divided by the number of bytes of the images. The agent reads the images in the memory that the bridge has
  written.
"""

from __future__ import annotations

import asyncio
import dataclasses
import itertools
import os
import socket
import statistics
import subprocess
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import ravestate as rs
from benchmarks.bench import Bench
from benchmarks.child import PEERS, Child
from benchmarks.figures import Figure, compare, measured
from benchmarks.peers.wire import serve
from ravestate.modules import ros1, ros2
from ravestate.modules.platform.ros.places import ros1_place, ros2_place

RATE = 1000
IMAGES = 30
SIZE = 3 * 640 * 480
GROWTH = 2_000_000
"""The number of bytes by which the size of a process may vary. A greater increase counts as growth."""
WAIT = 30.0
"""Seconds to wait for the other nodes."""


def ask(bench: Bench) -> Iterable[Figure]:
    """Measure both versions of ROS."""
    for version in (1, 2):
        yield from _ask(bench, version)


def _ask(bench: Bench, version: int) -> Iterable[Figure]:
    title = f"ROS {version}"
    bench.progress(f"{title}: echo")
    settings = network(bench, version)
    echo, floor, source = (node(bench, version, settings, name) for name in ("echo", "floor", "source"))
    echo.ask("echo")
    ours, theirs = [], []
    count = bench.several(2000, 300)
    for _ in bench.rounds(5, 2):
        theirs.append(statistics.median(floor.ask("talk", count=count)))
        child = agent(settings)
        ours.append(statistics.median(child.ask("talk", version=version, settings=settings["agent"], count=count)))
        child.close()
    bare = "bare rospy" if version == 1 else "bare rclpy"
    share = [one - other for one, other in zip(ours, theirs, strict=True)]
    yield compare("ros", f"{title}: our share of an echo", share, bare, theirs, target="<= 2", reach=lambda x: x <= 2)
    yield compare("ros", f"{title}: an echo", ours, bare, theirs)
    seconds = bench.several(60, 10)
    bench.progress(f"{title}: {RATE} messages a second for {seconds} s")
    child = agent(settings)
    source.ask("numbers", count=RATE * seconds, rate=RATE)
    found = child.ask("stream", version=version, settings=settings["agent"], count=RATE * seconds)
    child.close()
    none: Any = {"unit": "", "target": "none", "reach": lambda x: x == 0}
    yield measured("ros", f"{title}: lost or misordered of {RATE * seconds}", [float(found["lost"])], **none)
    yield measured("ros", f"{title}: outdated latest values", [float(found["old"])], **none)
    yield measured("ros", f"{title}: left waiting", [float(found["waiting"])], **none)
    for part in ("agent", "bridge"):
        yield measured(
            "ros", f"{title}: growth of the {part}", [float(found[part])], unit="B", target="none (< 2 MB)",
            reach=lambda x: x < GROWTH,
        )  # fmt: skip
    yield measured("ros", f"{title}: work of agent and bridge", [found["work"]], unit="core")
    seconds = bench.several(20, 4)
    bench.progress(f"{title}: images for {seconds} s")
    child = agent(settings)
    source.ask("images", count=IMAGES * seconds, rate=IMAGES)
    found = child.ask("look", version=version, settings=settings["agent"], count=IMAGES * seconds)
    child.close()
    yield measured("ros", f"{title}: images lost", [float(found["lost"])], **none)
    yield measured(
        "ros", f"{title}: copies of an image", [found["copies"]], unit="", target="<= 1", reach=lambda x: x <= 1.01
    )


# ------------------------------------------------------------------------------------- the other nodes


def network(bench: Bench, version: int) -> dict[str, Any]:
    """Return the settings of an agent and the environment variables of a node; start a master if one is needed."""
    if version == 2:
        domain = 1 + os.getpid() % 100
        return {"agent": {"domain": domain}, "nodes": {"ROS_DOMAIN_ID": str(domain)}}
    with socket.socket() as sock:
        sock.bind(("127.0.0.1", 0))
        port = sock.getsockname()[1]
    uri = f"http://127.0.0.1:{port}"
    logs = bench.enter_context(tempfile.TemporaryDirectory())
    variables = {"ROS_MASTER_URI": uri, "ROS_IP": "127.0.0.1", "ROS_LOG_DIR": logs}
    master = subprocess.Popen(
        ["rosmaster", "--core", "-p", str(port)], env={**os.environ, **variables}, stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )  # fmt: skip
    bench.callback(master.wait)
    bench.callback(master.terminate)
    end = time.monotonic() + WAIT
    while True:
        try:
            socket.create_connection(("127.0.0.1", port), 1.0).close()
            break
        except OSError:
            if time.monotonic() > end:
                raise
            time.sleep(0.05)
    return {"agent": {"master": uri, "ip": "127.0.0.1"}, "nodes": variables}


def node(bench: Bench, version: int, settings: dict[str, Any], name: str) -> Child:
    """Return a bare node, in a process of its own."""
    place = ros1_place(None) if version == 1 else ros2_place(None, "rclpy")
    script = dataclasses.replace(place, program=str(PEERS / f"ros{version}_nodes.py"))
    child = Child("env", *(f"{key}={value}" for key, value in settings["nodes"].items()), *script.command(0))
    bench.callback(child.close)
    child.ask("start", WAIT, name=name)
    return child


def agent(settings: dict[str, Any]) -> Child:
    """Return a process for an agent."""
    return Child.ours("benchmarks.questions.ros")


# ------------------------------------------------------------------------------------------- the agent


def talk(version: int, settings: dict[str, Any], count: int) -> list[float]:
    """Send a text to the echo, and the next text when the first is back; return the seconds of each round."""
    ros: Any = (ros1, ros2)[version - 1]
    module = rs.Module("agent", requires=[ros])
    back = ros.subscriber(module, "back", topic="/back", type="std_msgs/String", keep="all")
    chat = ros.publisher(module, "chat", topic="/chat", type="std_msgs/String")
    times: list[float] = []
    done = asyncio.Event()

    @module.rule(when=back.changed, writes=chat, detached=True)
    async def again(ctx: rs.RuleContext) -> None:
        times.append(time.perf_counter())
        if len(times) <= count:
            ctx[chat] = {"data": "text"}
        else:
            done.set()

    async def main() -> None:
        async with rs.Context(module, settings={ros.module.name: settings}) as context, asyncio.timeout(120):
            await _both(context, ros, "/chat", "/back")
            context.put(chat, {"data": "text"})
            await done.wait()

    asyncio.run(main())
    return [after - before for before, after in itertools.pairwise(times)]


def stream(version: int, settings: dict[str, Any], count: int) -> dict[str, float]:
    """Take a stream of numbers. Return the losses, the growth of the processes (bytes), and their work (cores)."""
    ros: Any = (ros1, ros2)[version - 1]
    module = rs.Module("agent", requires=[ros])
    all_ = ros.subscriber(module, "all", topic="/numbers", type="std_msgs/Int32", keep="all")
    latest = ros.subscriber(module, "latest", topic="/numbers", type="std_msgs/Int32")
    got: list[int] = []
    newest: list[int] = []

    @module.rule(when=all_.changed)
    async def take(ctx: rs.RuleContext) -> None:
        got.append(ctx.payload(all_.changed).data)

    @module.rule(when=latest.changed)
    async def follow(ctx: rs.RuleContext) -> None:
        newest[:] = [*newest[-1:], ctx.payload(latest.changed).data]
        old.append(len(newest) == 2 and newest[0] >= newest[1])

    old: list[bool] = []

    async def main() -> dict[str, float]:
        async with rs.Context(module, settings={ros.module.name: settings}) as context:
            made = await _made(context, ros)
            await _both(context, ros)
            rest = len(context.snapshot()["groups"])
            first: dict[str, int] = {}
            begin, used = time.monotonic(), 0.0
            stalled = 0
            while not got or got[-1] < count - 1:
                before = len(got)
                await asyncio.sleep(0.5)
                stalled = stalled + 1 if len(got) == before else 0
                if stalled > 2 * WAIT:
                    break
                if not first and len(got) >= count / 4:
                    first = {"agent": _memory(os.getpid()) - _held(got), "bridge": _memory(made.pid)}
                    begin, used = time.monotonic(), time.process_time() + _work(made.pid)
            work = (time.process_time() + _work(made.pid) - used) / (time.monotonic() - begin)
            grown = {"agent": _memory(os.getpid()) - _held(got), "bridge": _memory(made.pid)}
            await asyncio.sleep(0.5)
            return {
                "lost": count - len(got) + sum(one >= other for one, other in itertools.pairwise(got)),
                "old": sum(old) + (newest[-1:] != [count - 1]),
                "waiting": len(context.snapshot()["groups"]) - rest,
                "work": work,
                **{part: max(0, grown[part] - first.get(part, 0)) for part in grown},
            }

    return asyncio.run(main())


def look(version: int, settings: dict[str, Any], count: int) -> dict[str, float]:
    """Take images. Return the number of lost images, and the number of copies of each image."""
    ros: Any = (ros1, ros2)[version - 1]
    module = rs.Module("agent", requires=[ros])
    images = ros.subscriber(module, "images", topic="/images", type="sensor_msgs/Image", keep="all")
    views: list[bool] = []

    @module.rule(when=images.changed)
    async def take(ctx: rs.RuleContext) -> None:
        data = ctx.payload(images.changed).data
        views.append(len(data) == SIZE and not data.flags.owndata)

    async def main() -> dict[str, float]:
        async with rs.Context(module, settings={ros.module.name: settings}) as context:
            made = await _made(context, ros)
            begin = _written(made.pid)
            stalled = 0
            while len(views) < count and stalled < WAIT:
                before = len(views)
                await asyncio.sleep(0.5)
                stalled = 0 if len(views) > before else stalled + 0.5
            copies = (_written(made.pid) - begin) / (max(1, len(views)) * SIZE)
            copies += sum(not view for view in views) / max(1, len(views))  # copies that the agent itself makes
            return {"lost": count - len(views), "copies": copies}

    return asyncio.run(main())


async def _made(context: rs.Context, ros: Any) -> Any:
    """Return the agent's node, once its bridge works."""
    async with asyncio.timeout(WAIT):
        made = context.read(ros.node) or await context.next(ros.node.changed)
        await made.ready.wait()
    return made


async def _both(context: rs.Context, ros: Any, *topics: str) -> None:
    """Wait until another node publishes or subscribes to each topic."""
    made = await _made(context, ros)
    async with asyncio.timeout(WAIT):
        while True:
            rows = {row["name"]: row for row in (await made.graph())["topics"]}
            if all(topic in rows and rows[topic]["publishers"] + rows[topic]["subscribers"] for topic in topics):
                break
            await asyncio.sleep(0.1)
    await asyncio.sleep(0.5)


def _memory(pid: int) -> int:
    """Return the bytes of memory that a process holds for itself alone."""
    for line in Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("RssAnon:"):
            return int(line.split()[1]) * 1024
    raise AssertionError("no RssAnon")


def _held(numbers: list[int]) -> int:
    """Return an estimate of the bytes of the measurement's own list: for each entry, a number and a pointer to it."""
    return len(numbers) * (32 + 8)


def _work(pid: int) -> float:
    """Return the seconds of processor time that a process has used."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(") ")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _written(pid: int) -> int:
    """Return the bytes that a process has written to files and memory, without the bytes that it has sent over
    sockets."""
    for line in Path(f"/proc/{pid}/io").read_text().splitlines():
        if line.startswith("wchar:"):
            return int(line.split()[1])
    raise AssertionError("no wchar")


if __name__ == "__main__":
    serve(talk, stream, look)
