"""Small talk by any server that supports OpenAI's protocol: Ollama, llama.cpp, vLLM, LM Studio, a cloud."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncGenerator, Mapping, Sequence
from contextlib import aclosing
from importlib import import_module
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

from ravestate.errors import PlatformError

from .backend import Message, Progress

if TYPE_CHECKING:
    import httpx
    from httpx_sse import ServerSentEvent
    from pydantic import SecretStr

_BODY_LIMIT = (
    1 << 20
)  # bytes of an answer without a stream, and characters of a line; of an error a thousandth is shown


class OpenAIBackend:
    """A client of ``POST {base_url}/chat/completions``.

    Example:
        ```python
        backend = OpenAIBackend("http://localhost:11434/v1", "llama3.2")
        async for piece in backend.stream([Message("user", "Hello!")]):
            print(piece, end="", flush=True)
        ```
    """

    def __init__(
        self,
        base_url: str,
        model: str,
        *,
        api_key: SecretStr | None = None,
        connect_timeout: float = 5.0,
        read_timeout: float = 60.0,
        extra: Mapping[str, object] | None = None,
    ) -> None:
        """Nothing is contacted yet.

        Args:
            base_url: The address of the API; with most servers it ends in ``/v1``.
            model: The model's name on the server.
            api_key: A bearer token; no message shows it.
            connect_timeout: Seconds to wait for a connection.
            read_timeout: Seconds of silence after which a server counts as stalled. The first word of an
                answer may take long: some servers load the model for it.
            extra: More fields of the request, for a particular server.

        Raises:
            PlatformError: `base_url` is not a web address.
        """
        self._base_url = _checked(base_url)
        self._model = model
        self._key = api_key.get_secret_value().strip() if api_key is not None else ""
        self._connect_timeout = connect_timeout
        self._read_timeout = read_timeout
        self._extra = dict(extra or {})
        self._unsupported: set[str] = set()
        self._client: httpx.AsyncClient | None = None

    def __repr__(self) -> str:
        return f"OpenAIBackend({self._place!r}, {self._model!r})"

    async def load(self, progress: Progress | None = None) -> None:
        """Import the web client and its certificates, off the loop. The server is not contacted yet."""
        if self._client is None:
            client = await asyncio.to_thread(self._make_client)
            if self._client is None:
                self._client = client
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
        import httpx  # `load` has imported it

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
        for parameter in self._unsupported:
            _withdraw(body, parameter)
        try:
            while True:
                async with client.stream("POST", f"{self._base_url}/chat/completions", json=body) as answer:
                    if answer.status_code != 200:
                        refusal = await _limited(answer)
                        unsupported = _unsupported(answer.status_code, refusal)
                        if unsupported and _withdraw(body, unsupported):
                            self._unsupported.add(unsupported)
                            continue  # newer models refuse parameters that older ones demand
                        raise self._refused(answer, refusal)
                    async for piece in self._pieces(answer):
                        yield piece
                    return
        except httpx.ConnectTimeout as error:
            raise PlatformError(
                f"wildtalk: no server answers at {self._place} within {self._connect_timeout:g} s: "
                f"check wildtalk.base_url, and whether something is in between (a firewall, a proxy)"
            ) from error
        except httpx.TimeoutException as error:
            raise self._stalled() from error
        except httpx.ConnectError as error:
            raise PlatformError(
                f"wildtalk: no server at {self._place} ({self._safe(str(error))}): is it running? With Ollama: "
                f"`ollama serve`; for another address: --set wildtalk.base_url=http://localhost:11434/v1"
            ) from error
        except httpx.HTTPError as error:
            raise PlatformError(
                f"wildtalk: the connection to {self._place} broke off "
                f"({self._safe(str(error)) or type(error).__name__}): look into the server's log"
            ) from error
        except httpx.InvalidURL as error:
            raise PlatformError(
                f"wildtalk: base_url {self._place!r} is not a web address ({error}): write for example "
                f"wildtalk.base_url=http://localhost:11434/v1"
            ) from error

    # ------------------------------------------------------------------------------- internals

    @property
    def _place(self) -> str:
        """The address without secrets."""
        scheme, _, rest = self._base_url.partition("://")
        host, slash, path = rest.partition("/")
        return f"{scheme}://{host.rpartition('@')[2]}{slash}{path}"

    def _safe(self, text: str) -> str:
        return text.replace(self._key, "***") if self._key else text

    def _make_client(self) -> httpx.AsyncClient:
        try:
            import anyio
            import httpx

            import_module("httpx_sse")  # `_events` needs it, on the loop
        except ImportError as error:
            raise PlatformError(
                "wildtalk with a server needs httpx and httpx-sse: pip install 'ravestate[wildtalk]'"
            ) from error
        if self._key and not (self._key.isascii() and self._key.isprintable()):
            raise PlatformError(
                "wildtalk: api_key has characters that no key has: check the environment variable it is read from"
            )
        anyio.run(anyio.sleep, 0)  # loads what the client would load at its first request, on the loop
        host = self._place.partition("://")[2]
        here = host.startswith(("localhost", "127.", "[::1]"))
        return httpx.AsyncClient(
            headers={"Authorization": f"Bearer {self._key}"} if self._key else {},
            timeout=httpx.Timeout(self._read_timeout, connect=self._connect_timeout),
            # A proxy would look for localhost on its own machine.
            trust_env=not here,
            # Certificates take 30 ms to read, and http needs none.
            verify=not self._base_url.startswith("http://"),
        )

    async def _pieces(self, answer: httpx.Response) -> AsyncGenerator[str, None]:
        kind = answer.headers.get("content-type", "").partition(";")[0].strip().lower()
        if kind == "application/json":  # a server that cannot stream
            document = self._document(await _limited(answer))
            if piece := self._text(document, "message"):
                yield piece
            return
        if kind not in ("text/event-stream", ""):
            raise PlatformError(
                f"wildtalk: {self._place} answers with {kind!r}, not with a stream of events: it is not an "
                f"OpenAI-compatible API. Such an address usually ends in /v1"
            )
        finished = False
        async with aclosing(self._events(answer)) as events:
            while True:
                try:
                    async with asyncio.timeout(
                        self._read_timeout
                    ):  # a comment that only keeps the connection open is not an event
                        event = await anext(events, None)
                except TimeoutError as error:
                    raise self._stalled() from error
                if event is None:
                    break
                if event.data == "[DONE]":
                    return
                document = self._document(event.data)
                if piece := self._text(document, "delta"):
                    yield piece
                finished = finished or _finished(document)
        if not finished:
            raise PlatformError(
                f"wildtalk: the answer from {self._place} broke off before its end: look into the server's log"
            )

    def _events(self, answer: httpx.Response) -> AsyncGenerator[ServerSentEvent, None]:
        from httpx_sse import EventSource

        # `EventSource` gets a stand-in: the text has a limit, and a server need not name the content type.
        bounded = SimpleNamespace(
            headers={"content-type": "text/event-stream"}, aiter_text=lambda: self._bounded(answer)
        )
        return EventSource(cast("httpx.Response", bounded)).aiter_sse()

    async def _bounded(self, answer: httpx.Response) -> AsyncGenerator[str, None]:
        """Yield the text of `answer`, and an empty line after its last event; refuse an endless line."""
        length = 0
        async for text in answer.aiter_text():
            _, ended, rest = text.rpartition("\n")
            length = len(rest) + (0 if ended else length)
            if length > _BODY_LIMIT:
                raise PlatformError(
                    f"wildtalk: {self._place} sent a line of more than {_BODY_LIMIT} characters: it is not an "
                    f"OpenAI-compatible API"
                )
            yield text
        yield "\n\n"

    def _document(self, payload: str) -> dict[str, Any]:
        try:
            document = json.loads(payload)
        except (RecursionError, ValueError):
            document = None
        if not isinstance(document, dict):
            raise PlatformError(f"wildtalk: {self._place} sent no JSON object: {self._safe(_short(payload))}")
        document = cast("dict[str, Any]", document)
        if document.get("error"):
            raise PlatformError(f"wildtalk: the server at {self._place} failed: {self._safe(_reason(payload))}")
        return document

    def _text(self, document: dict[str, Any], field: str) -> str:
        choices: Any = document.get("choices") or (cast("Any", {}),)  # a last event may only count tokens
        try:
            message: Any = choices[0].get(field) or {}
            content: Any = message.get("content") or ""
        except (AttributeError, LookupError, TypeError):
            content = None
        if not isinstance(content, str):
            raise PlatformError(
                f"wildtalk: {self._place} sent an answer in another form than OpenAI's: "
                f"{self._safe(_short(json.dumps(document)))}"
            )
        return content

    def _stalled(self) -> PlatformError:
        return PlatformError(
            f"wildtalk: the server at {self._place} stalled: nothing for {self._read_timeout:g} s. Is it "
            f"overloaded, or loading model {self._model!r}? Give it longer: wildtalk.read_timeout="
            f"{2 * self._read_timeout:g}"
        )

    def _refused(self, answer: httpx.Response, body: str) -> PlatformError:
        status, reason = answer.status_code, self._safe(_reason(body))
        if status in (401, 403):
            hint = (
                "check wildtalk.api_key" if self._key else "it wants a key: set wildtalk.api_key, from the environment"
            )
        elif status == 404:
            hint = (
                f"does it know the model {self._model!r} (wildtalk.model; with Ollama: `ollama pull "
                f"{self._model or 'llama3.2'}`), and is the address right? It usually ends in /v1"
            )
        elif status in (300, 301, 302, 303, 307, 308):
            hint = f"it has moved: set wildtalk.base_url to where {answer.headers.get('location', '?')!r} is"
        elif status == 429:
            hint = "too many requests, or the quota is used up: wait, or check your account"
        elif status >= 500:
            hint = "the server is in trouble: look into its log, and whether the model fits into its memory"
        else:
            hint = f"check wildtalk.model ({self._model!r}) and the other settings"
        return PlatformError(f"wildtalk: the server at {self._place} answers {status} ({reason}): {hint}")


def _checked(base_url: str) -> str:
    address = base_url.strip().rstrip("/")
    if not address.startswith(("http://", "https://")) or not address.partition("://")[2]:
        raise PlatformError(
            f"wildtalk: base_url {base_url!r} is not a web address: write for example "
            f"wildtalk.base_url=http://localhost:11434/v1"
        )
    return address.removesuffix("/chat/completions")


async def _limited(answer: httpx.Response) -> str:
    body = b""
    async for received in answer.aiter_bytes():
        body += received
        if len(body) > _BODY_LIMIT:
            break
    return body[:_BODY_LIMIT].decode("utf-8", "replace")


def _finished(document: dict[str, Any]) -> bool:
    choices = document.get("choices")
    return bool(choices and choices[0].get("finish_reason"))


def _short(text: str, length: int = 300) -> str:
    text = " ".join(text.split())
    return text if len(text) <= length else text[:length] + "…"


def _error(body: str) -> Mapping[str, Any]:
    """Return the part of an error's body with the reason; servers differ in where they put it."""
    try:
        document: Any = json.loads(body)
    except (RecursionError, ValueError):
        return {}
    error: Any = cast("dict[str, Any]", document).get("error", document) if isinstance(document, dict) else document
    return cast("dict[str, Any]", error) if isinstance(error, dict) else {"message": error}


def _reason(body: str) -> str:
    error = _error(body)
    return _short(str(error.get("message") or error.get("detail") or body)) or "without a reason"


def _unsupported(status: int, body: str) -> str | None:
    error = _error(body)
    if status != 400 or not str(error.get("code")).startswith("unsupported"):
        return None
    return str(error.get("param"))


def _withdraw(body: dict[str, object], parameter: str) -> bool:
    """Remove an optional `parameter` from the request; return whether that was possible."""
    if parameter not in ("max_tokens", "temperature", "seed", "stop") or parameter not in body:
        return False
    value = body.pop(parameter)
    if parameter == "max_tokens":  # the parameter's newer name
        body["max_completion_tokens"] = value
    return True
