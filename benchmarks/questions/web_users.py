"""How long do many users of the web page wait for an answer?

500 users connect within half a minute. Then, for half a minute, each user says something every 10 s, at random moments. The
server and the users are separate processes on one machine. The agent has all modules of the complete text agent
(``ravestate.cli.complete.COMPLETE``) except small talk. In its place, a rule repeats the input, so that an answer to the
wrong user is noticed. The users measure the time from an input to its answer.

The peer is a bare echo server on the same library (uvicorn).
"""

from __future__ import annotations

import asyncio
import atexit
import json
import os
import random
import statistics
import tempfile
import threading
import time
from collections.abc import Coroutine, Iterable
from typing import Any

from benchmarks.bench import Bench
from benchmarks.child import Child
from benchmarks.figures import Figure, compare, measured
from benchmarks.peers.wire import serve
from ravestate.cli.complete import COMPLETE

USERS = 500
EVERY = 10.0
"""Seconds from one utterance of a user to the next."""
COMING = 30.0
"""Seconds within which all users come. The agent greets each user, and prepares their conversation."""
LIMIT = 0.2
"""Seconds within which 95 % of the answers must come."""
GIVEN_UP = 15.0
"""Seconds after which an answer counts as lost."""

TEXT = tuple(name for name in COMPLETE if name != "wildtalk")
"""The names of the agent's modules, without the platform."""

GREETING = "hello"
"""An utterance that the agent answers in its own words."""

PHRASES = (
    GREETING,
    "I had soup number {} for lunch",
    "My bicycle has {} spokes and squeaks a little",
    "The tram with number {} was late again",
    "There are {} swans on the canal today",
)


# ------------------------------------------------------------------------------------ the servers, each in a process


def start(kind: str) -> int:
    """Serve until the process ends, and return the port. The agent's memory is temporary.

    Args:
        kind: "agent" or "echo".
    """
    place = tempfile.TemporaryDirectory()
    atexit.register(place.cleanup)
    os.environ["XDG_DATA_HOME"] = place.name
    ready: list[int] = []
    told = threading.Event()

    def tell(port: int) -> None:
        ready.append(port)
        told.set()

    work = serve_agent(tell) if kind == "agent" else serve_echo(tell)
    threading.Thread(target=_run, args=(work, told), daemon=True).start()
    told.wait()
    return ready[0]


def _run(work: Coroutine[Any, Any, None], told: threading.Event) -> None:
    try:
        asyncio.run(work)
    finally:
        told.set()


def worked() -> float:
    """Return the processor time that the process has taken so far (seconds)."""
    return time.process_time()


