"""``ravestate ros``: check an agent's topics and services, list the network's topics, show a topic's messages."""

from __future__ import annotations

import argparse
import asyncio
import json
import math
import sys
from collections.abc import Awaitable, Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from ravestate.cli.agent import load_agent
from ravestate.errors import PlatformError, nearest
from ravestate.loading.spec import AgentSpec

if TYPE_CHECKING:
    from ravestate.modules.platform.ros import Node
    from ravestate.modules.platform.ros.checking import Bound

LONG = 64
"""If a list has more items than this, `echo` shows only its beginning."""
LOOKS = 24
"""Look for a topic this many times: ROS 2 nodes find each other one by one, and slowly on a busy machine."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    checking = actions.add_parser(
        "check",
        help="show the topics of an agent, and whether other nodes use them; without an agent, check ROS itself",
        description="Show the topics, services and actions of an agent's slots, whether other nodes use them, and whether the types match. "
        "Without an agent, show whether ROS is installed and its network answers. Exit code 1: something is missing.",
    )
    checking.add_argument("modules", nargs="*", metavar="MODULE", help="the agent: modules or an agent file")
    checking.add_argument("-f", "--file", metavar="FILE", help="an agent file")
    listing = actions.add_parser("topics", help="list the topics, services and actions of the network")
    echoing = actions.add_parser(
        "echo", help="print the messages of a topic, one line of JSON for each; NaN and infinity become null"
    )
    echoing.add_argument("topic", metavar="TOPIC", help="the topic's name, such as /chat")
    echoing.add_argument("--type", help="the type of its messages, if no node publishes yet")
    echoing.add_argument("-n", "--count", type=int, default=0, help="end after this many messages")
    for action in (checking, listing, echoing):
        action.add_argument(
            "--set", dest="sets", action="append", default=[], metavar="MODULE.KEY=VALUE",
            help="a setting, e.g. ros2.domain=7 or ros2.backend=bus (may be repeated)",
        )  # fmt: skip
        if action is not checking:
            action.add_argument(
                "--version", type=int, choices=(1, 2), help="ROS 1 or ROS 2; by default, the one on this machine"
            )


def run(options: argparse.Namespace) -> int:
    options.seed = None
    try:
        if options.action == "check":
            return asyncio.run(_check_agent(options) if options.modules or options.file else _check_machine(options))
        return asyncio.run(_with_node(options, _topics if options.action == "topics" else _echo))
    except TimeoutError as error:
        raise PlatformError(str(error)) from error


def _settings(options: argparse.Namespace) -> dict[str, Any]:
    from ravestate.modules import ros1, ros2
    from ravestate.settings import load_settings

    agent = AgentSpec()
    agent.load([("ros1", Path()), ("ros2", Path())])
    for text in options.sets:
        agent.set(text)
    agent.check()
    return dict(load_settings([ros1.module, ros2.module], agent.settings))


def _make(version: int, settings: dict[str, Any]) -> Node:
    from ravestate.modules import ros1, ros2

    module: Any = ros1 if version == 1 else ros2
    return module.make_node(settings[f"ros{version}"])


async def _check_machine(options: argparse.Namespace) -> int:
    settings, works = _settings(options), 0
    for version in (1, 2):
        node = _make(version, settings)
        try:
            graph = await node.graph()
            print(f"ok       ros{version}  {len(graph['topics'])} topics, {len(graph['services'])} services")
            works += 1
        except PlatformError as error:
            print(f"MISSING  {error}" if str(error).startswith("ros") else f"MISSING  ros{version}  {error}")
        finally:
            await node.close()
    return 0 if works else 1


async def _check_agent(options: argparse.Namespace) -> int:
    from ravestate.modules.platform.ros import TopicSlot
    from ravestate.modules.platform.ros.checking import Line, check
    from ravestate.runtime.agent import Agent

    spec = load_agent(options)
    agent = Agent(*spec.modules, **spec.options())
    slots = [slot for slot in agent.policy.slots.values() if isinstance(slot, TopicSlot)]
    wanted: list[tuple[Node, Sequence[Bound]]] = [
        (_make(version, dict(agent.settings)), own)
        for version in (1, 2)
        if (own := [slot for slot in slots if slot.binding.version == version])
    ]
    if any(module.name == "roboyio" for module in agent.policy.modules):
        wanted.append(_robot(dict(agent.settings)))
    lines: list[Line] = []
    for node, bound in wanted:
        try:
            lines += await check(node, bound)
        except PlatformError as error:
            lines += [Line(False, each.name, str(error)) for each in bound]
        finally:
            await node.close()
    if not lines:
        print("this agent has no slot that is a topic, a service or an action", file=sys.stderr)
        return 0
    width = max(len(line.what) for line in lines)
    for line in lines:
        print(f"{'ok' if line.good else 'FAULT':<7}  {line.what:<{width}}  {line.text}")
    return int(not all(line.good for line in lines))


def _robot(settings: dict[str, Any]) -> tuple[Node, Sequence[Bound]]:
    """Return a node on the network of the agent's robot, and the parts of the robot."""
    from ravestate.modules import roboyio, ros2

    own = settings["roboyio"]
    robot = roboyio.load_robot(own.robot)
    if own.link == "bus":
        node = ros2.make_node(ros2.Settings(backend="bus", bus=own.bus))
    else:
        node = _make(int(own.link[-1]), settings)
    if robot.definitions is not None:
        node.types.definitions.add(robot.definitions)
    return node, robot.parts(1 if own.link == "ros1" else 2)


