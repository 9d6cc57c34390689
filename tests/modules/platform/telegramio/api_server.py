"""A stand-in for Telegram's Bot API server, on this machine: ``python api_server.py PORT FILE``.

It has the methods that the agent calls, follows the rules of Telegram, and makes calls fail on demand. It keeps
everything in a file, so a test can kill and restart it. Each well-formed token is a separate bot, so tests do not
disturb each other. The tests act as users through the path ``/control``.
"""

from __future__ import annotations

import asyncio
import contextlib
import email
import email.policy
import json
import sqlite3
import sys
import time
from collections import defaultdict
from typing import Any
from urllib.parse import parse_qsl

import httpx
import uvicorn
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

LONGEST = 4096
FOREVER = 3600.0
TABLES = """
CREATE TABLE IF NOT EXISTS updates (bot TEXT, id INTEGER, data TEXT, PRIMARY KEY (bot, id));
CREATE TABLE IF NOT EXISTS messages (n INTEGER PRIMARY KEY, bot TEXT, chat INTEGER, id INTEGER, own INTEGER, data TEXT);
CREATE TABLE IF NOT EXISTS counts (bot TEXT, name TEXT, value INTEGER, PRIMARY KEY (bot, name));
CREATE TABLE IF NOT EXISTS chats (bot TEXT, id INTEGER, state TEXT, PRIMARY KEY (bot, id));
CREATE TABLE IF NOT EXISTS files (id TEXT PRIMARY KEY, data BLOB);
CREATE TABLE IF NOT EXISTS hooks (bot TEXT PRIMARY KEY, url TEXT, secret TEXT);
"""


class Refusal(Exception):
    """A call that the server refuses, with the answer."""

    def __init__(self, code: int, description: str, **parameters: Any) -> None:
        super().__init__(description)
        self.code = code
        self.body = {"ok": False, "error_code": code, "description": description}
        if parameters:
            self.body["parameters"] = parameters


