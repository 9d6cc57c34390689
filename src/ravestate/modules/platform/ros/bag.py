"""Play recorded bags of ROS into an agent, in virtual time."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any, Protocol

from ravestate.errors import PlatformError
from ravestate.runtime.context import Context

from .naming import resolve
from .slots import TopicSlot
from .types import Types


class Simulated(Protocol):
    """The part of a simulation (``ravestate.testing.simulate``) that a bag needs."""

    context: Context

    def put(self, slot: Any, value: Any) -> None: ...
    def advance(self, seconds: float) -> None: ...
    @property
    def now(self) -> float: ...


def play(sim: Simulated, bag: str | Path, *, types: Types | None = None) -> int:
    """Play a recorded bag into a simulated agent. Each message goes to the slots of its topic.

    Each message comes at its recorded time. This time is virtual, so a bag of one hour plays in seconds. Every
    playback leads to the same decisions.

    Args:
        sim: The simulation. The bag begins at the simulation's current time.
        bag: A ``.bag`` file of ROS 1, or a folder or file of ROS 2.
        types: The types of the bag's messages, if the bag does not contain their definitions. By default, these are
            the common types of ROS 2.

    Returns:
        The number of writes to slots. A message that goes to two slots counts twice.

    Raises:
        PlatformError: The bag cannot be read, the agent's slots follow none of its topics, or `rosbags` is missing.
    """
    path = Path(bag)
    slots: dict[str, list[TopicSlot]] = {}
    for slot in sim.context.policy.slots.values():
        if isinstance(slot, TopicSlot) and slot.binding.kind == "subscriber":
            settings: Any = sim.context.settings[f"ros{slot.binding.version}"]
            name = resolve(slot.binding.name, settings.node, settings.namespace, settings.remap)
            slots.setdefault(name, []).append(slot)
    try:
        highlevel = importlib.import_module("rosbags.highlevel")
    except ImportError as error:
        raise PlatformError(f"bags need {error.name}: pip install 'ravestate[ros]'") from error
    if not path.exists():
        raise PlatformError(f"there is no bag {path}")
    store = None if types is None else types.store
    start, count = sim.now, 0
    try:
        with highlevel.AnyReader([path], default_typestore=store or Types(2).store) as reader:
            wanted = [connection for connection in reader.connections if connection.topic in slots]
            if not wanted:
                raise PlatformError(
                    f"no slot of the agent follows a topic of {path}: the bag has {_listed(reader.topics)}; the agent "
                    f"follows {_listed(slots)}"
                )
            began = reader.start_time
            for connection, time, raw in reader.messages(connections=wanted):
                sim.advance(max(0.0, start + (time - began) / 1e9 - sim.now))
                message = reader.deserialize(raw, connection.msgtype)
                for slot in slots[connection.topic]:
                    sim.put(slot, message)
                    count += 1
    except highlevel.AnyReaderError as error:
        raise PlatformError(f"cannot read the bag {path}: {error}") from error
    return count


def _listed(names: Any) -> str:
    return ", ".join(sorted(names)) or "none"
