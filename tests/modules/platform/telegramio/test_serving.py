"""An agent on Telegram, with a stand-in for the Bot API server in a separate process."""

import asyncio
import contextlib
import logging
from collections.abc import AsyncGenerator, Callable, Coroutine
from pathlib import Path
from typing import Any

import pytest

import ravestate as rs
from modules.platform.chats.faults import fill_disk
from modules.platform.telegramio.conftest import Bot, free_port
from ravestate.errors import PlatformError
from ravestate.modules import interloc, rawio, telegramio
from ravestate.modules.platform.chats.voice import spoken
from ravestate.runtime.agent import Agent

parrot = rs.Module("parrot", requires=(rawio, interloc))
PATIENCE = 60.0


@parrot.rule(when=rawio.input.changed, writes=rawio.output)
async def repeat(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = ctx.payload(rawio.input.changed)


@parrot.rule(when=rawio.picture.changed, writes=rawio.output)
async def look(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = f"{len(ctx.payload(rawio.picture.changed))} bytes"


@parrot.rule(when=rawio.reaction, writes=rawio.output)
async def feel(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = f"you reacted with {ctx.payload(rawio.reaction)}"


host = rs.Module("host", requires=(rawio, interloc))


@host.rule(when=interloc.users.added, writes=rawio.output)
async def greet(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = f"Hello {ctx.payload(interloc.users.added).item}!"


@host.rule(when=interloc.users.removed, writes=rawio.output)
async def part(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "Bye!"


@contextlib.asynccontextmanager
async def running(bot: Bot, folder: Path, *modules: Any, **settings: Any) -> AsyncGenerator[asyncio.Task[None]]:
    agent = Agent(
        *(modules or (parrot,)), telegramio,
        settings={"telegramio": {**bot.settings, "path": folder / "chats.sqlite", **settings}},
    )  # fmt: skip
    task = asyncio.create_task(telegramio.serve(agent))
    try:
        yield task
    finally:
        task.cancel()
        with contextlib.suppress(asyncio.CancelledError, PlatformError):
            await task


@pytest.fixture(autouse=True)
def _short_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ravestate.modules.platform.chats.attempts.FIRST_WAIT", 0.01)
    monkeypatch.setattr("ravestate.modules.platform.telegramio.bot.CONFLICT_WAIT", 0.01)


def live(test: Callable[[Bot, Path], Coroutine[Any, Any, None]]) -> Callable[[Bot, Path], None]:
    """Run an async test on an ordinary loop."""

    def run(bot: Bot, tmp_path: Path) -> None:
        async def within() -> None:
            async with asyncio.timeout(PATIENCE * 2):
                await test(bot, tmp_path)

        asyncio.run(within())

    return run


async def settled(bot: Bot) -> list[str]:
    """Send a last message, wait for its answer, and return the bot's other messages."""
    said = await bot.said(0)
    await bot.say(99, "the last")
    return [each for each in await bot.said(len(said) + 1) if each != "99: the last"]


@live
async def test_the_agent_answers_a_message(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path):
        await bot.say(7, "Hello")
        assert await bot.said(1) == ["7: Hello"]


@live
async def test_messages_of_a_chat_are_answered_in_order(bot: Bot, tmp_path: Path) -> None:
    for n in range(20):
        await bot.say(7, f"message {n}")
    async with running(bot, tmp_path):
        assert await bot.said(20) == [f"7: message {n}" for n in range(20)]


@live
async def test_a_new_user_is_greeted_by_name_and_only_once(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path, parrot, host, rest=0.2):
        await bot.say(7, "/start")
        assert await bot.said(1) == ["7: Hello User7!"]
        await bot.say(7, "one")
        assert (await bot.said(2))[1:] == ["7: one"]
    async with running(bot, tmp_path, parrot, host):
        await bot.say(7, "two")
        assert (await bot.said(3))[2:] == ["7: two"]


@live
async def test_the_commands_help_stop_and_forget_work(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path, parrot, host):
        await bot.say(7, "/help")
        said = await bot.said(2)
        assert said[0] == "7: Hello User7!"
        assert all(command in said[1] for command in ("/stop", "/forget"))
        await bot.say(7, "/stop")
        assert (await bot.said(3))[2:] == ["7: Bye!"]
        await bot.say(7, "I am back")
        assert (await bot.said(5))[3:] == ["7: Hello User7!", "7: I am back"]
        await bot.say(7, "/forget")
        assert (await bot.said(6))[5:] == ["7: I have forgotten you, and everything that you told me."]
        await bot.say(7, "Who am I?")
        assert (await bot.said(8))[6:] == ["7: Hello User7!", "7: Who am I?"]


@live
async def test_an_agent_without_a_greeting_answers_start_with_an_explanation(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path):
        await bot.say(7, "/start")
        assert (await bot.said(1))[0].startswith("7: I am Ravestate.")


@live
async def test_editing_the_last_message_changes_its_answer(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path):
        message = await bot.say(7, "I like tee")
        assert await bot.said(1) == ["7: I like tee"]
        await bot.do("edit", chat=7, id=message["message_id"], text="I like tea")
        await bot.do("called", method="editMessageText", count=1)
        assert await settled(bot) == ["7: I like tea"]
        await bot.say(7, "And coffee")
        await bot.said(3)
        await bot.do("edit", chat=7, id=message["message_id"], text="I like tea!")  # no longer the last message
        assert await settled(bot) == ["7: I like tea", "7: And coffee"]


@live
async def test_editing_the_last_message_changes_or_deletes_each_part_of_its_answer(bot: Bot, tmp_path: Path) -> None:
    wordy = rs.Module("wordy", requires=(rawio,))

    @wordy.rule(when=rawio.input.changed, writes=rawio.output)
    async def tell(ctx: rs.RuleContext) -> None:
        for word in ctx.payload(rawio.input.changed).split():
            ctx[rawio.output] = word

    async with running(bot, tmp_path, wordy):
        message = await bot.say(7, "one two three")
        await bot.said(3)
        await bot.do("fault", method="deleteMessage", kind="lost")  # the second attempt finds no message
        await bot.do("edit", chat=7, id=message["message_id"], text="four five")
        await bot.do("called", method="deleteMessage", count=2)
        assert await bot.said(2) == ["7: four", "7: five"]
        await bot.do("edit", chat=7, id=message["message_id"], text="six seven eight")
        assert await bot.said(3) == ["7: six", "7: seven", "7: eight"]


@live
async def test_in_a_group_the_agent_answers_only_messages_that_address_it(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path):
        await bot.say(-5, "Hello all", user=7)
        first = await bot.say(-5, "Hello @robin_bot", user=7)
        await bot.said(1)
        await bot.say(-5, "I think, Robin, you are right", user=8)
        said = await bot.do("said", count=2)
        await bot.say(-5, "Yes", user=8, reply_to_message={**said[0], "from": {**said[0]["from"]}})
        await bot.say(-5, "The robins sing", user=9)
        await bot.say(-5, "/help@other_bot", user=9)
        assert await bot.said(3) == ["-5: Hello", "-5: I think, Robin, you are right", "-5: Yes"]
        assert await settled(bot) == ["-5: Hello", "-5: I think, Robin, you are right", "-5: Yes"]
        assert said[0]["reply_to_message"]["message_id"] == first["message_id"]


@live
async def test_in_a_group_the_agent_answers_to_its_own_name_from_the_start(bot: Bot, tmp_path: Path) -> None:
    namer = rs.Module("namer", requires=(rawio, interloc))

    @namer.rule(when=rs.startup, writes=interloc.agent)
    async def give_name(ctx: rs.RuleContext) -> None:
        ctx[interloc.agent] = "Rosie"

    async with running(bot, tmp_path, parrot, namer):
        await bot.say(-5, "Hello Rosie", user=7)
        assert await settled(bot) == ["-5: Hello Rosie"]


@live
async def test_an_answer_of_only_an_emoji_becomes_a_reaction(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path):
        message = await bot.say(7, "❤️")
        await bot.do("called", method="setMessageReaction", count=1)
        await settled(bot)
        assert (await bot.do("message", chat=7, id=message["message_id"]))["reaction"] == ["❤"]
        await bot.say(7, "🦭")  # Telegram does not allow this emoji as a reaction
        assert "7: 🦭" in await bot.said(2)


@live
async def test_a_reaction_of_the_user_reaches_the_agent(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path):
        await bot.say(7, "Hello")
        [said] = await bot.do("said", count=1)
        await bot.do("react", chat=7, id=said["message_id"], emoji="👍")
        assert (await bot.said(2))[1:] == ["7: you reacted with 👍"]


@live
async def test_a_reaction_to_the_message_of_another_person_does_not_reach_the_agent(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path, parrot, host):
        await bot.say(-5, "Hello Robin", user=7)
        assert await bot.said(2) == ["-5: Hello User7!", "-5: Hello Robin"]
        message = await bot.say(-5, "Hello all", user=7)
        await bot.do("react", chat=-5, id=message["message_id"], emoji="👎", user=8)
        own = (await bot.do("said", count=2))[1]
        await bot.do("react", chat=-5, id=own["message_id"], emoji="👍", user=7)
        assert (await bot.said(3))[2:] == ["-5: you reacted with 👍"]
        await bot.say(-5, "Is that all, Robin?", user=7)
        assert (await bot.said(4))[3:] == ["-5: Is that all, Robin?"]


@live
async def test_a_picture_of_20_MB_and_its_caption_reach_the_agent(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path):
        size = 20 * 1024 * 1024
        file = await bot.do("upload", size=size)
        await bot.say(7, caption="My cat", photo=[{**file, "width": 9, "height": 9}])
        assert sorted(await bot.said(2)) == sorted([f"7: {size} bytes", "7: My cat"])
        await bot.say(7, photo=[{**await bot.do("upload", size=size + 1), "width": 9, "height": 9}])
        assert (await bot.said(3))[2:] == ["7: I couldn't open that."]


@live
async def test_a_file_is_fetched_again_after_a_failure(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path):
        await bot.do("fault", method="getFile", kind="500", times=2)
        file = await bot.do("upload", size=1000)
        await bot.say(7, photo=[{**file, "width": 9, "height": 9}])
        assert await bot.said(1) == ["7: 1000 bytes"]


@live
async def test_the_chat_shows_that_the_agent_is_writing(bot: Bot, tmp_path: Path) -> None:
    slow = rs.Module("slow", requires=(rawio,))
    done = asyncio.Event()

    @slow.rule(when=rawio.input.changed, writes=rawio.output)
    async def think(ctx: rs.RuleContext) -> None:
        await done.wait()
        ctx[rawio.output] = "Yes."

    async with running(bot, tmp_path, slow):
        await bot.say(7, "Hello")
        assert (await bot.do("called", method="sendChatAction", count=1))["calls"]
        done.set()
        assert await bot.said(1) == ["7: Yes."]


@live
async def test_in_a_private_chat_a_growing_answer_is_a_draft_and_then_a_message(bot: Bot, tmp_path: Path) -> None:
    go = asyncio.Event()
    writer = rs.Module("writer", requires=(rawio,))

    @writer.rule(when=rawio.input.changed, writes=rawio.output, emits=rawio.piece)
    async def write(ctx: rs.RuleContext) -> None:
        ctx.emit(rawio.piece, "I think ")
        await go.wait()
        ctx[rawio.output] = "I think so."

    async def drafts(count: int) -> list[tuple[str, str]]:
        found = (await bot.do("called", method="sendMessageDraft", count=count))["calls"]
        return [(call["chat"], call["text"]) for call in found]

    async with running(bot, tmp_path, writer):
        await bot.say(7, "Is it?")
        assert await drafts(1) == [("7", "I think")]
        go.set()
        assert await bot.said(1) == ["7: I think so."]
        go.clear()
        await bot.say(-5, "Robin, is it?", user=7)  # a group has no drafts
        await bot.do("called", method="sendChatAction", count=1)
        go.set()
        assert (await bot.said(2))[1:] == ["-5: I think so."]
        go.clear()
        await bot.do("fault", method="sendMessageDraft", kind="lost")  # the failure of a draft has no other effect
        await bot.say(8, "Is it?")
        await drafts(2)
        go.set()
        assert (await bot.said(3))[2:] == ["8: I think so."]
        go.clear()
        await bot.do("fault", method="sendMessageDraft", kind="404")  # as an older server answers
        await bot.say(9, "Is it?")
        await bot.do("called", method="sendChatAction", count=2)
        go.set()
        assert (await bot.said(4))[3:] == ["9: I think so."]
        assert len(await drafts(0)) == 3


@live
async def test_a_long_answer_is_sent_in_several_messages(bot: Bot, tmp_path: Path) -> None:
    tale = " ".join(f"Sentence {n} ends." for n in range(400))
    wordy = rs.Module("wordy", requires=(rawio,))

    @wordy.rule(when=rawio.input.changed, writes=rawio.output)
    async def tell(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = tale

    async with running(bot, tmp_path, wordy):
        await bot.say(7, "Tell me a tale")
        said = await bot.said(2)
        assert " ".join(each.removeprefix("7: ") for each in said) == tale


@live
async def test_the_words_that_do_not_fit_below_a_picture_follow_in_messages(bot: Bot, tmp_path: Path) -> None:
    tale = " ".join(f"Sentence {n} ends." for n in range(400))
    painter = rs.Module("painter", requires=(rawio,))

    @painter.rule(when=rawio.input.changed, reads=telegramio.chat)
    async def paint(ctx: rs.RuleContext) -> None:
        ctx[telegramio.chat].send_picture(b"\x89PNG", tale, origin=ctx.origin)

    async with running(bot, tmp_path, painter):
        wish = await bot.say(-5, "Paint, Robin!", user=7)
        said = await bot.said(3)
        assert " ".join(each.removeprefix("-5: ") for each in said) == tale
        [picture, *words] = await bot.do("said", count=3)
        assert len(picture["caption"]) > 1000
        assert picture["reply_to_message"]["message_id"] == wish["message_id"]
        assert not any("reply_to_message" in each for each in words)


@live
async def test_all_parts_of_an_answer_go_to_the_topic_of_their_message(bot: Bot, tmp_path: Path) -> None:
    painter = rs.Module("painter", requires=(rawio,))

    @painter.rule(when=rawio.input.changed, reads=telegramio.chat, writes=rawio.output)
    async def paint(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "words " * 1000
        ctx[telegramio.chat].send_picture(b"\x89PNG", "a house", origin=ctx.origin)

    async with running(bot, tmp_path, painter):
        await bot.say(-(10**12) - 5, "Paint, Robin!", user=7, message_thread_id=3, is_topic_message=True)
        assert [each.get("message_thread_id") for each in await bot.do("said", count=3)] == [3, 3, 3]
        await bot.say(-(10**12) - 5, "Paint, Robin!", user=7, message_thread_id=4)  # a thread of replies is no topic
        assert [each.get("message_thread_id") for each in (await bot.do("said", count=6))[3:]] == [None] * 3


@live
async def test_the_agent_answers_only_people_in_the_setting_allow(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path, allow=(7, "@User8", 99)):
        for chat in (9, 8, 7):
            await bot.say(chat, "Hello")
        assert sorted(await settled(bot)) == ["7: Hello", "8: Hello"]


@live
async def test_a_voice_note_is_understood_and_answered_by_voice(bot: Bot, tmp_path: Path) -> None:
    note = await spoken("Hello, how are you today?")
    assert note is not None
    async with running(bot, tmp_path):
        file = await bot.do("upload", hexed=note.hex())
        await bot.say(7, voice={**file, "duration": 2})
        [answer] = await bot.do("said", count=1)
        why = "Bad Request: VOICE_MESSAGES_FORBIDDEN"
        await bot.do("fault", method="sendVoice", kind="400", why=why)
        await bot.say(7, voice={**file, "duration": 2})
        [_, text] = await bot.do("said", count=2)
    assert "how are you" in answer["caption"].lower()
    assert answer["voice"]["file_size"] > 1000
    assert "how are you" in text["text"].lower()


@live
async def test_the_agent_gets_messages_by_webhook_or_by_polling(bot: Bot, tmp_path: Path) -> None:
    port = free_port()
    address = {"webhook": f"http://127.0.0.1:{port}/telegram", "port": port}
    async with running(bot, tmp_path, **address):
        await bot.say(7, "one")
        assert await bot.said(1) == ["7: one"]
    await bot.say(7, "two")  # while the agent is down
    async with running(bot, tmp_path, **address):
        assert await bot.said(2) == ["7: one", "7: two"]
    async with running(bot, tmp_path):
        await bot.say(7, "three")
        assert await bot.said(3) == ["7: one", "7: two", "7: three"]


# ------------------------------------------------------------------------------------ faults


@live
async def test_the_agent_respects_a_flood_wait_and_loses_no_message(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path):
        await bot.do("fault", method="sendMessage", kind="429", retry_after=1, chat="7")
        for n in range(5):
            await bot.say(7, f"message {n}")
        await bot.say(8, "another chat")
        said = await bot.said(6)
        assert [each for each in said if each.startswith("7")] == [f"7: message {n}" for n in range(5)]
        assert said[0] == "8: another chat"  # chat 8 does not wait for chat 7
        assert (await bot.do("called", method="sendMessage"))["early"] == 0


@pytest.mark.parametrize("kind", ["500", "502", "503", "garbage", "lost"])
def test_after_failed_calls_no_message_is_lost_or_answered_twice(bot: Bot, tmp_path: Path, kind: str) -> None:
    @live
    async def test(bot: Bot, folder: Path) -> None:
        async with running(bot, folder):
            for method in ("sendMessage", "getUpdates"):
                await bot.do("fault", method=method, kind=kind, times=2)
            for chat in (7, 8):
                for n in range(3):
                    await bot.say(chat, f"message {n}")
            said = await bot.said(6)
            assert said == await settled(bot)
            assert sorted(said) == sorted(f"{chat}: message {n}" for chat in (7, 8) for n in range(3))

    test(bot, tmp_path)


@live
async def test_after_a_lost_response_an_answer_is_not_sent_twice_despite_many_other_messages(
    bot: Bot, tmp_path: Path
) -> None:
    slow = rs.Module("slow", requires=(rawio,))
    go = asyncio.Event()

    @slow.rule(when=rawio.input.changed, writes=rawio.output)
    async def think(ctx: rs.RuleContext) -> None:
        await go.wait()
        ctx[rawio.output] = ctx.payload(rawio.input.changed)

    async with running(bot, tmp_path, slow):
        await bot.say(7, "Hello")
        await bot.do("called", method="sendChatAction", count=1)
        await bot.do("fault", method="getUpdates", kind="500", times=10**6)
        polls = (await bot.do("called", method="getUpdates"))["calls"]
        await bot.say(8, "Hello")  # this ends the open request for updates
        await bot.do("called", method="getUpdates", count=len(polls) + 1)
        await bot.do("crowd", messages=[{"chat": chat, "text": "Hello"} for chat in range(100, 200)])
        await bot.do("fault", method="sendMessage", kind="lost", times=2)
        go.set()
        await bot.said(2)
        await bot.do("heal")
        await bot.said(102)
        assert sorted(await settled(bot)) == sorted(f"{chat}: Hello" for chat in (7, 8, *range(100, 200)))


@pytest.mark.parametrize("method", ["sendMessage", "getUpdates", "getFile"])
def test_a_call_without_a_timely_response_is_repeated(
    bot: Bot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, method: str
) -> None:
    monkeypatch.setattr("ravestate.modules.platform.telegramio.bot.ANSWER", 0.5)
    monkeypatch.setattr("ravestate.modules.platform.telegramio.bot.PATIENCE", 0.5)

    @live
    async def test(bot: Bot, folder: Path) -> None:
        await bot.do("fault", method=method, kind="hang")
        async with running(bot, folder):
            await bot.say(7, "Hello")
            await bot.say(7, photo=[{**await bot.do("upload", size=1000), "width": 9, "height": 9}])
            await bot.said(2)
            assert await settled(bot) == ["7: Hello", "7: 1000 bytes"]
            assert len((await bot.do("called", method=method))["calls"]) > 1

    test(bot, tmp_path)


def test_updates_that_cannot_be_stored_are_requested_again(
    bot: Bot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    failures = fill_disk(monkeypatch)

    @live
    async def test(bot: Bot, folder: Path) -> None:
        async with running(bot, folder):
            await bot.say(7, "Hello")
            assert await bot.said(1) == ["7: Hello"]

    test(bot, tmp_path)
    assert not failures


@live
async def test_malformed_updates_are_ignored(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path):
        await bot.do("update", data={"message": {"message_id": "x"}})
        await bot.do("update", data={"message": 7})
        await bot.do("update", data={"edited_message": {}})
        await bot.do("update", data={"never_heard_of": {}})
        await bot.say(7, "Hello")
        await bot.say(7, None, dice={"emoji": "🎲", "value": 3})
        assert await settled(bot) == ["7: Hello"]


@live
async def test_the_agent_continues_after_a_group_removes_it_or_a_user_blocks_it(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path):
        await bot.say(-5, "Robin, hello", user=7)
        await bot.said(1)
        await bot.do("state", chat=-5, state="left")
        await bot.do("fault", method="getUpdates", kind="500")
        await bot.say(8, "one")
        await bot.do("state", chat=8, state="blocked")
        assert [each for each in await settled(bot) if each != "8: one"] == ["-5: Robin, hello"]
        await bot.say(8, "I am back")
        assert "8: I am back" in await settled(bot)


@live
async def test_a_group_that_gets_another_id_still_gets_its_answer(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path):
        new = -(10**12) - 5
        await bot.say(new, "Robin, hello", user=7)
        await bot.said(1)
        await bot.do("fault", method="sendMessage", kind="500", chat="-5")
        await bot.say(-5, "Robin, are you there?", user=7)
        await bot.do("state", chat=-5, state=f"moved {new}")
        assert (await bot.said(2))[1:] == [f"{new}: Robin, are you there?"]


@live
async def test_updates_that_are_delivered_twice_are_answered_only_once(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path):
        message = await bot.say(7, "Hello")
        await bot.said(1)
    async with running(bot, tmp_path):
        data = {"update_id": 1001, "message": message}
        await bot.do("update", data=data)
        await bot.do("update", data=data)
        assert await settled(bot) == ["7: Hello"]


@live
async def test_setting_the_webhook_is_repeated_after_failures(bot: Bot, tmp_path: Path) -> None:
    await bot.do("fault", method="setWebhook", kind="502", times=2)
    await bot.do("fault", method="setWebhook", kind="429", retry_after=0.01)
    port = free_port()
    async with running(bot, tmp_path, webhook=f"http://127.0.0.1:{port}/telegram", port=port):
        await bot.say(7, "one")
        assert await bot.said(1) == ["7: one"]


@live
async def test_a_webhook_that_telegram_refuses_ends_the_agent_with_advice(bot: Bot, tmp_path: Path) -> None:
    why = "Bad Request: bad webhook: an HTTPS URL must be provided for webhook"
    await bot.do("fault", method="setWebhook", kind="400", why=why)
    port = free_port()
    async with running(bot, tmp_path, webhook=f"http://127.0.0.1:{port}/telegram", port=port) as task:
        with pytest.raises(PlatformError, match=r"refuses the webhook.*https url must.*telegramio\.webhook"):
            await task


# ------------------------------------------------------------------------------------ the token, and other agents


@live
async def test_a_wrong_token_ends_the_agent_with_a_message_that_does_not_show_it(bot: Bot, tmp_path: Path) -> None:
    bot.token = f"{bot.token}-wrong"
    async with running(bot, tmp_path) as task:
        with pytest.raises(PlatformError, match=r"refuses the token.*BotFather") as caught:
            await task
    assert bot.token not in str(caught.value)


def test_a_missing_token_ends_the_agent_with_advice() -> None:
    with pytest.raises(PlatformError, match="export RAVESTATE_TELEGRAMIO_TOKEN"):
        asyncio.run(telegramio.serve(Agent(parrot, telegramio)))


@live
async def test_the_agent_ends_with_an_error_if_another_program_gets_its_messages(bot: Bot, tmp_path: Path) -> None:
    await bot.do("fault", method="getUpdates", kind="409", times=100)
    async with running(bot, tmp_path) as task:
        with pytest.raises(PlatformError, match="another program gets the messages"):
            await task


def test_if_two_agents_use_one_bot_the_newer_agent_ends(
    bot: Bot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    @live
    async def test(bot: Bot, folder: Path) -> None:
        monkeypatch.setattr("ravestate.modules.platform.telegramio.bot.SETTLED", 0.0)
        async with running(bot, folder):
            await bot.say(7, "one")
            await bot.said(1)
            monkeypatch.setattr("ravestate.modules.platform.telegramio.bot.SETTLED", 60.0)
            async with running(bot, folder, path=folder / "other.sqlite") as newcomer:
                with pytest.raises(PlatformError, match="another program gets the messages"):
                    await newcomer
            await bot.say(7, "two")
            assert await bot.said(2) == ["7: one", "7: two"]

    test(bot, tmp_path)


@live
async def test_a_second_agent_with_the_same_file_is_refused(bot: Bot, tmp_path: Path) -> None:
    async with running(bot, tmp_path):
        await bot.say(7, "Hello")
        await bot.said(1)
        async with running(bot, tmp_path) as second:
            with pytest.raises(PlatformError, match="another agent uses it"):
                await second


def test_the_token_is_never_logged(bot: Bot, tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.DEBUG)

    @live
    async def test(bot: Bot, folder: Path) -> None:
        async with running(bot, folder):
            await bot.do("fault", method="sendMessage", kind="lost")
            await bot.do("fault", method="getUpdates", kind="garbage")
            await bot.say(7, "Hello")
            await bot.said(1)

    test(bot, tmp_path)
    # Skip the requests of the test itself.
    theirs = [r for r in caplog.records if f"/control/{bot.token}" not in r.getMessage()]
    logged = "\n".join(f"{r.getMessage()} {r.exc_text}" for r in theirs)
    assert "[secret]" in logged
    assert bot.token not in logged
    assert bot.token.partition(":")[2] not in logged
    assert bot.token not in repr(Agent(parrot, telegramio, settings={"telegramio": bot.settings}).settings)