async def _with_node(
    options: argparse.Namespace, act: Callable[[argparse.Namespace, Node, dict[str, Any]], Awaitable[int]]
) -> int:
    settings = _settings(options)
    faults: list[str] = []
    for version in (options.version,) if options.version else (2, 1):
        node = _make(version, settings)
        try:
            try:
                graph = await node.graph(10.0 if options.version else 6.0)
            except PlatformError as error:
                faults.append(str(error))
                continue
            if not options.version and version == 2 and options.action == "echo" and not _finds(graph, options.topic):
                graph = await _look_again(node, options.topic)
                if not _finds(graph, options.topic) and not options.type:
                    faults.append(f"ros2: no topic {options.topic}{nearest(options.topic, _names(graph))}")
                    continue
            return await act(options, node, graph)
        finally:
            await node.close()
    raise PlatformError("; ".join(faults))


def _names(graph: dict[str, Any]) -> list[str]:
    return [row["name"] for row in graph["topics"]]


def _finds(graph: dict[str, Any], topic: str) -> bool:
    return any(row["name"] == topic and row["types"] for row in graph["topics"])


async def _look_again(node: Node, topic: str) -> dict[str, Any]:
    """Return the network's topics, services and actions (its graph) as soon as the topic is among them.

    Return the graph without the topic after `LOOKS` attempts, which take at least six seconds.
    """
    graph: dict[str, Any] = {}
    for _ in range(LOOKS):
        graph = await node.graph()
        if _finds(graph, topic):
            break
        await asyncio.sleep(0.25)
    return graph


async def _topics(options: argparse.Namespace, node: Node, graph: dict[str, Any]) -> int:
    if not options.version or options.version == 2:
        graph = await _look_again(node, "")
    from ravestate.modules.platform.ros.checking import counted

    for kind, nouns in (
        ("topics", ("publishers", "subscribers")),
        ("services", ("servers",)),
        ("actions", ("servers",)),
    ):
        for row in sorted(graph[kind], key=lambda row: row["name"]):
            if any(row[noun] for noun in nouns):  # other nodes use it
                ends = ", ".join(counted(row[noun], noun) for noun in nouns)
                print(f"{kind[:-1]:<7}  {row['name']}  {', '.join(row['types']) or '?'}  {ends}")
    return 0


async def _echo(options: argparse.Namespace, node: Node, graph: dict[str, Any]) -> int:
    from ravestate.modules.platform.ros import plain, quality

    if not _finds(graph, options.topic) and not options.type:
        graph = await _look_again(node, options.topic)
    row = next((row for row in graph["topics"] if row["name"] == options.topic), None)
    if row is None and not options.type:
        raise PlatformError(
            f"there is no topic {options.topic}{nearest(options.topic, _names(graph))}; ravestate ros topics lists all "
            "topics. To wait until a node publishes this topic, name its type, e.g. --type std_msgs/String"
        )
    done, count = asyncio.Event(), 0

    def show(message: Any) -> None:
        nonlocal count
        count += 1
        print(json.dumps(_shortened(plain(message)), ensure_ascii=False), flush=True)
        if count == options.count:
            done.set()

    best = row is not None and row.get("reliability") == ["best_effort"]
    qos = quality("sensor_data" if best else None, depth=100, latch=False)
    type_: str = options.type or (row["types"][0] if row is not None and row["types"] else "")
    if not type_:
        raise PlatformError(f"the type of {options.topic} is not known: name it, e.g. --type std_msgs/String")
    node.subscribe(
        options.topic, type_, lambda message: None if done.is_set() else show(message), latest=False, qos=qos
    )
    await done.wait()
    return 0


def _shortened(value: Any) -> Any:
    """Return plain data for JSON, with only the beginnings of long lists, such as the pixels of an image."""
    if isinstance(value, dict):
        fields = cast("dict[str, Any]", value)
        return {key: _shortened(item) for key, item in fields.items()}
    if isinstance(value, list):
        items = cast("list[Any]", value)
        if len(items) > LONG:
            return [*_shortened(items[:8]), f"... {len(items)} values"]
        return [_shortened(item) for item in items]
    return None if isinstance(value, float) and not math.isfinite(value) else value
