"""The rule that connects a context to ROS. `ros1` and `ros2` declare it on themselves."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal

import pydantic

import ravestate as rs
from ravestate.errors import PlatformError

from .bus import bus_link
from .definitions import Definitions
from .naming import quality
from .node import MakeLink, Node
from .places import Place
from .process import BridgeProcess
from .slots import bind_all
from .types import Types


class NodeSettings(rs.Settings):
    """The settings of a node, of either version."""

    node: str = "ravestate"
    """The beginning of the node's name. The number of the agent's process follows it."""
    namespace: str = ""
    """The namespace of relative names, such as ``/robot``."""
    remap: dict[str, str] = pydantic.Field(default_factory=dict[str, str])
    """The name of a topic or service → the name that takes its place."""
    definitions: tuple[Path, ...] = ()
    """Your own ``.msg``, ``.srv`` and ``.action`` files, or folders that hold them."""
    python: Path | None = None
    """The Python that has ROS. By default, the agent looks for it."""
    use_sim_time: bool = False
    """Whether the agent's clock follows the topic ``/clock``."""
    bus: str = "127.0.0.1:7411"
    """The address of the built-in bus, for ``backend: bus``."""


def open_node(
    version: Literal[1, 2],
    settings: NodeSettings,
    place: Callable[[], Place],
    environment: dict[str, str],
    *,
    bus: bool,
    failed: Callable[[PlatformError], None] | None = None,
) -> Node:
    """Return a node, which connects at its first use.

    Args:
        version: 1 or 2.
        settings: The node's settings.
        place: A function that finds the bridge's program.
        environment: Environment variables for the bridge.
        bus: Whether the node is on the built-in bus instead of ROS.
        failed: A function to call with the reason if there can be no link.
    """

    def folders() -> list[Path]:
        try:
            return place().folders
        except PlatformError:
            return []

    def start(config: Any, handle: Any, ready: Any, lost: Any) -> BridgeProcess:
        return BridgeProcess(place(), config, handle=handle, ready=ready, lost=lost)

    make: MakeLink = bus_link(settings.bus) if bus else start

    return Node(
        f"ros{version}",
        Types(version, Definitions(settings.definitions, folders)),
        make,
        name=settings.node,
        namespace=settings.namespace,
        remap=settings.remap,
        environment=environment,
        failed=failed,
    )


def connect(
    module: rs.Module,
    version: Literal[1, 2],
    make_node: Callable[[Any, Callable[[PlatformError], None] | None], Node],
) -> rs.Slot[Node | None]:
    """Declare the slot with the node, and the rule that makes the node, on a module. Return the slot.

    Args:
        module: ``ros1`` or ``ros2``.
        version: 1 or 2.
        make_node: A function that makes a node from the module's settings and a function for failures.
    """
    node: rs.Slot[Node | None] = module.slot("node", None)

    @module.rule(when=rs.startup.detached(), writes=node, detached=True, background=True)
    async def connect(ctx: rs.RuleContext) -> rs.Resign | None:
        """Open the topics, services and actions of all slots. If the settings say so, follow the simulation's clock."""
        if getattr(asyncio.get_running_loop(), "is_virtual", False):
            return rs.Resign("time is virtual: a test writes the slots, or plays a bag")
        made = ctx[node] = make_node(ctx.settings, ctx.stop)  # at once, so that each rule of the startup finds the node
        try:
            await made.prepare()
            bind_all(ctx, made, version)
            if ctx.settings.use_sim_time:
                follow_clock(ctx, made)
            await asyncio.get_running_loop().create_future()
        except PlatformError as error:
            ctx.stop(error)
        finally:
            ctx[node] = None
            await made.close()
        return None

    return node


def follow_clock(ctx: rs.RuleContext, node: Node) -> None:
    """Let the context's clock follow the topic ``/clock``, at the same speed, and with the same stops.

    Raises:
        PlatformError: ROS is not installed here.
    """
    offset: float | None = None
    last = 0.0

    def tick(message: Any) -> None:
        nonlocal offset, last
        time = message.clock.sec + message.clock.nanosec / 1e9
        if offset is None or time < last:  # the first message, or the first after a restart of the simulation
            ctx.drive_clock(ctx.now)  # the clock stands still from here on
            offset = ctx.now - time
        last = time
        ctx.drive_clock(time + offset)

    qos = quality({"depth": 1, "reliability": "best_effort"}, depth=1, latch=False)
    node.subscribe("/clock", "rosgraph_msgs/Clock", tick, qos=qos)
