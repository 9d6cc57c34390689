"""Fixtures of the Matrix tests: a real homeserver (Synapse), in a separate environment and a separate process."""

import asyncio
import base64
import hashlib
import hmac
import itertools
import os
import socket
import subprocess
from collections.abc import AsyncGenerator, Iterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest
import yaml

from modules.platform.telegramio.conftest import free_port

ROOT = Path(__file__).parents[4]
SECRET = "a secret of the tests alone"
PLENTY = {"per_second": 10_000, "burst_count": 10_000}
PATIENCE = 100.0
_numbers = itertools.count(1)


class Homeserver:
    """A homeserver that can be killed and started again."""

    def __init__(self, folder: Path) -> None:
        self.port = free_port()
        self.url = f"http://127.0.0.1:{self.port}"
        self._folder = folder
        self._python = ROOT / ".venvs" / "synapse" / "bin" / "python"
        if not self._python.exists():
            pytest.fail("the tests of matrixio need Synapse: run make test, which sets it up")
        self._process: subprocess.Popen[bytes] | None = None
        self._configure()

    def _configure(self) -> None:
        config = {
            "server_name": "localhost",
            "listeners": [{"port": self.port, "type": "http", "bind_addresses": ["127.0.0.1"],
                           "resources": [{"names": ["client"]}]}],
            "database": {"name": "sqlite3", "args": {"database": str(self._folder / "homeserver.db")}},
            "media_store_path": str(self._folder / "media"),
            "signing_key_path": str(self._folder / "signing.key"),
            "log_config": str(self._folder / "log.yaml"),
            "registration_shared_secret": SECRET,
            "macaroon_secret_key": SECRET,
            "form_secret": SECRET,
            "report_stats": False,
            "bcrypt_rounds": 4,
            "trusted_key_servers": [],
            "max_upload_size": "50M",
            "presence": {"enabled": False},
            "rc_message": PLENTY,
            "rc_registration": PLENTY,
            "rc_joins": {"local": PLENTY},
            "rc_login": {"address": PLENTY, "account": PLENTY, "failed_attempts": PLENTY},
            "rc_invites": {"per_room": PLENTY, "per_user": PLENTY, "per_issuer": PLENTY},
            "rc_room_creation": PLENTY,
        }  # fmt: skip
        logging = {
            "version": 1,
            "handlers": {"file": {"class": "logging.FileHandler", "filename": str(self._folder / "log.txt")}},
            "root": {"level": "WARNING", "handlers": ["file"]},
        }
        (self._folder / "log.yaml").write_text(yaml.safe_dump(logging))
        (self._folder / "homeserver.yaml").write_text(yaml.safe_dump(config))
        # Without this file, Synapse would spend seconds on making one.
        seed = base64.b64encode(os.urandom(32)).decode().rstrip("=")
        (self._folder / "signing.key").write_text(f"ed25519 a_test {seed}\n")
        self._command = [self._python, "-m", "synapse.app.homeserver", "-c", str(self._folder / "homeserver.yaml")]

    def start(self) -> None:
        ready = self._folder / "ready"
        ready.unlink(missing_ok=True)
        # Synapse reports to this socket that it is ready, as it would to systemd.
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as notice:
            notice.bind(str(ready))
            notice.settimeout(PATIENCE)
            environment = {**os.environ, "NOTIFY_SOCKET": str(ready)}
            self._process = subprocess.Popen(
                self._command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
            )
            try:
                notice.recv(100)
            except TimeoutError:
                pytest.fail((self._folder / "log.txt").read_text())

    def kill(self) -> None:
        assert self._process is not None
        self._process.kill()
        self._process.wait()


