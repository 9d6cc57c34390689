"""Convert ROS parameters into settings: from a ROS 2 parameter file, or from the ROS 1 parameter server."""

from __future__ import annotations

import os
import xmlrpc.client
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, cast

from ravestate.errors import UsageError
from ravestate.yaml_text import load_yaml

PARAMETERS = "ros__parameters"
SIMULATED = "use_sim_time"
"""This parameter says whether time is simulated. In ROS 2, each node has its own; in ROS 1, all nodes share one. It is
also a setting of `ros1` and `ros2`."""
OTHERS = ("qos_overrides", "start_type_description_service")
"""ROS 2 gives every node parameters whose names begin with one of these words. They are not settings."""

Found = list[tuple[str, Any]]


def from_file(path: Path, node: str, namespace: str) -> Found:
    """Return the settings that a ROS 2 parameter file has for a node or for all nodes, each with its value.

    Args:
        path: The file. A launch file names it with ``--params-file``.
        node: The node's name.
        namespace: The node's namespace, such as ``/robot``.

    Raises:
        UsageError: The file is missing, or is not a parameter file.
    """
    try:
        document = load_yaml(path.read_text("utf-8"), str(path))
    except (OSError, ValueError) as error:
        raise UsageError(f"cannot read the parameter file {path}: {error}") from error
    if not isinstance(document, Mapping):
        raise UsageError(f"{path} is not a parameter file: such a file begins with a node's name, or with /**")
    own = "/" + f"{namespace}/{node}".strip("/")
    found: Found = []
    for name, content in cast("Mapping[str, Any]", document).items():
        if name in ("/**", "/*") or "/" + name.strip("/") in (own, f"/{node}"):
            inside = cast("dict[str, Any]", content) if isinstance(content, dict) else {}
            parameters = inside.get(PARAMETERS)
            if not isinstance(parameters, dict):
                raise UsageError(f"{path}: {name} has no {PARAMETERS}")
            found += _settings("ros2", parameters)
    return found


def from_server(node: str, namespace: str) -> Found:
    """Return settings with their values: a node's private parameters on the ROS 1 parameter server, and `SIMULATED`.

    ``roslaunch`` writes the private parameters to the server. Without a master, the result is empty.
    """
    uri = os.environ.get("ROS_MASTER_URI") or "http://localhost:11311"
    own = "/" + f"{namespace}/{node}".strip("/")
    try:
        with xmlrpc.client.ServerProxy(uri) as server:
            code, _, content = cast("Any", server.getParam("/ravestate", own))
            found = list(_settings("ros1", content)) if code == 1 and isinstance(content, dict) else []
            code, _, simulated = cast("Any", server.getParam("/ravestate", f"/{SIMULATED}"))
    except (OSError, xmlrpc.client.Error):
        return []
    return [*found, *([(f"ros1.{SIMULATED}", simulated)] if code == 1 else [])]


def setting(version: str, name: str) -> str | None:
    """Return the setting ``module.key`` that a parameter sets; None if the parameter concerns no module."""
    if name == SIMULATED:
        return f"{version}.{SIMULATED}"
    return name if "." in name and not name.startswith(OTHERS) else None


def _settings(version: str, parameters: Any, above: str = "") -> Iterator[tuple[str, Any]]:
    """Yield settings and values. ``idle: {bored_after: 9}`` and ``idle.bored_after: 9`` are the same."""
    for key, value in parameters.items():
        name = f"{above}{key}"
        if "." not in name and isinstance(value, Mapping):
            yield from _settings(version, value, f"{name}.")
        elif (known := setting(version, name)) is not None:
            yield known, value
