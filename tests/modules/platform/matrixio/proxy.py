"""A proxy for a homeserver. It makes requests fail as a test demands."""

import asyncio
from dataclasses import dataclass, field

import aiohttp
from aiohttp import web


@dataclass
class Fault:
    """A fault of the next `times` requests whose method and path contain the text `request`.

    `kind` is one of these:

    - an HTTP status, with which the proxy answers
    - ``lost``: the server acts, but its answer never arrives
    - ``garbage``: the second half of the answer is missing
    - ``hang``: the server acts, but the proxy neither answers nor closes the connection
    - ``refuse``: the proxy closes the connection, and the server gets no request
    """

    request: str
    kind: str
    times: int = 1
    met: asyncio.Event = field(default_factory=asyncio.Event)
    """Set when all these requests have failed."""


class Proxy:
    """A proxy for the server with an address: ``async with Proxy(address) as proxy``. Its own address is `proxy.url`."""

    def __init__(self, server: str) -> None:
        self._server = server
        self.faults: list[Fault] = []

    def fail(self, request: str, kind: str, times: int = 1) -> Fault:
        self.faults.append(Fault(request, kind, times))
        return self.faults[-1]

    async def __aenter__(self) -> "Proxy":
        self._client = aiohttp.ClientSession(auto_decompress=False)
        self._runner = web.ServerRunner(web.Server(self._handle), shutdown_timeout=0.1)
        await self._runner.setup()
        site = web.TCPSite(self._runner, "127.0.0.1", 0)
        await site.start()
        self.url = f"http://127.0.0.1:{self._runner.addresses[0][1]}"
        return self

    async def __aexit__(self, *_: object) -> None:
        await self._runner.cleanup()
        await self._client.close()

    def _kind(self, request: web.BaseRequest) -> str:
        for fault in self.faults:
            if fault.times and fault.request in f"{request.method} {request.path}":
                fault.times -= 1
                if not fault.times:
                    fault.met.set()
                return fault.kind
        return ""

    async def _handle(self, request: web.BaseRequest) -> web.StreamResponse:
        body, kind = await request.read(), self._kind(request)
        if kind == "429":
            refusal = {"errcode": "M_LIMIT_EXCEEDED", "error": "Too Many Requests", "retry_after_ms": 300}
            return web.json_response(refusal, status=429)
        if kind.isdecimal():
            return web.Response(text="<html>Server Error</html>", status=int(kind))
        if kind == "refuse" and request.transport is not None:
            request.transport.close()
            return web.Response()
        headers = {name: value for name, value in request.headers.items() if name not in ("Host", "Content-Length")}
        url = self._server + request.raw_path
        async with self._client.request(request.method, url, data=body or None, headers=headers) as found:
            data = await found.read()
        if kind == "hang":
            await asyncio.Event().wait()
        if kind == "lost" and request.transport is not None:
            request.transport.close()
        if kind == "garbage":
            data = data[: len(data) // 2]
        return web.Response(body=data, status=found.status, headers={"Content-Type": found.headers["Content-Type"]})
