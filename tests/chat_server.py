"""A server on the loopback interface that speaks OpenAI's protocol, and makes mistakes on demand."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from typing import Any


class Talk:
    """A request to the server, and methods that answer it."""

    def __init__(self, path: str, headers: dict[str, str], body: Any, writer: asyncio.StreamWriter) -> None:
        self.path, self.headers, self.body, self._writer = path, headers, body, writer

    async def head(self, status: str = "200 OK", kind: str = "text/event-stream", **more: str) -> None:
        lines = [f"HTTP/1.1 {status}", f"Content-Type: {kind}", "Connection: close"]
        lines += [f"{name}: {value}" for name, value in more.items()]
        await self.raw("\r\n".join(lines) + "\r\n\r\n")

    async def raw(self, text: str | bytes) -> None:
        self._writer.write(text.encode() if isinstance(text, str) else text)
        await self._writer.drain()

    async def event(self, document: object) -> None:
        await self.raw(f"data: {document if isinstance(document, str) else json.dumps(document)}\n\n")

    async def piece(self, text: str | None, finish: str | None = None) -> None:
        delta = {} if text is None else {"content": text}
        await self.event({"choices": [{"index": 0, "delta": delta, "finish_reason": finish}]})

    async def gone(self) -> None:
        """Send comments until the client closes the connection."""
        try:
            while True:
                await self.raw(": still there?\n\n")
                await asyncio.sleep(0)
        except OSError:
            pass

    @staticmethod
    async def stall() -> None:
        await asyncio.Event().wait()


Answer = Callable[[Talk], Awaitable[None]]


class ChatServer:
    """A server that answers each request with the function `answer`, and keeps the requests."""

    def __init__(self, answer: Answer) -> None:
        self.answer = answer
        self.talks: list[Talk] = []
        self.url = ""

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            first, *lines = (await reader.readuntil(b"\r\n\r\n")).decode().split("\r\n")
            headers = {k.lower(): v for k, _, v in (line.partition(": ") for line in lines) if k}
            body = await reader.readexactly(int(headers.get("content-length", 0)))
            talk = Talk(first.split()[1], headers, json.loads(body), writer)
            self.talks.append(talk)
            await self.answer(talk)
        except (asyncio.IncompleteReadError, OSError):
            pass
        finally:
            writer.close()

    @asynccontextmanager
    async def running(self) -> AsyncIterator[ChatServer]:
        serving: set[asyncio.Task[None]] = set()

        def accept(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            task = asyncio.create_task(self._serve(reader, writer))
            serving.add(task)
            task.add_done_callback(serving.discard)

        server = await asyncio.start_server(accept, "127.0.0.1", 0)
        self.url = f"http://127.0.0.1:{server.sockets[0].getsockname()[1]}/v1"
        try:
            yield self
        finally:
            server.close()
            for task in serving:
                task.cancel()
            await asyncio.gather(*serving, return_exceptions=True)
            await server.wait_closed()