class Account:
    """A person's account on a homeserver: ``async with account(server) as ada``."""

    def __init__(self, server: Homeserver, http: httpx.AsyncClient, id: str, token: str) -> None:
        self.server = server
        self.id = id
        self.token = token
        self._http = http
        self._number = itertools.count()
        self._since: str | None = None
        self.heard: list[dict[str, Any]] = []
        """The events of other people in all rooms, in the order in which the server reports them."""

    async def call(self, method: str, path: str, body: Any = None, **query: Any) -> Any:
        headers = {"Authorization": f"Bearer {self.token}"}
        kind = {"content": body} if isinstance(body, bytes) else {"json": {} if body is None else body}
        url = f"{self.server.url}/_matrix/{path}"
        answer = await self._http.request(method, url, params=query, headers=headers, **kind)
        return answer.raise_for_status().json()

    async def room(self, *others: str, **options: Any) -> str:
        """Open a room with other people. A room with one other person is a direct chat."""
        body = {"invite": others, "is_direct": len(others) == 1, "preset": "trusted_private_chat", **options}
        return (await self.call("POST", "client/v3/createRoom", body))["room_id"]

    async def say(self, room: str, text: str, **fields: Any) -> str:
        content = {"msgtype": "m.text", "body": text, **fields}
        return await self.send(room, "m.room.message", content)

    async def send(self, room: str, kind: str, content: Any) -> str:
        path = f"client/v3/rooms/{room}/send/{kind}/test-{next(self._number)}"
        return (await self.call("PUT", path, content))["event_id"]

    async def upload(self, data: bytes) -> str:
        return (await self.call("POST", "media/v3/upload", data))["content_uri"]

    async def kind(self, url: str) -> str:
        """Return the content type of an uploaded file."""
        path = f"{self.server.url}/_matrix/client/v1/media/download/{url.removeprefix('mxc://')}"
        answer = await self._http.get(path, headers={"Authorization": f"Bearer {self.token}"})
        return answer.raise_for_status().headers["Content-Type"]

    async def listen(self, count: int) -> list[str]:
        """Wait until other people have sent `count` messages; return them as "room: text"."""
        async with asyncio.timeout(60):
            while len(self.said) < count:
                query = {"timeout": 30_000, **({"since": self._since} if self._since else {})}
                answer = await self.call(
                    "GET", "client/v3/sync", filter='{"room":{"timeline":{"limit":1000}}}', **query
                )
                self._since = answer["next_batch"]
                for room, info in answer.get("rooms", {}).get("join", {}).items():
                    self.heard += [{**e, "room": room} for e in info["timeline"]["events"] if e["sender"] != self.id]
        return self.said

    @property
    def said(self) -> list[str]:
        """The messages so far. An edited message has its new text."""
        found: dict[str, str] = {}
        for event in self.heard:
            content = event["content"]
            if event["type"] != "m.room.message":
                continue
            relation = content.get("m.relates_to", {})
            if relation.get("rel_type") == "m.replace":
                found[relation["event_id"]] = f"{event['room']}: {content['m.new_content']['body']}"
            else:
                found[event["event_id"]] = f"{event['room']}: {content['body']}"
        return list(found.values())


async def register(server: Homeserver, http: httpx.AsyncClient, name: str, password: str = "password") -> Account:
    """Create an account."""
    path = f"{server.url}/_synapse/admin/v1/register"
    nonce = (await http.get(path)).json()["nonce"]
    user = f"{name.lower()}{next(_numbers)}"
    mac = hmac.new(SECRET.encode(), f"{nonce}\0{user}\0{password}\0notadmin".encode(), hashlib.sha1).hexdigest()
    body = {"nonce": nonce, "username": user, "displayname": name, "password": password, "admin": False, "mac": mac}
    answer = (await http.post(path, json=body)).raise_for_status().json()
    return Account(server, http, answer["user_id"], answer["access_token"])


@asynccontextmanager
async def accounts(server: Homeserver, *names: str) -> AsyncGenerator[list[Account]]:
    """Create an account for each of these names."""
    async with httpx.AsyncClient(timeout=60.0, trust_env=False) as http:
        yield [await register(server, http, name) for name in names]


@pytest.fixture(scope="session")
def homeserver(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Homeserver]:
    server = Homeserver(tmp_path_factory.mktemp("synapse"))
    server.start()
    yield server
    server.kill()
