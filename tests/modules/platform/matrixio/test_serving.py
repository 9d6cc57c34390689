"""An agent on Matrix, against a real homeserver (Synapse) in a process of its own."""

import asyncio
import contextlib
import logging
from collections.abc import AsyncGenerator
from pathlib import Path
from typing import Any

import pytest

from modules.platform.matrixio.conftest import Account, Homeserver, accounts
from modules.platform.telegramio.test_serving import host, parrot
from ravestate.errors import PlatformError
from ravestate.modules import matrixio
from ravestate.runtime.agent import Agent


@contextlib.asynccontextmanager
async def running(robin: Account, folder: Path, *modules: Any, **settings: Any) -> AsyncGenerator[asyncio.Task[None]]:
    values = {"homeserver": robin.server.url, "user": robin.id, "password": "password", "path": folder / "chats.sqlite"}
    agent = Agent(*(modules or (parrot,)), matrixio, settings={"matrixio": {**values, **settings}})
    task = asyncio.create_task(matrixio.serve(agent))
    try:
        yield task
    finally:
        task.cancel()
        with contextlib.suppress(asyncio.CancelledError, PlatformError):
            await task


def live(*names: str) -> Any:
    """Run an async test with a folder, and with accounts of these names, on an ordinary loop."""

    def decorate(test: Any) -> Any:
        def run(homeserver: Homeserver, tmp_path: Path) -> None:
            async def within() -> None:
                async with asyncio.timeout(120), accounts(homeserver, *names) as people:
                    await test(tmp_path, *people)

            asyncio.run(within())

        return run

    return decorate


@live("Robin", "Ada")
async def test_an_invited_agent_answers_also_what_came_before_it_joined(
    tmp_path: Path, robin: Account, ada: Account
) -> None:
    room = await ada.room(robin.id)
    await ada.say(room, "Hello")
    async with running(robin, tmp_path, parrot, host):
        assert await ada.listen(2) == [f"{room}: Hello Ada!", f"{room}: Hello"]
        await ada.say(room, "!help")
        assert "/forget" in (await ada.listen(3))[2]


@live("Robin", "Ada")
async def test_twenty_rooms_over_restarts_and_none_crossed(tmp_path: Path, robin: Account, ada: Account) -> None:
    rooms = await asyncio.gather(*(ada.room(robin.id) for _ in range(20)))

    async def say(words: str) -> None:
        await asyncio.gather(*(ada.say(room, f"{words} in {room}") for room in rooms))

    await say("one")
    async with running(robin, tmp_path):
        await ada.listen(5)
    await say("two")
    async with running(robin, tmp_path):
        said = await ada.listen(40)
        await ada.say(rooms[0], "the last")
        assert len(await ada.listen(41)) == 41
    assert sorted(said) == sorted(f"{room}: {words} in {room}" for room in rooms for words in ("one", "two"))


