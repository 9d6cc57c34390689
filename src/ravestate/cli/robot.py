"""``ravestate robot``: a stand-in robot with a face on a web page, alone or controlled by an agent."""

from __future__ import annotations

import argparse
import asyncio
from contextlib import AsyncExitStack
from typing import TYPE_CHECKING, Any

from ravestate.cli import agent as agents
from ravestate.cli import browser, complete
from ravestate.errors import PlatformError
from ravestate.settings import load_settings

if TYPE_CHECKING:
    from ravestate.loading.spec import AgentSpec
    from ravestate.runtime.agent import Agent


def add_arguments(parser: argparse.ArgumentParser) -> None:
    agents.add_arguments(parser)
    complete.add_arguments(parser)
    parser.add_argument("--agent", action="store_true", help="also run the complete agent, which controls the robot")
    parser.add_argument(
        "--on", choices=("auto", "bus", "ros1", "ros2"), default="auto",
        help="where the robot's topics are: ROS 1, ROS 2, or the built-in bus; by default a ROS that runs here, else the bus",
    )  # fmt: skip
    parser.add_argument(
        "--robot", help="the robot: roboy, turtlebot, or a data file (default: the setting roboyio.robot)"
    )
    parser.add_argument("--bus", help="the address of the bus (default: the setting roboyio.bus)")
    parser.add_argument("--port", type=int, default=8421, help="the port of the page; 0 takes a free one")
    browser.add_argument(parser)


def run(options: argparse.Namespace) -> int:
    if options.robot:
        options.sets.append(f"roboyio.robot={options.robot}")
    if options.bus:
        options.sets.append(f"roboyio.bus={options.bus}")
    named = bool(options.modules or options.file)
    alone = not named and not options.agent
    behind = [] if named or alone else complete.names(options)
    chosen = agents.load_agent(options, ["roboyio", *behind])
    if behind:
        complete.leave_out_absent(chosen, options.command)
        complete.choose_small_talk(chosen, options.command)
        chosen.settings.setdefault("emotion", {}).setdefault("emoji", False)  # the robot's face shows the feelings
    try:
        asyncio.run(_serve(options, chosen, alone))
    except ModuleNotFoundError as error:
        raise PlatformError(f"the robot's page needs {error.name}: pip install 'ravestate[web,ros]'") from error
    return 0


async def _serve(options: argparse.Namespace, chosen: AgentSpec, alone: bool) -> None:
    from ravestate.modules import roboyio, ros1, ros2
    from ravestate.modules.platform.roboyio.page_server import PageServer
    from ravestate.modules.platform.roboyio.stand_in import StandIn
    from ravestate.modules.platform.ros import Bus, host_and_port
    from ravestate.runtime.agent import Agent
    from ravestate.runtime.run import asked_by_signals, run_context, until_first_ends

    all_settings: Any = load_settings([roboyio.module, ros1.module, ros2.module], _known(chosen.settings))
    settings = all_settings["roboyio"]
    robot = roboyio.load_robot(settings.robot)
    link: str = options.on if options.on != "auto" else await _running(all_settings)
    async with AsyncExitStack() as stack:
        if link == "bus":
            host, port = host_and_port(settings.bus)
            bus = await stack.enter_async_context(Bus(port, host))
            node = ros2.make_node(ros2.Settings(backend="bus", bus=bus.address, node="stand_in"))
            chosen.settings.setdefault("roboyio", {}).update(link="bus", bus=bus.address)
        else:
            module: Any = ros1 if link == "ros1" else ros2
            node = module.make_node(all_settings[link].model_copy(update={"node": "stand_in"}))
            chosen.settings.setdefault("roboyio", {}).update(link=link)
        stack.push_async_callback(node.close)
        stand_in = StandIn(robot, node)
        stack.push_async_callback(stand_in.close)
        server = await stack.enter_async_context(PageServer(stand_in, options.port))
        where = "the built-in bus" if link == "bus" else f"ROS {link[-1]}"
        print(f"{robot.name} is at {server.address}, its topics are on {where} (Ctrl-C ends it)", flush=True)
        await browser.open_page(server.address, options.browser)
        if alone:
            stopped = asyncio.Event()
            with asked_by_signals(stopped.set):
                await stopped.wait()
            return
        agent: Agent = Agent(*chosen.modules, **chosen.options())
        await _talk(agent, run_context, until_first_ends)


async def _talk(agent: Agent, run_context: Any, until_first_ends: Any) -> None:
    from ravestate.modules import roboyio
    from ravestate.runtime.run import run_servers

    others = [each.serve for each in agent.policy.modules if each.serve and each is not roboyio.module]
    if others:
        await run_servers(agent, [*others, roboyio.serve])
    else:
        await run_context(agent.context())


def _known(settings: dict[str, Any]) -> dict[str, Any]:
    return {name: values for name, values in settings.items() if name in ("roboyio", "ros1", "ros2")}


async def _running(settings: dict[str, Any]) -> str:
    """Return ``ros1`` if a ROS 1 master answers, ``ros2`` if a ROS 2 installation is sourced, else ``bus``."""
    import os
    from urllib.parse import urlsplit

    master = settings["ros1"].master or os.environ.get("ROS_MASTER_URI", "")
    place = urlsplit(master or "http://127.0.0.1:11311")
    try:
        _, writer = await asyncio.wait_for(asyncio.open_connection(place.hostname, place.port or 11311), 1.0)
        writer.close()
        return "ros1"
    except (OSError, TimeoutError, ValueError):  # ValueError: the address is wrong
        pass
    return "ros2" if os.environ.get("ROS_VERSION") == "2" else "bus"
