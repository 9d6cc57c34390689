"""OpenAI-compatible servers on this machine, and the chat models that they have."""

from __future__ import annotations

import asyncio
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any, cast

PORTS = {11434: "Ollama", 8080: "llama.cpp", 1234: "LM Studio", 8000: "vLLM"}
"""The usual ports of the programs that serve models, in the order of preference."""

PATIENCE = 1.0
"""Seconds for all servers together; they are asked at the same time."""

LIMIT = 1 << 20
"""The maximum size of a list of models, in bytes."""

# Models for other purposes than talk, and models that a server on this machine only passes on to a remote one.
_NOT_CHAT = re.compile(
    r"embed|rerank|minilm|whisper|\btts|\bbge|\be5-|\bgte-|nomic|mxbai|clip\b|diffusion|flux|guard|moderation|[-:]cloud$"
)
_SPECIAL = re.compile(r"cod(?:e|er)\b|code|math|vision|\bvl\b|think|reason|\br1\b|-base|sql|\bocr")
_SIZE = re.compile(r"(?<![\d.])(\d+(?:\.\d+)?)\s?([bm])(?![a-z0-9])")
_LEAST = 0.45e9  # half a billion parameters, as rounded in models' names


@dataclass(frozen=True, slots=True)
class LocalServer:
    """A server that lists at least one chat model."""

    name: str
    base_url: str
    models: tuple[str, ...]
    """Names of chat models; the most suitable first."""


async def find_servers(ports: Mapping[int, str] | None = None) -> list[LocalServer]:
    """Return the servers that answer on these ports of the loopback interface, within a second.

    They get no key, and no words of the user. A web server without a list of models is not among them.

    Args:
        ports: The programs by their ports; by default `PORTS`.
    """
    if find_spec("httpx") is None:
        return []
    found = await asyncio.gather(*(_ask(port, name) for port, name in (PORTS if ports is None else ports).items()))
    return [server for server in found if server is not None]


async def _ask(port: int, name: str) -> LocalServer | None:
    try:
        async with asyncio.timeout(PATIENCE):
            # Without a listener this ends at once, and httpx need not be imported.
            _, writer = await asyncio.open_connection("127.0.0.1", port)
            writer.close()
            address = f"http://127.0.0.1:{port}/v1"
            models = await chat_models(address)
    except (OSError, TimeoutError):
        return None
    return LocalServer(name, address, models) if models else None


async def chat_models(base_url: str, key: str = "", patience: float = PATIENCE) -> tuple[str, ...]:
    """Return the chat models that a server lists, the most suitable first; none if it is no such server.

    Args:
        base_url: The address of the API, with most servers ending in ``/v1``.
        key: The user's key for this server, if it needs one.
        patience: Seconds.
    """
    import httpx

    local = base_url.startswith(("http://127.", "http://localhost"))
    headers = {"Authorization": f"Bearer {key}"} if key else {}
    body = b""
    try:
        async with (
            asyncio.timeout(patience),
            httpx.AsyncClient(headers=headers, trust_env=not local, verify=not base_url.startswith("http:")) as client,
            client.stream("GET", f"{base_url.rstrip('/')}/models") as answer,
        ):
            if answer.status_code != 200:
                return ()
            async for received in answer.aiter_bytes():
                body += received
                if len(body) > LIMIT:
                    return ()
        return _chat_models(json.loads(body))
    except (httpx.HTTPError, httpx.InvalidURL, OSError, RecursionError, TimeoutError, ValueError):
        return ()


def _chat_models(document: Any) -> tuple[str, ...]:
    if not isinstance(document, dict):
        return ()
    entries = cast("dict[str, Any]", document).get("data")
    if not isinstance(entries, list):
        return ()
    names = [name for entry in cast("list[Any]", entries) if (name := _chat_model(entry))]
    return tuple(sorted(names, key=lambda name: _SPECIAL.search(name.lower()) is not None))


def _chat_model(entry: Any) -> str:
    """Return the name of a listed chat model; empty for any other model."""
    if not isinstance(entry, dict):
        return ""
    facts = cast("dict[str, Any]", entry)
    name, meta = facts.get("id"), facts.get("meta")
    if not isinstance(name, str) or not name.isprintable() or facts.get("object") != "model":
        return ""
    parameters: Any = cast("dict[str, Any]", meta).get("n_params") if isinstance(meta, dict) else None
    if not isinstance(parameters, int | float):
        size = _SIZE.search(name.lower())
        parameters = float(size[1]) * (1e9 if size[2] == "b" else 1e6) if size else _LEAST
    return "" if parameters < _LEAST or _NOT_CHAT.search(name.lower()) else name
