"""Chats with slow answers, chats that close meanwhile, groups, edits, and a file that cannot be written."""

import contextlib
import sqlite3
from collections.abc import Generator
from pathlib import Path

import pytest

import ravestate as rs
from modules.platform.chats.messenger import Post, letter, parrot, room
from modules.platform.webio.visit import in_virtual_time, past
from ravestate.modules import interloc, rawio
from ravestate.modules.platform.chats import DeliveryError, Outgoing, Person

ADA, BOB = Person("1", "Ada"), Person("2", "Bob")

slow = rs.Module("slow", requires=(rawio,))


@slow.rule(when=rawio.input.changed, writes=rawio.output)
async def think(ctx: rs.RuleContext) -> None:
    await ctx.sleep(3.0)
    ctx[rawio.output] = ctx.payload(rawio.input.changed)


greeter = rs.Module("greeter", requires=(rawio, interloc))


@greeter.rule(when=interloc.users.added, writes=rawio.output)
async def greet(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = f"Hello {ctx.payload(interloc.users.added).item}!"


# ------------------------------------------------------------------------------------ chats that close


@in_virtual_time
async def test_a_user_who_blocks_the_agent_during_an_answer_ends_only_their_own_chat(tmp_path: Path) -> None:
    post = Post()
    async with room(tmp_path, post, slow) as opened:
        opened.receive([letter("one", "a"), letter("two", "b")])
        await past(0.5)
        opened.receive([letter(chat="a", kind="left")])
        await past(10.0)
        assert [each.text for each in post.sent] == ["two"]
        opened.receive([letter("I am back", "a")])
        assert (await post.said(2))[1:] == ["a: I am back"]


@in_virtual_time
async def test_a_refusal_of_the_messenger_during_a_slow_answer_ends_only_that_chat(tmp_path: Path) -> None:
    post = Post()
    async with room(tmp_path, post, slow, greeter) as opened:
        post.failures += [DeliveryError("blocked", gone=True)]
        opened.receive([letter("one", "a"), letter("two", "b")])
        assert await post.said(2) == ["b: Hello B!", "b: two"]
        await past(10.0)
        assert len(opened) == 1
        assert len(post.sent) == 2


@in_virtual_time
async def test_a_user_who_leaves_and_immediately_returns_gets_an_answer(tmp_path: Path) -> None:
    post = Post()
    async with room(tmp_path, post, slow) as opened:
        opened.receive([letter(kind="left"), letter("I am back")])
        assert await post.said(1) == ["a: I am back"]
        opened.receive([letter("one")])
        await past(1.0)
        opened.receive([letter(kind="left"), letter("back again")])
        assert (await post.said(2))[1:] == ["a: back again"]
        await past(60.0)
        assert len(post.sent) == 2
    async with room(tmp_path, post, slow):
        await past(10.0)
        assert len(post.sent) == 2


class LateRefusal(Post):
    """A messenger that takes 2 s to report that the chat is closed."""

    async def send(self, message: Outgoing, again: bool) -> str:
        if message.text == "one":
            await past(2.0)
            raise DeliveryError("blocked", gone=True)
        return await super().send(message, again)


@in_virtual_time
async def test_a_late_refusal_does_not_close_the_chat_of_a_user_who_has_returned(tmp_path: Path) -> None:
    post = LateRefusal()
    async with room(tmp_path, post, slow) as opened:
        opened.receive([letter("one")])
        await past(4.0)
        opened.receive([letter(kind="left"), letter("I am back")])
        assert await post.said(1) == ["a: I am back"]


# ------------------------------------------------------------------------------------ groups


@in_virtual_time
async def test_a_slow_answer_to_one_person_is_sent_even_if_another_person_returns_meanwhile(tmp_path: Path) -> None:
    post = Post()
    async with room(tmp_path, post, slow, greeter, rest=60.0) as opened:
        opened.receive([letter("one", "g", person=ADA, group=True), letter("two", "g", person=BOB, group=True)])
        await post.said(4)
        await past(61.0)
        assert len(opened) == 0
        opened.receive([question := letter("three", "g", person=ADA, group=True)])
        await past(1.5)
        opened.receive([letter("four", "g", person=BOB, group=True)])
        assert (await post.said(6))[4:] == ["g: three", "g: four"]
        assert post.sent[4].to == question.id


@pytest.mark.parametrize("seconds", [3.0, 30.0])
def test_a_question_is_answered_even_if_another_person_asks_to_be_forgotten(tmp_path: Path, seconds: float) -> None:
    thinker = rs.Module("thinker", requires=(rawio,))

    @thinker.rule(when=rawio.input.changed, writes=rawio.output)
    async def think(ctx: rs.RuleContext) -> None:
        await ctx.sleep(seconds)
        ctx[rawio.output] = ctx.payload(rawio.input.changed)

    @in_virtual_time
    async def test() -> None:
        post = Post()
        async with room(tmp_path, post, thinker) as opened:
            opened.receive([letter("zero", "g", person=BOB, group=True)])
            await post.said(1)
            opened.receive([letter("one", "g", person=ADA, group=True)])
            await past(1.5)
            opened.receive([command := letter("forget", "g", person=BOB, group=True, kind="command")])
            said = (await post.said(3))[1:]
            await past(120.0)
            assert len(post.sent) == 3
        answer = "g: I have forgotten you, and everything that you told me."
        assert said == (["g: one", answer] if seconds < 10.0 else [answer, "g: one"])
        assert post.sent[1 + said.index(answer)].to == command.id

    test()


# ------------------------------------------------------------------------------------ edits


@in_virtual_time
async def test_a_newcomer_who_edits_their_first_message_before_it_is_heard_is_greeted(tmp_path: Path) -> None:
    post = Post()
    async with room(tmp_path, post) as opened:
        message = letter("tee")
        opened.receive([message, letter("tea", id=message.id, kind="edit")])
        assert await post.said(2) == ["a: Hello A!", "a: tea"]
        opened.receive([letter("more")])
        assert (await post.said(3))[2:] == ["a: more"]


# ------------------------------------------------------------------------------------ the file


@contextlib.contextmanager
def not_writable(connection: sqlite3.Connection) -> Generator[None]:
    connection.execute("PRAGMA query_only=ON")
    try:
        yield
    finally:
        connection.execute("PRAGMA query_only=OFF")


@pytest.mark.parametrize("delay", [0.0, 1.0, 2.99])
def test_a_file_that_cannot_be_written_delays_an_answer_but_does_not_lose_it(
    tmp_path: Path, connections: list[sqlite3.Connection], delay: float
) -> None:
    """The file becomes unwritable before the agent hears the message, while it thinks, or when it answers."""

    @in_virtual_time
    async def test() -> None:
        post = Post()
        async with room(tmp_path, post, slow, rest=60.0) as opened:
            opened.receive([letter("one")])
            if delay:
                await past(delay)
            with not_writable(connections[-1]):
                await past(20.0)
                assert post.sent == []
            assert await post.said(1) == ["a: one"]
            opened.receive([letter("two")])
            assert await post.said(2) == ["a: one", "a: two"]
            await past(70.0)
            assert len(opened) == 0
            assert opened.store.pending() == []

    test()


@in_virtual_time
async def test_an_agent_that_ends_while_the_file_cannot_be_written_answers_after_the_next_start(
    tmp_path: Path, connections: list[sqlite3.Connection], caplog: pytest.LogCaptureFixture
) -> None:
    post = Post()
    async with room(tmp_path, post, slow) as opened:
        opened.receive([letter("one")])
        await past(1.0)
        connections[-1].execute("PRAGMA query_only=ON")
    assert post.sent == []
    assert [record.levelname for record in caplog.records if record.exc_info] == []
    assert "the agent answers again after its next start" in caplog.text
    async with room(tmp_path, post, slow) as opened:
        assert await post.said(1) == ["a: one"]
        await past(10.0)
        assert opened.store.pending() == []
    assert len(post.sent) == 1


@in_virtual_time
async def test_an_unprompted_utterance_is_sent_once_the_file_can_be_written_again(
    tmp_path: Path, connections: list[sqlite3.Connection]
) -> None:
    post = Post()
    herald = rs.Module("herald", requires=(rawio,))
    news = herald.signal("news", input=True)

    @herald.rule(when=news, writes=rawio.output)
    async def tell(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "News!"

    async with room(tmp_path, post, parrot, herald) as opened:
        opened.receive([letter("one")])
        await post.said(2)
        await past(5.0)
        [context] = opened.agent.contexts
        with not_writable(connections[-1]):
            context.emit(news)
            await past(10.0)
            assert len(post.sent) == 2
        assert (await post.said(3))[2:] == ["a: News!"]
