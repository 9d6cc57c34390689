"""The carrier: it sends messages to Matrix rooms, and fetches files."""

from __future__ import annotations

import asyncio
import contextlib
import io
import json
from collections.abc import Generator
from typing import Any
from urllib.parse import urlsplit

import aiohttp
from nio import AsyncClient, EncryptionError, ErrorResponse, LocalProtocolError  # pyright: ignore[reportMissingTypeStubs]
from nio.crypto import decrypt_attachment  # pyright: ignore[reportMissingTypeStubs]

from ravestate.modules.platform.chats import DeliveryError, Outgoing, is_emoji

GONE = ("M_FORBIDDEN", "M_NOT_FOUND")  # the room is closed to the agent
FINAL = ("M_TOO_LARGE", "M_BAD_JSON", "M_INVALID_PARAM", "M_UNRECOGNIZED")  # every further attempt would fail, too
LOST = (aiohttp.ClientError, TimeoutError, asyncio.TimeoutError, OSError)
"""The failures of the connection. After most of them, the request may still have reached the server."""

FILE = 60.0  # the maximum number of seconds to transfer a file
JPEG = b"\xff\xd8"  # the first bytes of a JPEG file
WRITING = 5000  # a room shows for this many milliseconds that the agent is writing


class MatrixCarrier:
    """Sends messages from an account; see `Carrier`. A homeserver drops a message whose `Outgoing.key` it knows."""

    longest = longest_caption = 16_000  # the limit of an event is 64 kB
    rate = 50.0

    def __init__(self, client: AsyncClient) -> None:
        self._client = client

    def trace(self, chat: str) -> str:
        """Return an empty text, because the server itself recognises a repeated message."""
        return ""

    def can_react(self, emoji: str) -> bool:
        """Return whether a text is one emoji. Matrix accepts every emoji."""
        return is_emoji(emoji)

    async def send(self, message: Outgoing, again: bool) -> str:
        """Send a message, and return its id. A repeated message keeps its first id, and so does an edited message."""
        answer: Any
        with _delivery():
            if message.kind == "delete":
                answer = await self._client.room_redact(message.chat, message.to, tx_id=message.key)
            else:
                kind, content = await self._content(message)
                answer = await self._client.room_send(
                    message.chat, kind, content, tx_id=message.key, ignore_unverified_devices=True
                )
        id = str(_checked(answer).event_id)
        return message.to if message.kind == "edit" else id

    async def _content(self, message: Outgoing) -> tuple[str, dict[str, Any]]:
        """Return the type and the content of the event for a message."""
        text, to = message.text, message.to
        if message.kind == "reaction":
            return "m.reaction", {"m.relates_to": {"rel_type": "m.annotation", "event_id": to, "key": text}}
        content: dict[str, Any] = {"msgtype": "m.text", "body": text}
        if message.kind == "edit":
            change = {"rel_type": "m.replace", "event_id": to}
            return "m.room.message", {**content, "body": f"* {text}", "m.new_content": content, "m.relates_to": change}
        if message.kind == "picture":
            kind = "image/jpeg" if message.data.startswith(JPEG) else "image/png"
            content = {"msgtype": "m.image", "body": text or "picture", **await self._upload(message, kind)}
        elif message.kind == "voice":
            place = await self._upload(message, "audio/ogg")
            content = {"msgtype": "m.audio", "body": text, **place, "org.matrix.msc3245.voice": {}}
        if to:
            content["m.relates_to"] = {"m.in_reply_to": {"event_id": to}}
        return "m.room.message", content

    async def _upload(self, message: Outgoing, kind: str) -> dict[str, Any]:
        """Upload a message's file, encrypted if the room is encrypted. Return the fields with the file's address."""
        room, data = self._client.rooms.get(message.chat), message.data
        secret = room is not None and room.encrypted and self._client.olm is not None
        answer: Any
        async with asyncio.timeout(FILE):
            answer, keys = await self._client.upload(io.BytesIO(data), kind, encrypt=secret, filesize=len(data))
        url = str(_checked(answer).content_uri)
        return {"file": {**(keys or {}), "url": url, "mimetype": kind}} if secret else {"url": url}

    async def fetch(self, file: str) -> bytes:
        """Return the bytes of a file. `file` is an address, or the JSON that describes an encrypted file."""
        with _undamaged():
            found: dict[str, Any] = {"url": file} if file.startswith("mxc:") else json.loads(file)
            if urlsplit(str(found["url"])).scheme != "mxc":
                raise ValueError(f"{found['url']!r} is no mxc address")
        with _delivery():
            client: Any = self._client
            async with asyncio.timeout(FILE):
                answer = await client.download(found["url"])
        data = bytes(_checked(answer).body)
        if "key" not in found:
            return data
        with _undamaged():
            return decrypt_attachment(data, found["key"]["k"], found["hashes"]["sha256"], found["iv"])

    async def show_work(self, chat: str, words: str) -> None:
        """Show in the room that the agent is writing. Matrix cannot show the words that are written so far."""
        with _delivery():
            await self._client.room_typing(chat, True, timeout=WRITING)


def _checked(answer: Any) -> Any:
    """Return an answer. If it reports a failure, raise a `DeliveryError` instead."""
    if not isinstance(answer, ErrorResponse):
        if (status := answer.transport_response.status) < 400:
            return answer
        raise DeliveryError(
            f"the server has failed (status {status})", unsure=True
        )  # nio treats the error page as a file
    code = str(answer.status_code)
    if code == "M_LIMIT_EXCEEDED":
        raise DeliveryError(str(answer), wait=(answer.retry_after_ms or 5000) / 1000)
    raise DeliveryError(str(answer), gone=code in GONE, final=code in FINAL, unsure=True)


@contextlib.contextmanager
def _undamaged() -> Generator[None]:
    """Turn the errors of a damaged or forged file into a `DeliveryError`.

    The sender has written all fields of the file, so no field can be trusted.
    """
    try:
        yield
    except (EncryptionError, LookupError, TypeError, ValueError, AttributeError, ArithmeticError) as error:
        raise DeliveryError(f"the file is damaged: {type(error).__name__}: {error}", final=True) from None


@contextlib.contextmanager
def _delivery() -> Generator[None]:
    """Turn the errors of the connection into a `DeliveryError`."""
    try:
        yield
    except (EncryptionError, LocalProtocolError) as error:  # the room or its keys are not known yet
        raise DeliveryError(f"{type(error).__name__}: {error}") from None
    except LOST as error:
        unsure = not isinstance(error, aiohttp.ClientConnectorError)
        raise DeliveryError(f"{type(error).__name__}: {error}", unsure=unsure) from None
