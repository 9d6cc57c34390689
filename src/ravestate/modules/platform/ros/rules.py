"""The rule that connects a context to ROS. The modules `ros1` and `ros2` declare it."""

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
from .slots import bind_all, is_bound
from .types import Types


class NodeSettings(rs.Settings):
    """The settings that a node of ROS 1 and a node of ROS 2 have in common."""

    node: str = "ravestate"
    """The beginning of the node's name. The id of the agent's process follows, then a number for the process's further
    nodes."""
    namespace: str = ""
    """The namespace of relative names, such as ``/robot``."""
    remap: dict[str, str] = pydantic.Field(default_factory=dict[str, str])
    """The names of topics or services to replace, with their new names."""
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
    """Return a node. It connects when it is first used.

    Args:
        version: 1 or 2.
        settings: The node's settings.
        place: A function that finds the bridge's program.
        environment: Environment variables for the bridge.
        bus: Whether the node is on the built-in bus instead of ROS.
        failed: A function to call with the reason if no link is possible.
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
    node: rs.Slot[Node | None],
    make_node: Callable[[Any, Callable[[PlatformError], None] | None], Node],
) -> None:
    """Declare on a module the rule that makes the node.

    Args:
        module: ``ros1`` or ``ros2``.
        version: 1 or 2.
        node: The module's slot for the node.
        make_node: A function that makes a node. Its arguments are the module's settings and a function to call on failure.
    """

    @module.rule(when=rs.startup.detached(), writes=node, detached=True, background=True)
    async def connect(ctx: rs.RuleContext) -> rs.Resign | None:
        """Make the node, and open the channels of all slots that publish or call. In virtual time, do nothing.

        With `use_sim_time`, follow the topic ``/clock``. Slots that subscribe have rules of their own. If the agent has
        a slot of this version of ROS, and ROS is not installed here, the agent ends with a `PlatformError`.
        """
        if getattr(asyncio.get_running_loop(), "is_virtual", False):
            return rs.Resign("time is virtual: a test writes the slots, or plays a bag")
        made = make_node(ctx.settings, ctx.stop)
        try:
            if is_bound(ctx, version):
                made.start()
            ctx[node] = made  # before the first `await`, so that other rules for startup find the node
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


def follow_clock(ctx: rs.RuleContext, node: Node) -> None:
    """Let the context's clock follow the topic ``/clock``. Both then run at one speed, and stop at the same times.

    Raises:
        PlatformError: ROS is not installed here.
    """
    offset: float | None = None
    last = 0.0

    def tick(message: Any) -> None:
        nonlocal offset, last
        time = message.clock.sec + message.clock.nanosec / 1e9
        if offset is None or time < last:  # the first message, or the first after a restart of the simulation
            ctx.drive_clock(ctx.now)  # from now on, the clock moves only with `/clock`
            offset = ctx.now - time
        last = time
        ctx.drive_clock(time + offset)

    qos = quality({"depth": 1, "reliability": "best_effort"}, depth=1, latch=False)
    node.subscribe("/clock", "rosgraph_msgs/Clock", tick, qos=qos)
