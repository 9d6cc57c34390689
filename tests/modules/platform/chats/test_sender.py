"""The sender limits the rate of messages, and handles refused voice notes and a file that cannot be written."""

import asyncio
import sqlite3
from pathlib import Path

from modules.platform.chats.messenger import Post, letter, room
from modules.platform.webio.visit import in_virtual_time, past
from ravestate.modules.platform.chats import DeliveryError, Outgoing
from ravestate.modules.platform.chats.sender import Pace
from ravestate.modules.platform.chats.store import Answer


@in_virtual_time
async def test_the_method_spare_returns_true_only_if_a_message_can_be_sent_now() -> None:
    pace = Pace(20.0)
    await past(10.0)
    while pace.spare():  # use up the burst
        pass
    await pace.turn()
    assert not pace.spare()
    await past(0.051)
    assert pace.spare()
    assert not pace.spare()


@in_virtual_time
async def test_within_any_second_at_most_30_messages_are_sent() -> None:
    pace, times = Pace(25.0), list[float]()
    for pause in (10.0, 3.0):
        await past(pause)
        for _ in range(60):
            await pace.turn()
            times.append(asyncio.get_running_loop().time())
    assert max(sum(start <= time < start + 1.0 for time in times) for start in times) <= 30


@in_virtual_time
async def test_a_voice_note_that_the_messenger_refuses_is_sent_as_text(tmp_path: Path) -> None:
    post = Post()
    post.failures += [DeliveryError("VOICE_MESSAGES_FORBIDDEN", final=True)]
    async with room(tmp_path, post) as opened:
        opened.store.commit([Answer(Outgoing(key="1", chat="a", kind="voice", text="Hello", to="7"))])
        opened.sender.wake("a")
        await post.said(1)
        assert [(each.kind, each.text, each.to) for each in post.sent] == [("text", "Hello", "7")]
        await past(1.0)
        assert opened.store.chats_to_send() == []


class Stubborn(Post):
    """A messenger. During each of its first two deliveries, the store's file is unwritable for 20 s."""

    def __init__(self) -> None:
        super().__init__()
        self.spoil = [True, True]

    async def send(self, message: Outgoing, again: bool) -> str:
        id = await super().send(message, again)
        if self.spoil:
            self.spoil.pop()
            self.database.execute("PRAGMA query_only=ON")
            asyncio.get_running_loop().call_later(20.0, self.database.execute, "PRAGMA query_only=OFF")
        return id


@in_virtual_time
async def test_a_message_is_sent_once_even_if_the_file_cannot_be_written_meanwhile(
    tmp_path: Path, connections: list[sqlite3.Connection]
) -> None:
    post = Stubborn()
    async with room(tmp_path, post) as opened:
        [post.database] = connections
        opened.receive([letter("one")])
        assert await post.said(2) == ["a: Hello A!", "a: one"]
        await past(60.0)
        assert (len(post.sent), opened.store.chats_to_send()) == (2, [])
