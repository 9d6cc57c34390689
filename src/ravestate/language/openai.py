"""A client for language models on servers with OpenAI's protocol: Ollama, llama.cpp, vLLM, LM Studio, a cloud."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncGenerator, Mapping, Sequence
from contextlib import aclosing
from typing import TYPE_CHECKING, Any, cast

from pydantic import AliasChoices, BaseModel, Field, SecretStr, ValidationError

from ravestate.declare.wording import cut
from ravestate.errors import PlatformError

from .chat import Message, Progress

if TYPE_CHECKING:
    import httpx2

LIMIT = 1 << 20
"""The maximum size in bytes of an answer as one JSON document, or of an event in a stream."""

_EXAMPLE = "base_url=http://localhost:11434/v1"
_OPTIONAL = {"max_tokens": "max_completion_tokens", "temperature": "", "seed": "", "stop": ""}
"""Parameter that newer models refuse → its newer name; empty if newer models have no such parameter."""


class OpenAIBackend:
    """A client of ``POST {base_url}/chat/completions``."""

    def __init__(
        self,
        base_url: str,
        model: str,
        *,
        api_key: SecretStr | None = None,
        connect_timeout: float = 5.0,
        read_timeout: float = 60.0,
        extra: Mapping[str, object] | None = None,
        owner: str = "wildtalk",
    ) -> None:
        """Take the settings, without contacting the server.

        Args:
            base_url: The address of the API; with most servers it ends in ``/v1``.
            model: The model's name on the server.
            api_key: A bearer token; no message shows it.
            connect_timeout: Seconds to wait for a connection.
            read_timeout: Seconds of silence after which a server counts as stalled. Some servers load the model first.
            extra: More fields of the request, for a particular server.
            owner: The module whose settings the messages name.

        Raises:
            PlatformError: `base_url` is not a web address.
        """
        self._base_url = base_url.strip().rstrip("/").removesuffix("/chat/completions")
        scheme, _, rest = self._base_url.partition("://")
        if scheme not in ("http", "https") or not rest:
            raise PlatformError(
                f"{owner}: base_url {base_url!r} is not a web address: write for example {owner}.{_EXAMPLE}"
            )
        self._place = f"{scheme}://{rest.rpartition('@')[2]}"  # without a password
        self._model = model
        self._key = api_key.get_secret_value().strip() if api_key is not None else ""
        self._connect_timeout, self._read_timeout = connect_timeout, read_timeout
        self._extra = dict(extra or {})
        self._owner = owner
        self._unsupported: set[str] = set()
        self._client: httpx2.AsyncClient | None = None

    def __repr__(self) -> str:
        return f"OpenAIBackend({self._place!r}, {self._model!r})"

    async def load(self, progress: Progress | None = None) -> None:
        """Import the web client and its certificates, in a thread. The server is not contacted yet."""
        if self._client is None:
            client = await asyncio.to_thread(self._make_client)
            self._client = self._client or client
        if progress is not None:
            progress(1.0)

    async def close(self) -> None:
        """Close the connections."""
        client, self._client = self._client, None
        if client is not None:
            await client.aclose()

    async def stream(
        self,
        messages: Sequence[Message],
        *,
        max_tokens: int = 96,
        temperature: float = 0.7,
        seed: int | None = None,
        stop: Sequence[str] = (),
    ) -> AsyncGenerator[str, None]:
        """See `Backend.stream`."""
        await self.load()
        client = self._client
        assert client is not None
        import httpx2  # `load` has imported it

        body: dict[str, object] = {
            "model": self._model,
            "messages": [{"role": m.role, "content": m.text} for m in messages],
            "stream": True,
            "max_tokens": max_tokens,
            "temperature": temperature,
            **({} if seed is None else {"seed": seed}),
            **({"stop": list(stop)} if stop else {}),
            **self._extra,
        }
        try:
            while True:
                for parameter in self._unsupported & body.keys():
                    value, newer = body.pop(parameter), _OPTIONAL[parameter]
                    body |= {newer: value} if newer else {}
                async with client.stream("POST", f"{self._base_url}/chat/completions", json=body) as answer:
                    if answer.status_code == 200:
                        async with aclosing(self._pieces(answer)) as pieces:
                            async for piece in pieces:
                                yield piece
                        return
                    refusal = await read(answer)
                    unsupported = str(_error(refusal).get("param"))
                    if (
                        not str(_error(refusal).get("code")).startswith("unsupported")
                        or unsupported not in _OPTIONAL.keys() & body.keys()
                    ):
                        raise PlatformError(f"{self._owner}: {self._refused(answer, refusal)}")
                    self._unsupported.add(unsupported)
        except (httpx2.HTTPError, httpx2.InvalidURL, TimeoutError) as error:
            raise PlatformError(f"{self._owner}: {self._broken(error)}") from error

    # ------------------------------------------------------------------------------- internals

    def _make_client(self) -> httpx2.AsyncClient:
        try:
            import anyio
            import httpx2
        except ImportError as error:
            raise PlatformError(
                f"{self._owner} with a server needs httpx2: pip install 'ravestate[wildtalk]'"
            ) from error
        if not (self._key.isascii() and self._key.isprintable()):
            raise PlatformError(
                f"{self._owner}: api_key has characters that no key has: check the environment variable it is read from"
            )
        # Import here what the first request would otherwise import on the event loop.
        anyio.run(anyio.sleep, 0)
        return make_client(self._base_url, self._key, httpx2.Timeout(self._read_timeout, connect=self._connect_timeout))

    async def _pieces(self, answer: httpx2.Response) -> AsyncGenerator[str, None]:
        from httpx2 import EventSource

        if answer.headers.get("content-type", "").startswith("application/json"):  # a server that cannot stream
            yield self._parsed(await read(answer))[0]
            return
        finished = False
        events = aiter(EventSource(answer, max_event_size=LIMIT))
        while True:
            async with asyncio.timeout(self._read_timeout):  # comments in the stream do not extend the timeout
                event = await anext(events, None)
            if event is None or event.data == "[DONE]":
                break
            text, ended = self._parsed(event.data.encode())
            finished = finished or ended
            if text:
                yield text
        if event is None and not finished:
            raise PlatformError(
                f"{self._owner}: the answer from {self._place} broke off before its end: check the server's log"
            )

    def _parsed(self, payload: bytes) -> tuple[str, bool]:
        """Return the text in a document, and whether this document is the last."""
        try:
            document = _Answer.model_validate_json(payload)
        except ValidationError:
            shown = self._safe(payload.decode("utf-8", "replace"))
            raise PlatformError(
                f"{self._owner}: {self._place} sent an answer in another form than OpenAI's: {shown}"
            ) from None
        if document.error:
            raise PlatformError(f"{self._owner}: the server at {self._place} failed: {self._reason(payload)}")
        first = document.choices[0] if document.choices else _Choice()
        return (first.text.content if first.text else None) or "", first.finish_reason is not None

    def _safe(self, text: str, length: int = 300) -> str:
        """Return the beginning of a server's `text`, on one line and without the key."""
        text = text.replace(self._key, "***") if self._key else text
        return cut(" ".join(text.split()), length)

    def _reason(self, body: bytes) -> str:
        error = _error(body)
        return self._safe(str(error.get("message") or error.get("detail") or body.decode("utf-8", "replace")))

    def _broken(self, error: Exception) -> str:
        """Return a message about a broken connection that says what to do."""
        import httpx2

        reason = self._safe(str(error)) or type(error).__name__
        match error:
            case httpx2.ConnectError() | httpx2.ConnectTimeout():
                return (
                    f"no server answers at {self._place} within {self._connect_timeout:g} s ({reason}): is it running? With "
                    f"Ollama: `ollama serve`; for another address: --set {self._owner}.{_EXAMPLE}"
                )
            case httpx2.TimeoutException() | TimeoutError():
                return (
                    f"the server at {self._place} stalled: nothing for {self._read_timeout:g} s. Is it overloaded, or "
                    f"loading model {self._model!r}? Give it longer: {self._owner}.read_timeout={2 * self._read_timeout:g}"
                )
            case httpx2.InvalidURL():
                return f"base_url {self._place!r} is not a web address ({reason}): write for example {self._owner}.{_EXAMPLE}"
            case httpx2.SSEError():
                return (
                    f"{self._place} sends no stream of events ({reason}). An OpenAI-compatible API usually ends in /v1"
                )
            case _:
                return f"the connection to {self._place} broke off ({reason}): check the server's log"

    def _refused(self, answer: httpx2.Response, body: bytes) -> str:
        match answer.status_code:
            case 401 | 403:
                key = f"{self._owner}.api_key"
                mend = f"check {key}" if self._key else f"set {key}, from the environment"
            case 404:
                mend = (
                    f"does it know the model {self._model!r} ({self._owner}.model; with Ollama: `ollama pull "
                    f"{self._model or 'llama3.2'}`), and is the address right? It usually ends in /v1"
                )
            case 429:
                mend = "too many requests, or the quota is used up: wait, or check your account"
            case status if status >= 500:
                mend = "check its log, and whether the model fits into its memory"
            case _ if moved := answer.headers.get("location"):
                mend = f"it has moved to {moved!r}: change {self._owner}.base_url accordingly"
            case _:
                mend = f"check {self._owner}.model ({self._model!r}) and the other settings"
        return f"the server at {self._place} answers {answer.status_code} ({self._reason(body) or 'no reason'}): {mend}"


