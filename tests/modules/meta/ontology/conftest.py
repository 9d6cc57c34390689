"""Memory for the tests, in a file and on a real Bolt server."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from ravestate.modules import ontology
from ravestate.modules.meta.ontology.opening import open_memory

PASSWORD = "only-for-these-tests"
DATABASE = "memory"

Open = Callable[..., ontology.Memory]


def free_ports(count: int) -> list[int]:
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


@pytest.fixture(scope="session")
def bolt_server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Any]]:
    """Start a server for the time of the tests; yield its settings."""
    folder = tmp_path_factory.mktemp("bolt")
    ports = free_ports(2)
    with (folder / "server.txt").open("wb") as said:
        process = subprocess.Popen(
            [sys.executable, Path(__file__).with_name("bolt_server.py"), folder, *map(str, ports), PASSWORD, DATABASE],
            cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=said, start_new_session=True,
        )  # fmt: skip
        assert process.stdin is not None and process.stdout is not None
        try:
            lines = iter(process.stdout.readline, b"")
            assert any(line.endswith(b"ready\n") for line in lines), (folder / "server.txt").read_text()
            yield {
                "url": f"bolt://127.0.0.1:{ports[0]}",
                "user": "root",
                "password": PASSWORD,
                "database": DATABASE,
            }
        finally:
            process.stdin.close()
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(20)
            with contextlib.suppress(ProcessLookupError):  # it has ended by itself
                os.killpg(process.pid, signal.SIGKILL)
            process.stdout.close()
            process.wait()


@pytest.fixture(params=["file", "server"])
def place(request: pytest.FixtureRequest, tmp_path: Path) -> dict[str, Any]:
    """Return the settings of an empty memory: once in a file, and once on a server."""
    if request.param == "file":
        return {"path": tmp_path / "memory.lbug"}
    settings: dict[str, Any] = request.getfixturevalue("bolt_server")
    import neo4j

    with (
        neo4j.GraphDatabase.driver(settings["url"], auth=("root", PASSWORD)) as driver,
        driver.session(database=DATABASE) as session,
    ):
        session.run("MATCH (n) DETACH DELETE n").consume()
    return settings


@pytest.fixture
def open_here() -> Iterator[Open]:
    """A function that opens memory with settings. The fixture closes each memory at the end."""
    opened: list[ontology.Memory] = []

    def open_one(**settings: Any) -> ontology.Memory:
        memory = open_memory(ontology.Settings(**settings))
        opened.append(memory)
        memory.opened().result(60)
        return memory

    yield open_one
    for memory in opened:
        memory.close().result(60)


@pytest.fixture
def memory(place: dict[str, Any], open_here: Open) -> ontology.Memory:
    """An open, empty memory."""
    return open_here(**place)