@pytest.fixture
def _short_pages(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ravestate.modules.platform.matrixio.account.PAGE", 4)
    monkeypatch.setattr("ravestate.modules.platform.matrixio.account.FILTER", {"room": {"timeline": {"limit": 4}}})


@pytest.mark.usefixtures("_short_pages")
@live("Robin", "Ada")
async def test_more_messages_than_fit_into_an_answer_are_all_heard(
    tmp_path: Path, robin: Account, ada: Account
) -> None:
    room = await ada.room(robin.id)
    async with running(robin, tmp_path):
        await ada.say(room, "first")
        await ada.listen(1)
    for n in range(14):
        await ada.say(room, f"message {n}")
    async with running(robin, tmp_path):
        assert (await ada.listen(15))[1:] == [f"{room}: message {n}" for n in range(14)]


@live("Robin", "Ada")
async def test_pictures_reactions_and_edits_pass_both_ways(tmp_path: Path, robin: Account, ada: Account) -> None:
    room = await ada.room(robin.id)
    async with running(robin, tmp_path):
        message = await ada.say(room, "I like tee")
        assert await ada.listen(1) == [f"{room}: I like tee"]
        change = {"m.new_content": {"msgtype": "m.text", "body": "I like tea"},
                  "m.relates_to": {"rel_type": "m.replace", "event_id": message}}  # fmt: skip
        await ada.say(room, "* I like tea", **change)
        heart = await ada.say(room, "❤️")
        url = await ada.upload(b"\x89PNG" + bytes(1000))
        await ada.send(room, "m.room.message", {"msgtype": "m.image", "body": "cat.png", "url": url})
        assert await ada.listen(2) == [f"{room}: I like tea", f"{room}: 1004 bytes"]
        [reaction] = [event["content"] for event in ada.heard if event["type"] == "m.reaction"]
        assert reaction["m.relates_to"] == {"rel_type": "m.annotation", "event_id": heart, "key": "❤️"}
        answer = next(event for event in ada.heard if event["type"] == "m.room.message")
        relation = {"rel_type": "m.annotation", "event_id": answer["event_id"], "key": "👍"}
        await ada.send(room, "m.reaction", {"m.relates_to": relation})
        assert (await ada.listen(3))[2:] == [f"{room}: you reacted with 👍"]


@live("Robin", "Ada", "Bob")
async def test_a_group_is_answered_when_it_speaks_to_the_agent(
    tmp_path: Path, robin: Account, ada: Account, bob: Account
) -> None:
    room = await ada.room(robin.id, bob.id)
    await bob.call("POST", f"client/v3/join/{room}")
    async with running(robin, tmp_path):
        await ada.say(room, "Hello all")
        mention = await bob.say(room, "What do you think?", **{"m.mentions": {"user_ids": [robin.id]}})
        said = await ada.listen(1)
        assert [each for each in said if not each.endswith("Hello all")] == [f"{room}: What do you think?"]
        await ada.say(room, "I agree, Robin")
        await ada.listen(3)
        own = [e for e in ada.heard if e["sender"] == robin.id and e["type"] == "m.room.message"]
        assert [e["content"]["body"] for e in own] == ["What do you think?", "I agree, Robin"]
        assert own[0]["content"]["m.relates_to"]["m.in_reply_to"]["event_id"] == mention


@live("Robin", "Ada", "Bob")
async def test_only_those_who_are_allowed_get_an_answer(
    tmp_path: Path, robin: Account, ada: Account, bob: Account
) -> None:
    async with running(robin, tmp_path, allow=(ada.id,)):
        theirs, ours = await bob.room(robin.id), await ada.room(robin.id)
        await bob.say(theirs, "Hello")
        await ada.say(ours, "Hello")
        assert await ada.listen(1) == [f"{ours}: Hello"]
        members = await bob.call("GET", f"client/v3/rooms/{theirs}/joined_members")
        assert list(members["joined"]) == [bob.id]


@live("Robin", "Ada")
async def test_a_room_that_the_agent_had_to_leave_stops_nothing_else(
    tmp_path: Path, robin: Account, ada: Account
) -> None:
    async with running(robin, tmp_path):
        first, second = [await ada.room(robin.id, preset="private_chat") for _ in range(2)]
        await ada.say(first, "one")
        await ada.listen(1)
        await ada.call("POST", f"client/v3/rooms/{first}/kick", {"user_id": robin.id})
        await ada.say(second, "two")
        assert await ada.listen(2) == [f"{first}: one", f"{second}: two"]


@live("Robin")
async def test_a_wrong_password_is_explained(tmp_path: Path, robin: Account) -> None:
    for wrong in ({"password": "something else"}, {"password": None, "token": "syt_wrong_token"}):
        async with running(robin, tmp_path, **wrong) as task:
            with pytest.raises(PlatformError, match=r"refuses the account: check matrixio\.user"):
                await task


def test_a_missing_account_is_explained() -> None:
    with pytest.raises(PlatformError, match="export RAVESTATE_MATRIXIO_PASSWORD"):
        asyncio.run(matrixio.serve(Agent(parrot, matrixio)))


def test_the_password_is_never_logged(homeserver: Homeserver, tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.DEBUG)

    @live("Robin", "Ada")
    async def test(folder: Path, robin: Account, ada: Account) -> None:
        async with running(robin, folder, password=None, token=robin.token):
            room = await ada.room(robin.id)
            await ada.say(room, "Hello")
            await ada.listen(1)
            assert robin.token not in "\n".join(f"{r.getMessage()} {r.exc_text}" for r in caplog.records)

    test(homeserver, tmp_path)


# ------------------------------------------------------------------------------------ the death of the server


def test_the_server_is_killed_and_nothing_is_lost_or_doubled(
    homeserver: Homeserver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("ravestate.modules.platform.chats.sender.LONGEST_WAIT", 0.5)

    async def test() -> None:
        async with asyncio.timeout(120), accounts(homeserver, "Robin", "Ada") as (robin, ada):
            rooms = [await ada.room(robin.id) for _ in range(5)]
            async with running(robin, tmp_path):
                await asyncio.gather(*(ada.say(room, f"0 in {room}") for room in rooms))
                await ada.listen(1)
                homeserver.kill()
                homeserver.start()
                await asyncio.gather(*(ada.say(room, f"1 in {room}") for room in rooms))
                said = await ada.listen(10)
                await ada.say(rooms[0], "the last")
                assert len(await ada.listen(11)) == 11
            assert sorted(said) == sorted(f"{room}: {n} in {room}" for n in range(2) for room in rooms)

    asyncio.run(test())
