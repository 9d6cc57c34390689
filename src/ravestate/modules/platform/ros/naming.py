"""Names of topics and services, and the quality of service of topics."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ravestate.errors import DeclarationError, nearest

QUALITY = {"depth": 10, "reliability": "reliable", "durability": "volatile"}
"""The quality of service that ROS 2 gives to a topic by default."""

PROFILES: Mapping[str, Mapping[str, Any]] = {
    "default": QUALITY,
    "sensor_data": {**QUALITY, "depth": 5, "reliability": "best_effort"},
    "latched": {**QUALITY, "depth": 1, "durability": "transient_local"},
}
"""The profiles for the quality of service, by name."""

CHOICES = {"reliability": ("reliable", "best_effort"), "durability": ("volatile", "transient_local")}


def resolve(name: str, node: str, namespace: str, remap: Mapping[str, str]) -> str:
    """Return the absolute name of a topic or a service.

    Args:
        name: ``/absolute``, ``relative`` to the namespace, or ``~private`` to the node.
        node: The node's name, without its namespace.
        namespace: The namespace, such as ``/robot``.
        remap: Old name → new name. All names may be absolute, relative or private.
    """
    absolute = _absolute(name, node, namespace)
    for old, new in remap.items():
        if _absolute(old, node, namespace) == absolute:
            return _absolute(new, node, namespace)
    return absolute


def _absolute(name: str, node: str, namespace: str) -> str:
    space = "/" + namespace.strip("/")
    if name.startswith("~"):
        name = f"{space}/{node}/{name[1:]}"
    elif not name.startswith("/"):
        name = f"{space}/{name}"
    return "/" + "/".join(part for part in name.split("/") if part)


def quality(qos: str | Mapping[str, Any] | None, *, depth: int, latch: bool) -> dict[str, Any]:
    """Return a quality of service with all its values.

    Args:
        qos: The name of a profile, or some of the values ``depth``, ``reliability`` and ``durability``. None means the
            profile ``default``, but with the argument `depth`.
        depth: The maximum number of messages in the queue, if `qos` sets no depth.
        latch: Whether late subscribers get the last message, whatever `qos` says. If false, `qos` decides this.

    Raises:
        DeclarationError: There is no such profile, or a value is wrong.
    """
    if isinstance(qos, str):
        if qos not in PROFILES:
            raise DeclarationError(
                f"qos={qos!r} is not a profile{nearest(qos, PROFILES)}: write {', '.join(map(repr, PROFILES))}"
            )
        whole = {**PROFILES[qos]}
    else:
        whole = {**QUALITY, "depth": depth, **(qos or {})}
    if latch:
        whole["durability"] = "transient_local"
    for key, value in whole.items():
        if key not in QUALITY:
            raise DeclarationError(f"qos has no {key!r}{nearest(key, QUALITY)}: write {', '.join(QUALITY)}")
        if key in CHOICES and value not in CHOICES[key]:
            raise DeclarationError(f"qos: {key}={value!r}: write {' or '.join(map(repr, CHOICES[key]))}")
        if key == "depth" and (not isinstance(value, int) or value < 1):
            raise DeclarationError(f"qos: depth={value!r} must be 1 or more")
    return whole