class Server:
    """The state of all bots, and the methods of the Bot API."""

    def __init__(self, file: str) -> None:
        self.db = sqlite3.connect(file, isolation_level=None)
        self.db.execute("PRAGMA journal_mode=WAL")
        self.db.execute("PRAGMA synchronous=OFF")
        self.db.executescript(TABLES)
        self.changed = asyncio.Condition()
        self.polls: dict[str, asyncio.Event] = {}  # for each bot: set this event to end its open request for updates
        self.faults: dict[tuple[str, str], list[dict[str, Any]]] = defaultdict(list)
        self.banned: dict[tuple[str, str], float] = {}  # for each bot and chat: the time at which its flood wait ends
        self.calls: dict[str, list[dict[str, Any]]] = defaultdict(list)
        self.early: dict[str, int] = defaultdict(int)  # for each bot: the number of calls during a flood wait
        self.tasks: dict[str, asyncio.Task[None]] = {}

    # ------------------------------------------------------------------------------------ state

    def all(self, query: str, *values: Any) -> list[Any]:
        return self.db.execute(query, values).fetchall()

    def count(self, bot: str, name: str) -> int:
        self.db.execute(
            "INSERT INTO counts VALUES (?, ?, 1) ON CONFLICT (bot, name) DO UPDATE SET value = value + 1", (bot, name)
        )
        return self.all("SELECT value FROM counts WHERE bot = ? AND name = ?", bot, name)[0][0]

    async def tell(self) -> None:
        async with self.changed:
            self.changed.notify_all()

    def me(self, bot: str) -> dict[str, Any]:
        return {"id": int(bot.split(":")[0]), "is_bot": True, "first_name": "Robin", "username": "robin_bot"}

    def chat(self, id: int) -> dict[str, Any]:
        return {"id": id, "type": "private", "first_name": "A"} if id > 0 else {
            "id": id, "title": "Club", "type": "supergroup" if id < -10**12 else "group"}  # fmt: skip

    def add(self, bot: str, chat: int, own: bool, **fields: Any) -> dict[str, Any]:
        """Add a message to a chat.

        Private chats and small groups share one numbering of messages. Each large group has its own.
        """
        id = self.count(bot, str(chat) if chat < -(10**12) else "messages")
        message = {"message_id": id, "date": int(time.time()), "chat": self.chat(chat), **fields}
        self.db.execute(
            "INSERT INTO messages (bot, chat, id, own, data) VALUES (?, ?, ?, ?, ?)",
            (bot, chat, id, own, json.dumps(message)),
        )
        return message

    async def update(self, bot: str, kind: str, data: Any) -> int:
        id = self.count(bot, "updates") + 1000
        whole = {"update_id": id, kind: data} if kind else {"update_id": id, **data}
        self.db.execute("INSERT INTO updates VALUES (?, ?, ?)", (bot, id, json.dumps(whole)))
        await self.tell()
        return id

    def updates(self, bot: str, offset: int = 0, limit: int = 100) -> list[Any]:
        rows = self.all("SELECT data FROM updates WHERE bot = ? AND id >= ? ORDER BY id LIMIT ?", bot, offset, limit)
        return [json.loads(data) for (data,) in rows]

    def own(self, bot: str, chat: int, id: int) -> dict[str, Any]:
        rows = self.all("SELECT own, data FROM messages WHERE bot = ? AND chat = ? AND id = ?", bot, chat, id)
        if not rows:
            raise Refusal(400, "Bad Request: message to edit not found")
        if not rows[0][0]:
            raise Refusal(400, "Bad Request: message can't be edited")
        return json.loads(rows[0][1])

    def keep(self, bot: str, message: dict[str, Any]) -> None:
        self.db.execute(
            "UPDATE messages SET data = ? WHERE bot = ? AND chat = ? AND id = ?",
            (json.dumps(message), bot, message["chat"]["id"], message["message_id"]),
        )

    def writable(self, bot: str, chat: int) -> None:
        state = self.all("SELECT state FROM chats WHERE bot = ? AND id = ?", bot, chat)
        if not state:
            raise Refusal(400, "Bad Request: chat not found")
        if state[0][0] == "blocked":
            raise Refusal(403, "Forbidden: bot was blocked by the user")
        if state[0][0] == "left":
            raise Refusal(403, "Forbidden: bot was kicked from the group chat")
        if state[0][0].startswith("moved"):
            new = int(state[0][0].split()[1])
            raise Refusal(400, "Bad Request: group chat was upgraded to a supergroup chat", migrate_to_chat_id=new)

    # ------------------------------------------------------------------------------------ methods

    async def getMe(self, bot: str, a: dict[str, Any]) -> Any:
        return self.me(bot)

    async def setMyCommands(self, bot: str, a: dict[str, Any]) -> Any:
        return all(command["command"] and command["description"] for command in json.loads(a["commands"]))

    async def setWebhook(self, bot: str, a: dict[str, Any]) -> Any:
        self.db.execute("INSERT OR REPLACE INTO hooks VALUES (?, ?, ?)", (bot, a["url"], a.get("secret_token", "")))
        self.deliver(bot)
        return True

    async def deleteWebhook(self, bot: str, a: dict[str, Any]) -> Any:
        self.db.execute("DELETE FROM hooks WHERE bot = ?", (bot,))
        if task := self.tasks.pop(bot, None):
            task.cancel()
        return True

    def deliver(self, bot: str) -> None:
        if bot not in self.tasks:
            self.tasks[bot] = asyncio.create_task(self._deliver(bot))

    async def _deliver(self, bot: str) -> None:
        async with httpx.AsyncClient() as client:
            while True:
                [(url, secret)] = self.all("SELECT url, secret FROM hooks WHERE bot = ?", bot)
                for update in self.updates(bot):
                    headers = {"X-Telegram-Bot-Api-Secret-Token": secret}
                    with contextlib.suppress(httpx.HTTPError):
                        answer = await client.post(url, json=update, headers=headers)
                        if answer.status_code == 200:
                            self.db.execute("DELETE FROM updates WHERE bot = ? AND id = ?", (bot, update["update_id"]))
                with contextlib.suppress(TimeoutError):
                    async with asyncio.timeout(0.2), self.changed:
                        await self.changed.wait()

    async def getUpdates(self, bot: str, a: dict[str, Any]) -> Any:
        if self.all("SELECT 1 FROM hooks WHERE bot = ?", bot):
            raise Refusal(409, "Conflict: can't use getUpdates method while webhook is active")
        if bot in self.polls:
            self.polls[bot].set()
            await self.tell()
        ended = self.polls[bot] = asyncio.Event()
        offset, limit = int(a.get("offset", 0)), int(a.get("limit", 100))
        self.db.execute("DELETE FROM updates WHERE bot = ? AND id < ?", (bot, offset))
        try:
            async with asyncio.timeout(float(a.get("timeout", 0))), self.changed:
                await self.changed.wait_for(lambda: ended.is_set() or self.updates(bot, offset, 1))
        except TimeoutError:
            pass
        if ended.is_set():
            raise Refusal(
                409, "Conflict: terminated by other getUpdates request; make sure that only one bot instance is running"
            )
        del self.polls[bot]
        return self.updates(bot, offset, limit)

    async def send(self, bot: str, a: dict[str, Any], **fields: Any) -> Any:
        chat = int(a["chat_id"])
        self.writable(bot, chat)
        if "reply_parameters" in a:
            reply = json.loads(a["reply_parameters"])
            fields["reply_to_message"] = {
                "message_id": reply["message_id"], "date": 0, "chat": self.chat(chat)
            }  # fmt: skip
        if "message_thread_id" in a:
            fields["message_thread_id"] = int(a["message_thread_id"])
        message = self.add(bot, chat, True, **{"from": self.me(bot)}, **fields)
        await self.tell()
        return message

    async def sendMessage(self, bot: str, a: dict[str, Any]) -> Any:
        text = a.get("text", "")
        if not text.strip():
            raise Refusal(400, "Bad Request: message text is empty")
        if len(text) > LONGEST:
            raise Refusal(400, "Bad Request: message is too long")
        return await self.send(bot, a, text=text)

    def file(self, data: bytes) -> dict[str, Any]:
        id = f"file{self.count('', 'files')}"
        self.db.execute("INSERT INTO files VALUES (?, ?)", (id, data))
        return {"file_id": id, "file_unique_id": id, "file_size": len(data)}

    def caption(self, a: dict[str, Any]) -> str:
        if len(a.get("caption", "")) > LONGEST // 4:
            raise Refusal(400, "Bad Request: message caption is too long")
        return a.get("caption", "")

    async def sendPhoto(self, bot: str, a: dict[str, Any]) -> Any:
        photo = {**self.file(a["photo"]), "width": 90, "height": 60}
        return await self.send(bot, a, photo=[photo], caption=self.caption(a))

    async def sendVoice(self, bot: str, a: dict[str, Any]) -> Any:
        voice = {**self.file(a["voice"]), "duration": 1, "mime_type": "audio/ogg"}
        return await self.send(bot, a, voice=voice, caption=self.caption(a))

    async def editMessageText(self, bot: str, a: dict[str, Any]) -> Any:
        message = self.own(bot, int(a["chat_id"]), int(a["message_id"]))
        if message.get("text") == a["text"]:
            raise Refusal(
                400,
                "Bad Request: message is not modified: specified new message content and reply markup are exactly the same",
            )
        message = {**message, "text": a["text"], "edit_date": int(time.time())}
        self.keep(bot, message)
        await self.tell()
        return message

    async def deleteMessage(self, bot: str, a: dict[str, Any]) -> Any:
        which = bot, int(a["chat_id"]), int(a["message_id"])
        deleted = self.db.execute("DELETE FROM messages WHERE bot = ? AND chat = ? AND id = ? AND own", which)
        if not deleted.rowcount:
            raise Refusal(400, "Bad Request: message to delete not found")
        await self.tell()
        return True

    async def editMessageReplyMarkup(self, bot: str, a: dict[str, Any]) -> Any:
        self.own(bot, int(a["chat_id"]), int(a["message_id"]))
        raise Refusal(
            400,
            "Bad Request: message is not modified: specified new message content and reply markup are exactly the same",
        )

    async def sendMessageDraft(self, bot: str, a: dict[str, Any]) -> Any:
        chat = int(a["chat_id"])
        self.writable(bot, chat)
        if chat < 0:
            raise Refusal(400, "Bad Request: drafts can be sent to private chats only")
        if not int(a["draft_id"]) or len(a.get("text", "")) > LONGEST:
            raise Refusal(400, "Bad Request: DRAFT_INVALID")
        await self.tell()
        return True

    async def sendChatAction(self, bot: str, a: dict[str, Any]) -> Any:
        self.writable(bot, int(a["chat_id"]))
        await self.tell()
        return True

    async def setMessageReaction(self, bot: str, a: dict[str, Any]) -> Any:
        chat, id = int(a["chat_id"]), int(a["message_id"])
        rows = self.all("SELECT data FROM messages WHERE bot = ? AND chat = ? AND id = ?", bot, chat, id)
        if not rows:
            raise Refusal(400, "Bad Request: message to react not found")
        message = json.loads(rows[0][0])
        reaction = json.loads(a["reaction"])
        message["reaction"] = [each["emoji"] for each in (reaction if isinstance(reaction, list) else [reaction])]
        self.keep(bot, message)
        await self.tell()
        return True

    async def getFile(self, bot: str, a: dict[str, Any]) -> Any:
        rows = self.all("SELECT length(data) FROM files WHERE id = ?", a["file_id"])
        if not rows:
            raise Refusal(400, "Bad Request: wrong file_id or the file is temporarily unavailable")
        if rows[0][0] > 20 * 1024 * 1024:
            raise Refusal(400, "Bad Request: file is too big")
        id = a["file_id"]
        return {"file_id": id, "file_unique_id": id, "file_size": rows[0][0], "file_path": f"files/{id}"}

    # ------------------------------------------------------------------------------------ requests

    async def call(self, request: Request) -> Response:
        bot, method = request.path_params["token"], request.path_params["method"]
        if not bot.partition(":")[0].isdecimal() or "wrong" in bot:
            return JSONResponse({"ok": False, "error_code": 401, "description": "Unauthorized"}, 401)
        if method.startswith("_") or method not in METHODS:
            return JSONResponse({"ok": False, "error_code": 404, "description": "Not Found"}, 404)
        arguments = await form(request)
        chat = str(arguments.get("chat_id", ""))
        self.calls[bot].append({"method": method, "chat": chat, "text": arguments.get("text", "")})
        await self.tell()
        if self.banned.get((bot, chat), 0.0) > time.monotonic():
            self.early[bot] += 1
        faults = self.faults[bot, method]
        fault = next((each for each in faults if each.get("chat") in (None, chat)), None)
        kind = fault["kind"] if fault else ""
        if fault is not None:
            fault["times"] -= 1
            if fault["times"] <= 0:
                faults.remove(fault)
        if fault is not None and kind == "429":
            wait = fault["retry_after"]
            self.banned[bot, chat] = time.monotonic() + wait
            return JSONResponse({"ok": False, "error_code": 429, "description": f"Too Many Requests: retry after {wait}",
                                 "parameters": {"retry_after": wait}}, 429)  # fmt: skip
        if kind == "400":
            return JSONResponse({"ok": False, "error_code": 400, "description": fault["why"]}, 400)
        if kind == "404":
            return JSONResponse({"ok": False, "error_code": 404, "description": "Not Found"}, 404)
        if kind == "409":
            text = "Conflict: terminated by other getUpdates request; make sure that only one bot instance is running"
            return JSONResponse({"ok": False, "error_code": 409, "description": text}, 409)
        if kind in ("500", "502", "503"):
            return Response("<html>Server Error</html>", int(kind))
        if kind == "garbage":
            return Response('{"ok": true, "result":')
        try:
            result = await getattr(self, method)(bot, arguments)
        except Refusal as refusal:
            return JSONResponse(refusal.body, refusal.code)
        if kind == "lost":  # the request takes effect, but its answer never arrives
            return Broken()
        if kind == "hang":
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(FOREVER):
                    await asyncio.Event().wait()
        return JSONResponse({"ok": True, "result": result})

    async def download(self, request: Request) -> Response:
        rows = self.all("SELECT data FROM files WHERE id = ?", request.path_params["id"])
        return Response(rows[0][0]) if rows else Response(status_code=404)

    # ------------------------------------------------------------------------------------ actions of users and tests

    async def control(self, request: Request) -> Response:
        bot, order = request.path_params["token"], request.path_params["order"]
        a = json.loads(await request.body() or b"{}")
        return JSONResponse(await getattr(self, f"do_{order}")(bot, **a))

    async def do_say(self, bot: str, chat: int, text: str | None = None, user: int | None = None, **fields: Any) -> Any:
        """Let a user write a message. `fields` are additional fields of the message."""
        user = user or chat
        self.db.execute("INSERT OR REPLACE INTO chats VALUES (?, ?, 'open')", (bot, chat))
        sender = {"id": user, "is_bot": False, "first_name": f"User{user}", "username": f"user{user}"}
        words = {} if text is None else {"text": text}
        message = self.add(bot, chat, False, **{"from": sender}, **words, **fields)
        await self.update(bot, "message", message)
        return message

    async def do_crowd(self, bot: str, messages: list[dict[str, Any]]) -> Any:
        """Let many users write at the same time."""
        for message in messages:
            await self.do_say(bot, **message)

    async def do_edit(self, bot: str, chat: int, id: int, text: str) -> Any:
        """Let a user edit a message."""
        [(data,)] = self.all("SELECT data FROM messages WHERE bot = ? AND chat = ? AND id = ?", bot, chat, id)
        message = {**json.loads(data), "text": text, "edit_date": int(time.time())}
        self.keep(bot, message)
        return await self.update(bot, "edited_message", message)

    async def do_react(self, bot: str, chat: int, id: int, emoji: str, user: int = 0) -> Any:
        """Let a user react to a message."""
        person = {"id": user or chat, "is_bot": False, "first_name": f"User{user or chat}"}
        return await self.update(bot, "message_reaction", {
            "chat": self.chat(chat), "message_id": id, "user": person, "date": 0, "old_reaction": [],
            "new_reaction": [{"type": "emoji", "emoji": emoji}]})  # fmt: skip

    async def do_state(self, bot: str, chat: int, state: str) -> Any:
        """Let a user block the bot, a group remove it, or a group get another id."""
        self.db.execute("INSERT OR REPLACE INTO chats VALUES (?, ?, ?)", (bot, chat, state))
        if state in ("left", "blocked"):
            me = self.me(bot)
            await self.update(bot, "my_chat_member", {
                "chat": self.chat(chat), "from": {"id": 5, "is_bot": False, "first_name": "Admin"}, "date": 0,
                "old_chat_member": {"user": me, "status": "member"},
                "new_chat_member": {"user": me, "status": "left"} if chat < 0 else {
                    "user": me, "status": "kicked", "until_date": 0}})  # fmt: skip

    async def do_update(self, bot: str, data: dict[str, Any]) -> Any:
        """Report an arbitrary update, e.g. a malformed one."""
        return await self.update(bot, "", data)

    async def do_upload(self, bot: str, size: int = 0, text: str = "", hexed: str = "") -> Any:
        """Let a user upload a file."""
        return self.file(bytes.fromhex(hexed) if hexed else text.encode() or b"\xff\xd8" + bytes(size - 2))

    async def do_fault(self, bot: str, method: str, kind: str, times: int = 1, **more: Any) -> Any:
        """Make the next calls of a method fail."""
        self.faults[bot, method].append({"kind": kind, "times": times, **more})

    async def do_heal(self, bot: str) -> Any:
        """End all faults."""
        for key in [key for key in self.faults if key[0] == bot]:
            del self.faults[key]

    async def do_said(self, bot: str, count: int = 0, wait: float = 100.0) -> Any:
        """Wait until the bot has sent `count` messages, but at most `wait` seconds. Return its messages."""

        def said() -> list[Any]:
            rows = self.all("SELECT data FROM messages WHERE bot = ? AND own ORDER BY n", bot)
            return [json.loads(data) for (data,) in rows]

        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(wait), self.changed:
                query = "SELECT count(*) FROM messages WHERE bot = ? AND own"
                await self.changed.wait_for(lambda: self.all(query, bot)[0][0] >= count)
        return said()

    async def do_called(self, bot: str, method: str, count: int = 0, wait: float = 100.0) -> Any:
        """Wait until there are `count` calls of a method, but at most `wait` seconds.

        Return these calls, and the number of all calls during a flood wait.
        """

        def calls() -> list[Any]:
            return [call for call in self.calls[bot] if call["method"] == method]

        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(wait), self.changed:
                await self.changed.wait_for(lambda: len(calls()) >= count)
        return {"calls": calls(), "early": self.early[bot]}

    async def do_message(self, bot: str, chat: int, id: int) -> Any:
        """Return a message with all its edits and reactions."""
        [(data,)] = self.all("SELECT data FROM messages WHERE bot = ? AND chat = ? AND id = ?", bot, chat, id)
        return json.loads(data)

    async def do_left(self, bot: str) -> Any:
        """Return the number of updates that the bot has not confirmed yet."""
        return len(self.updates(bot))


