"""OpenAI-compatible servers on this machine, and the chat models that they have."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Annotated, Literal

from pydantic import BaseModel, Field, ValidationError

from ravestate.language.openai import make_client, read

PORTS = {11434: "Ollama", 8080: "llama.cpp", 1234: "LM Studio", 8000: "vLLM"}
"""The usual ports of the programs that serve models, in the order of preference."""

PATIENCE = 1.0
"""The maximum number of seconds to wait for all servers, which are asked at the same time."""

# Parts of the names of models that do not chat, or that a server on this machine only passes on from a remote server.
_NOT_CHAT = re.compile(
    r"embed|rerank|minilm|whisper|\btts|\bbge|\be5-|\bgte-|nomic|mxbai|clip\b|diffusion|flux|guard|moderation|[-:]cloud$"
)
_SPECIAL = re.compile(r"cod(?:e|er)\b|code|math|vision|\bvl\b|think|reason|\br1\b|-base|sql|\bocr")
_SIZE = re.compile(r"(?<![\d.])(\d+(?:\.\d+)?)\s?([bm])(?![a-z0-9])")
_LEAST = 0.45e9  # the least number of parameters of a chat model; a name may round it to half a billion


@dataclass(frozen=True, slots=True)
class LocalServer:
    """A server, with the chat models that it lists."""

    name: str
    base_url: str
    models: tuple[str, ...]
    """Names of chat models. General models come before models for code, images and other special tasks."""


class _Facts(BaseModel):
    n_params: float | None = None


class _Model(BaseModel):
    id: Annotated[str, Field(pattern=r"^[^\x00-\x1f\x7f-\x9f]+$")]
    object: Literal["model"]
    meta: _Facts | None = None

    @property
    def chats(self) -> bool:
        name = self.id.lower()
        parameters = self.meta.n_params if self.meta else None
        if parameters is None:
            size = _SIZE.search(name)
            parameters = float(size[1]) * (1e9 if size[2] == "b" else 1e6) if size else _LEAST
        return parameters >= _LEAST and not _NOT_CHAT.search(name)


class _Listing(BaseModel):
    data: list[_Model]


async def find_servers(ports: Mapping[int, str] | None = None) -> list[LocalServer]:
    """Return the servers that answer within a second on these ports of the loopback interface, by default `PORTS`.

    The request contains neither a key nor any words of the user. Servers that list no chat model are left out. Without
    httpx2, the list is empty.
    """
    if find_spec("httpx2") is None:
        return []
    found = await asyncio.gather(*(_ask(port, name) for port, name in (PORTS if ports is None else ports).items()))
    return [server for server in found if server.models]


async def _ask(port: int, name: str) -> LocalServer:
    address = f"http://127.0.0.1:{port}/v1"
    try:
        async with asyncio.timeout(PATIENCE):
            # If no server listens on the port, this fails immediately, before httpx2 is imported.
            _, writer = await asyncio.open_connection("127.0.0.1", port)
            writer.close()
            return LocalServer(name, address, await chat_models(address))
    except (OSError, TimeoutError):
        return LocalServer(name, address, ())


async def chat_models(base_url: str, key: str = "", patience: float = PATIENCE) -> tuple[str, ...]:
    """Return the chat models that a server lists, as in `LocalServer.models`; empty if it lists none or does not answer.

    Args:
        base_url: The address of the API. For most servers, it ends in ``/v1``.
        key: The user's key for this server, if it needs one.
        patience: The maximum number of seconds to wait.
    """
    import httpx2

    try:
        async with (
            asyncio.timeout(patience),
            make_client(base_url, key, patience) as client,
            client.stream("GET", f"{base_url.rstrip('/')}/models") as answer,
        ):
            listed = _Listing.model_validate_json(await read(answer)) if answer.status_code == 200 else None
    except (httpx2.HTTPError, httpx2.InvalidURL, OSError, TimeoutError, ValidationError):
        return ()
    names = [model.id for model in listed.data if model.chats] if listed else []
    return tuple(sorted(names, key=lambda name: _SPECIAL.search(name.lower()) is not None))
