"""Check whether other nodes use the topics, services and actions of an agent's slots, and whether the types match.

Say how to fix faults.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from ravestate.errors import PlatformError

from .definitions import full_name
from .node import Node
from .slots import Binding

KINDS = {"subscriber": "msg", "publisher": "msg", "service": "srv", "action": "action"}
OTHERS = {"subscriber": "publishers", "publisher": "subscribers", "service": "servers", "action": "servers"}
"""Kind of slot → the nodes that the slot needs at the other end, by the name that `Node.graph` uses for them."""
PLACES = {"subscriber": "topics", "publisher": "topics", "service": "services", "action": "actions"}

LOOKS = 8
"""Look at the network up to this many times, because other nodes show up one by one."""
PAUSE = 0.4
"""The seconds between two looks."""


class Bound(Protocol):
    """An object that is bound to the network: a slot, or a part of a robot."""

    @property
    def name(self) -> str: ...
    @property
    def binding(self) -> Binding: ...


@dataclass(frozen=True, slots=True)
class Line:
    """One line of the output: the result for one slot, or for one part of a robot.

    Attributes:
        good: Whether the slot or part is without faults.
        what: The name of the slot or part.
        text: The binding, followed by the nodes at the other end, or by a fault with its remedy.
    """

    good: bool
    what: str
    text: str


async def check(node: Node, slots: Iterable[Bound]) -> list[Line]:
    """Check all slots, or all parts of a robot, that use one node. Return a line for each.

    Raises:
        PlatformError: ROS is not installed here, or no ROS master (or bus) runs.
    """
    wanted = list(slots)
    lines: list[Line] = []
    for look in range(LOOKS):
        graph = await node.graph()
        lines = [look_at(slot, node, graph) for slot in wanted]
        if all(line.good for line in lines) or look == LOOKS - 1:
            break
        await asyncio.sleep(PAUSE)
    return lines


def look_at(slot: Bound, node: Node, graph: Mapping[str, list[dict[str, Any]]]) -> Line:
    """Return the line about a slot: whether the network has the nodes that the slot needs, with the right type."""
    binding = slot.binding
    name = node.absolute(binding.name)
    bound = f"{binding.kind} of {name} ({binding.type})"
    try:
        node.types.require(binding.type, KINDS[binding.kind])
    except PlatformError as error:
        return Line(False, slot.name, f"{bound}: {error}")
    row = next((row for row in graph[PLACES[binding.kind]] if row["name"] == name), None)
    count = 0 if row is None else row[OTHERS[binding.kind]]
    if not count or row is None:
        alike = [row for row in graph[PLACES[binding.kind]] if _has(row, binding.type, KINDS[binding.kind])]
        known = [row["name"] for row in alike if row["name"] != name]
        hint = (
            f"; this type is used by {', '.join(sorted(known)[:3])}: set `remap`, or write the name that you mean"
            if known
            else ""
        )
        return Line(False, slot.name, f"{bound}: no {OTHERS[binding.kind]}{hint or ': start the other node'}")
    if row["types"] and not _has(row, binding.type, KINDS[binding.kind]):
        return Line(
            False, slot.name, f"{bound}: the other end has {row['types'][0]}: write type={_short(row['types'][0])!r}"
        )
    reliable = binding.kind == "subscriber" and binding.options["qos"]["reliability"] == "reliable"
    if reliable and row.get("reliability") == ["best_effort"]:
        return Line(False, slot.name, f"{bound}: its publishers are best-effort: write qos='sensor_data'")
    return Line(True, slot.name, f"{bound}: {counted(count, OTHERS[binding.kind])}")


def counted(count: int, nouns: str) -> str:
    """Return a number with its noun, such as ``1 publisher`` for 1 and ``publishers``."""
    return f"{count} {nouns.removesuffix('s') if count == 1 else nouns}"


def _has(row: Mapping[str, Any], type_: str, kind: str) -> bool:
    return full_name(type_, kind) in [full_name(each, kind) for each in row["types"]]


def _short(name: str) -> str:
    parts = name.split("/")
    return f"{parts[0]}/{parts[-1]}"
