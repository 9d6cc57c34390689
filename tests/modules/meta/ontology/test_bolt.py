"""Memory on a Bolt server. An unusable server causes a clear error, and never blocks memory."""

from __future__ import annotations

import contextlib
import socket
import sys
import threading
from collections.abc import Iterator
from typing import Any

import pytest

from modules.meta.ontology.conftest import DATABASE, PASSWORD, Open, free_ports
from ravestate.errors import PlatformError
from ravestate.modules import ontology
from ravestate.modules.meta.ontology.opening import open_memory


def failure(**settings: Any) -> str:
    """Return the reason why memory cannot be opened; no message has the password."""
    memory = open_memory(ontology.Settings(**settings))
    with pytest.raises(PlatformError) as caught:
        memory.opened().result(60)
    with pytest.raises(PlatformError) as again:
        memory.find("Person").result(60)
    assert str(again.value) == str(caught.value)
    memory.close().result(60)
    assert PASSWORD not in str(caught.value) and "wrong" not in str(caught.value)
    return str(caught.value)


class Proxy:
    """A proxy between client and server. It can stall, and close connections."""

    def __init__(self, port: int) -> None:
        self._port = port
        self._listening = socket.create_server(("127.0.0.1", 0))
        self.url = f"bolt://127.0.0.1:{self._listening.getsockname()[1]}"
        self.flowing = threading.Event()
        self.flowing.set()
        self._sockets: list[socket.socket] = []
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self) -> None:
        try:
            while True:
                client, _ = self._listening.accept()
                server = socket.create_connection(("127.0.0.1", self._port))
                self._sockets += [client, server]
                for ends in ((client, server), (server, client)):
                    threading.Thread(target=self._pass_on, args=ends, daemon=True).start()
        except OSError:
            pass  # the test is over

    def _pass_on(self, source: socket.socket, target: socket.socket) -> None:
        try:
            while said := source.recv(65536):
                self.flowing.wait()
                target.sendall(said)
        except OSError:
            pass
        target.close()

    def hang_up(self) -> None:
        for one in self._sockets:
            with contextlib.suppress(OSError):
                one.shutdown(socket.SHUT_RDWR)
            one.close()
        self._sockets.clear()

    def close(self) -> None:
        self.flowing.set()
        self._listening.close()
        self.hang_up()


@pytest.fixture
def proxy(bolt_server: dict[str, Any]) -> Iterator[Proxy]:
    proxy = Proxy(int(bolt_server["url"].rpartition(":")[2]))
    yield proxy
    proxy.close()


def test_an_absent_server_is_reported() -> None:
    url = f"bolt://127.0.0.1:{free_ports(1)[0]}"
    said = failure(url=url, timeout=5)
    assert f"memory {url} cannot be reached" in said and "start the server" in said


def test_a_wrong_password_is_reported(bolt_server: dict[str, Any]) -> None:
    said = failure(**{**bolt_server, "password": "wrong"})
    assert "refuses the user 'root': set RAVESTATE_ONTOLOGY_PASSWORD" in said


def test_a_missing_password_is_reported(bolt_server: dict[str, Any]) -> None:
    said = failure(**{**bolt_server, "password": None})
    assert f"memory {bolt_server['url']}" in said


def test_a_missing_database_is_reported(bolt_server: dict[str, Any]) -> None:
    said = failure(**{**bolt_server, "database": "nowhere"})
    assert "has no database 'nowhere'" in said and "--set ontology.database=NAME" in said


@pytest.mark.parametrize("url", ["http://localhost:7687", "localhost", "", "bolt://", "bolt://localhost:port"])
def test_an_invalid_address_is_reported(url: str) -> None:
    assert "bolt://" in failure(url=url, timeout=5)


def test_a_server_that_accepts_and_stalls_is_reported() -> None:
    with socket.create_server(("127.0.0.1", 0)) as silent:
        url = f"bolt://127.0.0.1:{silent.getsockname()[1]}"
        said = failure(url=url, timeout=0.2)
    assert f"memory {url}" in said and ("did not answer within 0.2 s" in said or "cannot be reached" in said)


def test_a_server_of_another_protocol_is_reported() -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:

        def answer() -> None:
            client, _ = other.accept()
            with client:
                client.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")

        thread = threading.Thread(target=answer)
        thread.start()
        assert "cannot be reached" in failure(url=f"bolt://127.0.0.1:{other.getsockname()[1]}", timeout=5)
        thread.join()


def test_a_server_that_stalls_after_the_opening_is_reported(
    bolt_server: dict[str, Any], proxy: Proxy, open_here: Open
) -> None:
    memory = open_here(**{**bolt_server, "url": proxy.url, "timeout": 6.0})
    ada = memory.create("Person", name="Ada").result()
    proxy.flowing.clear()
    with pytest.raises(PlatformError, match=r"did not answer within 6 s"):
        memory.find("Person", name="Ada").result()
    proxy.flowing.set()
    assert memory.get(ada.id).result() == ada


def test_a_connection_that_the_server_closes_is_opened_again(
    bolt_server: dict[str, Any], proxy: Proxy, open_here: Open
) -> None:
    memory = open_here(**{**bolt_server, "url": proxy.url})
    ada = memory.create("Person", name="Ada").result()
    proxy.hang_up()
    memory.relate(ada, "likes", ada).result()
    proxy.hang_up()
    assert memory.related(ada, "likes").result() == [ada]


def test_two_clients_share_a_server(bolt_server: dict[str, Any], open_here: Open) -> None:
    first, second = open_here(**bolt_server), open_here(**bolt_server)
    ada = first.create("Person", name="Ada").result()
    second.update(ada, age=36).result()
    assert first.get(ada.id).result() == ada.with_properties(age=36)


def test_the_password_can_come_from_the_environment(
    bolt_server: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    from ravestate.settings import load_settings

    monkeypatch.setenv("RAVESTATE_ONTOLOGY_PASSWORD", PASSWORD)
    given = {key: value for key, value in bolt_server.items() if key != "password"}
    settings = load_settings([ontology.module], {"ontology": given})["ontology"]
    assert PASSWORD not in repr(settings)
    memory = open_memory(settings)
    memory.opened().result(60)
    memory.close().result(60)


def test_the_error_names_a_missing_package(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "neo4j", None)
    said = failure(url="bolt://localhost:1", database=DATABASE)
    assert said == "ontology needs neo4j for the server bolt://localhost:1: pip install 'ravestate[neo4j]'"