async def serve_agent(tell: Any) -> None:
    """Serve the agent on its page."""
    import ravestate as rs
    from ravestate import modules
    from ravestate.modules import rawio, webio
    from ravestate.modules.platform.webio.server import Server
    from ravestate.runtime.agent import Agent

    stand_in = rs.Module("stand_in", requires=[rawio])

    @stand_in.rule(when=rawio.input.changed, writes=rawio.output)
    async def say_again(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = f"You said: {ctx.payload(rawio.input.changed)}"

    text = [getattr(modules, name) for name in TEXT]
    settings = {"webio": {"port": 0, "per_address": 2 * USERS}}
    async with Server(Agent(*text, stand_in, webio, settings=settings)) as server:
        tell(server.port)
        await asyncio.Event().wait()


async def serve_echo(tell: Any) -> None:
    """Serve a bare echo."""
    import socket

    import uvicorn

    async def echo(scope: Any, receive: Any, send: Any) -> None:
        while True:
            message = await receive()
            if message["type"] == "websocket.connect":
                await send({"type": "websocket.accept"})
            elif message["type"] == "websocket.receive":
                await send({"type": "websocket.send", "text": message["text"]})
            else:
                return

    listener = socket.create_server(("127.0.0.1", 0))
    tell(listener.getsockname()[1])
    config = uvicorn.Config(echo, log_config=None, log_level="error", ws_per_message_deflate=False, lifespan="off")
    server = uvicorn.Server(config)
    server.install_signal_handlers = lambda: None  # type: ignore[attr-defined]  # not in a thread
    await server.serve(sockets=[listener])


# ------------------------------------------------------------------------------------ the users, in a process of theirs


def talk(port: int, kind: str, users: int, seconds: float) -> dict[str, Any]:
    """Let all users talk for some time. Return the time of each answer (seconds), and the faults."""
    return asyncio.run(_talk(port, kind, users, seconds))


async def _talk(port: int, kind: str, users: int, seconds: float) -> dict[str, Any]:
    first = User(users, kind)  # the server loads everything for this user
    await first.come(port)
    for _ in PHRASES:
        await first._say()
    await first.go()
    everybody = [User(number, kind) for number in range(users)]

    async def come(user: User) -> None:
        await asyncio.sleep(COMING * user.number / users)
        await user.come(port)

    await asyncio.gather(*(come(user) for user in everybody))
    await asyncio.gather(*(user.talk(seconds) for user in everybody))
    await asyncio.gather(*(user.go() for user in everybody))
    return {
        "times": [took for user in everybody for took in user.times],
        "said": sum(user.said for user in everybody),
        "lost": sum(user.lost for user in everybody),
        "crossed": sum(user.crossed for user in everybody),
    }


class User:
    """A user who says something now and then, and measures the time until the answer."""

    def __init__(self, number: int, kind: str) -> None:
        self.number = number
        self.is_agent = kind == "agent"
        self.random = random.Random(number)
        self.times: list[float] = []
        self.texts: set[str] = set()
        self.said = self.lost = self.crossed = 0

    async def come(self, port: int) -> None:
        """Connect."""
        from websockets.asyncio.client import connect

        self.socket = await connect(f"ws://127.0.0.1:{port}/ws", compression=None, ping_interval=None)
        if self.is_agent:
            await self.socket.send('{"type":"hello","v":1}')
            while json.loads(await self.socket.recv())["type"] != "message":
                pass  # the greeting has come

    async def talk(self, seconds: float) -> None:
        """Say something at regular intervals."""
        await asyncio.sleep(self.random.random() * EVERY)
        end = time.monotonic() + seconds - EVERY
        while True:
            began = time.monotonic()
            await self._say()
            if began + EVERY > end:
                return
            await asyncio.sleep(began + EVERY - time.monotonic())

    async def _say(self) -> None:
        self.said += 1
        text = PHRASES[self.said % len(PHRASES)].format(self.number)
        key = f"{self.number}-{self.said}"
        began = time.perf_counter()
        await self.socket.send(json.dumps({"type": "say", "id": key, "text": text}))
        try:
            async with asyncio.timeout(GIVEN_UP):
                await self._answer(key, text)
        except TimeoutError:
            self.lost += 1
        else:
            self.times.append(time.perf_counter() - began)

    async def _answer(self, key: str, text: str) -> None:
        """Wait for the answer to a text. A filler, such as "Let me think", is no answer. Count answers to another
        user's words."""
        self.texts.add(text)
        heard = False
        while True:
            frame = json.loads(await self.socket.recv())
            if not self.is_agent:
                self.crossed += frame["id"] != key
                return
            if frame["type"] != "message":
                continue
            if frame["from"] == "user":
                self.crossed += not frame["id"].startswith(f"{self.number}-")
                heard = heard or frame["id"] == key
                continue
            again = frame["text"].removeprefix("You said: ")
            if again != frame["text"]:
                self.crossed += again not in self.texts
            if heard and (again == text or (text == GREETING and again == frame["text"])):
                return

    async def go(self) -> None:
        """Disconnect."""
        await self.socket.close()


# ------------------------------------------------------------------------------------ the question


def ask(bench: Bench) -> Iterable[Figure]:
    """Compare the agent with the echo server, in turns."""
    seconds = bench.several(40, 20)
    p95: dict[str, list[float]] = {"agent": [], "echo": []}
    medians: dict[str, list[float]] = {"agent": [], "echo": []}
    shares: list[float] = []
    wrong = 0
    for _ in bench.rounds(2, 1):
        for kind in p95:
            server, users = (bench.ours("benchmarks.questions.web_users") for _ in range(2))
            port = server.ask("start", kind=kind)
            before, began = server.ask("worked"), time.monotonic()
            result = users.ask("talk", port=port, kind=kind, users=USERS, seconds=seconds)
            if kind == "agent":
                shares.append((server.ask("worked") - before) / (time.monotonic() - began))
                wrong += result["lost"] + result["crossed"]
            p95[kind].append(statistics.quantiles(result["times"], n=20)[-1])
            medians[kind].append(statistics.median(result["times"]))
            _end(server, users)
    who = f"{USERS} users"
    yield measured(
        "web_users",
        f"{who}: 95 % answered within",
        p95["agent"],
        target="< 200 ms",
        reach=lambda v: v < LIMIT,
    )
    yield compare("web_users", f"{who}: 95 % answered within", p95["agent"], "bare echo", p95["echo"])
    yield compare("web_users", f"{who}: half answered within", medians["agent"], "bare echo", medians["echo"])
    yield measured(
        "web_users",
        f"{who}: messages lost or crossed",
        [float(wrong)],
        unit="",
        target="none",
        reach=lambda v: v == 0,
    )
    yield measured("web_users", f"{who}: work of the server", shares, unit="core")


def _end(*children: Child) -> None:
    for child in children:
        child.close()


if __name__ == "__main__":
    serve(start, worked, talk)
