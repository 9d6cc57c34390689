"""Encrypted rooms on a real homeserver. The user's client has its own keys."""

import io
from pathlib import Path
from typing import Any

import nio
from nio.crypto import decrypt_attachment

import ravestate as rs
from modules.platform.matrixio.conftest import Account, Homeserver
from modules.platform.matrixio.test_serving import live, running
from modules.platform.telegramio.test_serving import parrot
from ravestate.modules import matrixio, rawio

ENCRYPTED = {"type": "m.room.encryption", "state_key": "", "content": {"algorithm": "m.megolm.v1.aes-sha2"}}

PICTURE = b"\x89PNG and so on"

painter = rs.Module("painter", requires=(rawio,))


@painter.rule(when=rawio.input.changed.where("Paint!".__eq__), reads=matrixio.chat)
async def paint(ctx: rs.RuleContext) -> None:
    ctx[matrixio.chat].send_picture(PICTURE, "a tree")


class Client:
    """A user with a client that can encrypt."""

    def __init__(self, account: Account, folder: Path) -> None:
        folder.mkdir()
        self._nio: Any = nio.AsyncClient(account.server.url, account.id, "PHONE", str(folder))
        self.heard: list[Any] = []

    async def __aenter__(self) -> "Client":
        await self._nio.login("password")
        await self.sync()
        return self

    async def __aexit__(self, *_: object) -> None:
        await self._nio.close()

    async def sync(self) -> None:
        client = self._nio
        answer = await client.sync(timeout=1000)
        await client.send_to_device_messages()
        if client.should_upload_keys:
            await client.keys_upload()
        if client.should_query_keys:
            await client.keys_query()
        for info in answer.rooms.join.values():
            self.heard += [
                e for e in info.timeline.events if isinstance(e, nio.RoomMessage) and e.sender != client.user
            ]

    async def until_joined(self, room: str, other: str) -> None:
        while not (known := self._nio.rooms.get(room)) or other not in known.users or known.users[other].invited:
            await self.sync()

    async def send(self, room: str, content: Any) -> None:
        await self._nio.room_send(room, "m.room.message", content, ignore_unverified_devices=True)

    async def send_picture(self, room: str, data: bytes) -> None:
        answer, keys = await self._nio.upload(io.BytesIO(data), "image/png", encrypt=True, filesize=len(data))
        await self.send(room, {"msgtype": "m.image", "body": "x.png", "file": {**keys, "url": answer.content_uri}})

    async def listen(self, count: int) -> list[Any]:
        while len(self.heard) < count:
            await self.sync()
        return self.heard

    async def picture(self, event: Any) -> bytes:
        answer = await self._nio.download(event.url)
        return decrypt_attachment(answer.body, event.key["k"], event.hashes["sha256"], event.iv)


def test_texts_and_pictures_pass_in_an_encrypted_room_even_after_a_restart(
    homeserver: Homeserver, tmp_path: Path
) -> None:
    @live("Robin", "Ada")
    async def test(folder: Path, robin: Account, account: Account) -> None:
        async with Client(account, folder / "ada") as ada:
            async with running(robin, folder, parrot, painter):
                room = await account.room(robin.id, initial_state=[ENCRYPTED])
                await ada.until_joined(room, robin.id)
                await ada.send(room, {"msgtype": "m.text", "body": "Hello"})
                assert [each.body for each in await ada.listen(1)] == ["Hello"]
                await ada.send_picture(room, bytes(1000))
                assert [each.body for each in await ada.listen(2)] == ["Hello", "1000 bytes"]
                await ada.send(room, {"msgtype": "m.text", "body": "Paint!"})
                pictures = [each for each in await ada.listen(4) if isinstance(each, nio.RoomEncryptedImage)]
                assert [await ada.picture(each) for each in pictures] == [PICTURE]
            await ada.send(room, {"msgtype": "m.text", "body": "Are you there?"})
            async with running(robin, folder):  # the agent has kept its keys
                heard = await ada.listen(5)
        assert heard[-1].body == "Are you there?"
        assert all(each.decrypted for each in heard)

    test(homeserver, tmp_path)