METHODS = [
    name
    for name in vars(Server)
    if name.startswith(("get", "set", "delete", "sendM", "sendP", "sendV", "sendC", "edit"))
]


class Broken(Response):
    """An answer whose body is shorter than its content length."""

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"1000")]})
        await send({"type": "http.response.body", "body": b'{"ok"', "more_body": False})


class Announced(uvicorn.Server):
    """A server that prints ``ready`` when it listens."""

    async def startup(self, sockets: Any = None) -> None:
        await super().startup(sockets)
        print("ready", flush=True)


async def form(request: Request) -> dict[str, Any]:
    """Return the arguments of a call, from a URL-encoded or a multipart form."""
    body = await request.body()
    kind = request.headers.get("content-type", "")
    if not kind.startswith("multipart/form-data"):
        return dict(parse_qsl(body.decode(), keep_blank_values=True))
    whole = email.message_from_bytes(b"Content-Type: " + kind.encode() + b"\r\n\r\n" + body, policy=email.policy.HTTP)
    found: dict[str, Any] = {}
    files: dict[str, bytes] = {}
    for part in whole.iter_parts():  # type: ignore[attr-defined]
        name = part.get_param("name", header="content-disposition")
        data = part.get_payload(decode=True)
        if part.get_filename():
            files[name] = data
        else:
            found[name] = data.decode()
    for name, value in list(found.items()):
        if value.startswith("attach://"):
            found[name] = files[value.removeprefix("attach://")]
    return {**files, **found}


def application(file: str) -> Starlette:
    """Return an application that serves the Bot API and ``/control``."""
    server = Server(file)

    @contextlib.asynccontextmanager
    async def lifespan(_: Starlette) -> Any:
        for (bot,) in server.all("SELECT bot FROM hooks"):
            server.deliver(bot)
        yield
        for task in server.tasks.values():
            task.cancel()

    return Starlette(
        routes=[
            Route("/bot{token}/{method}", server.call, methods=["GET", "POST"]),
            Route("/file/bot{token}/files/{id}", server.download),
            Route("/control/{token}/{order}", server.control, methods=["POST"]),
        ],
        lifespan=lifespan,
    )


if __name__ == "__main__":
    app, port = application(sys.argv[2]), int(sys.argv[1])
    Announced(uvicorn.Config(app, "127.0.0.1", port, log_level="error", timeout_graceful_shutdown=1)).run()