class _Text(BaseModel):
    content: str | None = None


class _Choice(BaseModel):
    text: _Text | None = Field(default=None, validation_alias=AliasChoices("delta", "message"))
    finish_reason: str | None = None


class _Answer(BaseModel):
    """A whole answer, or a piece of an answer. The last event of a stream may have no text, only a count of tokens."""

    choices: list[_Choice] | None = None
    error: Any = None


def make_client(base_url: str, key: str, timeout: Any) -> httpx2.AsyncClient:
    """Return a web client for a server; `key` may be empty."""
    import httpx2

    here = base_url.rpartition("@")[2].removeprefix("http://").startswith(("localhost", "127.", "[::1]"))
    return httpx2.AsyncClient(
        headers={"Authorization": f"Bearer {key}"} if key else {},
        timeout=timeout,
        trust_env=not here,  # a proxy on another machine would look for localhost on its own machine
        verify=not base_url.startswith("http:"),  # certificates take 30 ms to read, and http needs none
    )


async def read(answer: httpx2.Response) -> bytes:
    """Return the body of `answer`. Stop reading after `LIMIT` bytes or a little more."""
    body = b""
    async for received in answer.aiter_bytes():
        body += received
        if len(body) > LIMIT:
            break
    return body


def _error(body: bytes) -> dict[str, Any]:
    """Return the part of an error's body that has the reason. Servers put it in different places."""
    try:
        document: Any = json.loads(body)
    except (RecursionError, ValueError):
        return {}
    error: Any = cast("dict[str, Any]", document).get("error", document) if isinstance(document, dict) else document
    return cast("dict[str, Any]", error) if isinstance(error, dict) else {"message": error}
