"""An agent on Matrix, with a real homeserver (Synapse) in a separate process."""

import asyncio
import contextlib
import logging
from collections.abc import AsyncGenerator
from pathlib import Path
from typing import Any

import pytest

import ravestate as rs
from modules.platform.chats.faults import fill_disk
from modules.platform.matrixio.conftest import Account, Homeserver, accounts
from modules.platform.matrixio.proxy import Proxy
from modules.platform.telegramio.test_serving import host, parrot
from ravestate.errors import PlatformError
from ravestate.modules import matrixio, rawio
from ravestate.modules.platform.matrixio.account import JOINS
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
    """Run an async test on an ordinary loop. It gets a folder, and an account for each of these names."""

    def decorate(test: Any) -> Any:
        def run(homeserver: Homeserver, tmp_path: Path) -> None:
            async def within() -> None:
                async with asyncio.timeout(120), accounts(homeserver, *names) as people:
                    await test(tmp_path, *people)

            asyncio.run(within())

        return run

    return decorate


@live("Robin", "Ada")
async def test_an_invited_agent_also_answers_messages_that_are_older_than_its_joining(
    tmp_path: Path, robin: Account, ada: Account
) -> None:
    room = await ada.room(robin.id)
    await ada.say(room, "Hello")
    async with running(robin, tmp_path, parrot, host):
        assert await ada.listen(2) == [f"{room}: Hello Ada!", f"{room}: Hello"]
        await ada.say(room, "!help")
        assert "/forget" in (await ada.listen(3))[2]


@pytest.fixture
def _short_pages(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ravestate.modules.platform.matrixio.account.PAGE", 4)
    monkeypatch.setattr("ravestate.modules.platform.matrixio.account.FILTER", {"room": {"timeline": {"limit": 4}}})


@pytest.fixture
def _short_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("FIRST_WAIT", "LONGEST_WAIT"):
        monkeypatch.setattr(f"ravestate.modules.platform.chats.attempts.{name}", 0.01)


@pytest.mark.usefixtures("_short_pages")
@live("Robin", "Ada")
async def test_all_messages_are_heard_even_if_they_do_not_fit_into_one_sync_response(
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


@pytest.mark.usefixtures("_short_pages", "_short_waits")
@pytest.mark.parametrize("kind", ["429", "502", "lost"])
def test_the_agent_requests_older_messages_again_after_a_failure(
    homeserver: Homeserver, tmp_path: Path, kind: str
) -> None:
    @live("Robin", "Ada")
    async def test(folder: Path, robin: Account, ada: Account) -> None:
        room = await ada.room(robin.id)
        async with running(robin, folder):
            await ada.say(room, "first")
            await ada.listen(1)
        for n in range(9):
            await ada.say(room, f"message {n}")
        async with Proxy(homeserver.url) as proxy:
            failed = proxy.fail("messages", kind, times=2)
            async with running(robin, folder, homeserver=proxy.url):
                await failed.met.wait()
                assert (await ada.listen(10))[1:] == [f"{room}: message {n}" for n in range(9)]

    test(homeserver, tmp_path)


@pytest.mark.usefixtures("_short_waits")
@pytest.mark.parametrize("kind", ["429", "refuse"])
def test_a_room_that_the_agent_cannot_join_yet_does_not_delay_other_rooms(
    homeserver: Homeserver, tmp_path: Path, kind: str
) -> None:
    @live("Robin", "Ada")
    async def test(folder: Path, robin: Account, ada: Account) -> None:
        async with Proxy(homeserver.url) as proxy, running(robin, folder, homeserver=proxy.url):
            first = await ada.room(robin.id)
            await ada.say(first, "one")
            await ada.listen(1)
            failed = proxy.fail("join", kind, times=10**6)
            second = await ada.room(robin.id)
            await ada.say(second, "two")
            await ada.say(first, "three")
            assert await ada.listen(2) == [f"{first}: one", f"{first}: three"]
            failed.times = JOINS + 3  # the agent never stops trying
            await failed.met.wait()
            assert (await ada.listen(3))[2:] == [f"{second}: two"]

    test(homeserver, tmp_path)


@live("Robin", "Ada")
async def test_the_agent_handles_edits_reactions_and_pictures(tmp_path: Path, robin: Account, ada: Account) -> None:
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
async def test_a_reaction_to_the_message_of_another_person_does_not_reach_the_agent(
    tmp_path: Path, robin: Account, ada: Account, bob: Account
) -> None:
    room = await ada.room(robin.id, bob.id)
    await bob.call("POST", f"client/v3/join/{room}")
    async with running(robin, tmp_path, parrot, host):
        await ada.say(room, "Hello, Robin")
        assert await ada.listen(2) == [f"{room}: Hello Ada!", f"{room}: Hello, Robin"]
        message = await ada.say(room, "Hello all")
        relation = {"rel_type": "m.annotation", "event_id": message, "key": "👎"}
        await bob.send(room, "m.reaction", {"m.relates_to": relation})
        own = [event["event_id"] for event in ada.heard if event["type"] == "m.room.message"]
        await ada.send(room, "m.reaction", {"m.relates_to": {**relation, "event_id": own[1], "key": "👍"}})
        assert (await ada.listen(3))[2:] == [f"{room}: you reacted with 👍"]
        await ada.say(room, "Is that all, Robin?")
        assert (await ada.listen(4))[3:] == [f"{room}: Is that all, Robin?"]


@live("Robin", "Ada", "Bob")
async def test_in_a_group_the_agent_answers_only_messages_that_address_it(
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
async def test_the_agent_answers_only_people_in_the_setting_allow(
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
async def test_an_agent_that_is_kicked_from_one_room_continues_in_the_others(
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
async def test_a_wrong_password_or_token_ends_the_agent_with_advice(tmp_path: Path, robin: Account) -> None:
    for wrong in ({"password": "something else"}, {"password": None, "token": "syt_wrong_token"}):
        async with running(robin, tmp_path, **wrong) as task:
            with pytest.raises(PlatformError, match=r"refuses the account: check matrixio\.user"):
                await task


def test_a_missing_password_ends_the_agent_with_advice() -> None:
    with pytest.raises(PlatformError, match="export RAVESTATE_MATRIXIO_PASSWORD"):
        asyncio.run(matrixio.serve(Agent(parrot, matrixio)))


def test_the_access_token_is_never_logged(
    homeserver: Homeserver, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.DEBUG)

    @live("Robin", "Ada")
    async def test(folder: Path, robin: Account, ada: Account) -> None:
        async with running(robin, folder, password=None, token=robin.token):
            room = await ada.room(robin.id)
            await ada.say(room, "Hello")
            await ada.listen(1)
            assert robin.token not in "\n".join(f"{r.getMessage()} {r.exc_text}" for r in caplog.records)

    test(homeserver, tmp_path)


# ------------------------------------------------------------------------------------ faults


FAULTS = [
    [("PUT", kind) for kind in ("429", "502", "lost", "garbage", "hang")],
    [("sync", kind) for kind in ("429", "502", "lost", "garbage", "hang")],
    [("join", "502"), ("join", "lost"), ("download", "502"), ("download", "hang")],
]


@pytest.mark.parametrize("faults", FAULTS)
def test_after_failed_requests_no_message_is_lost_or_answered_twice(
    homeserver: Homeserver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, faults: list[tuple[str, str]]
) -> None:
    for place in ("chats.attempts.FIRST_WAIT", "chats.attempts.LONGEST_WAIT"):
        monkeypatch.setattr(f"ravestate.modules.platform.{place}", 0.01)
    for name, seconds in {"account.ANSWER": 1.0, "account.POLL": 100, "carrier.FILE": 1.0}.items():
        monkeypatch.setattr(f"ravestate.modules.platform.matrixio.{name}", seconds)

    @live("Robin", "Ada")
    async def test(folder: Path, robin: Account, ada: Account) -> None:
        async with Proxy(homeserver.url) as proxy:
            happened = [proxy.fail(request, kind) for request, kind in faults]
            async with running(robin, folder, homeserver=proxy.url):
                rooms = [await ada.room(robin.id) for _ in range(2)]
                url = await ada.upload(b"\x89PNG" + bytes(1000))
                for room in rooms:
                    await ada.say(room, "one")
                    await ada.send(room, "m.room.message", {"msgtype": "m.image", "body": "cat.png", "url": url})
                    await ada.say(room, "two")
                await ada.listen(6)
                await asyncio.gather(*(fault.met.wait() for fault in happened))
                await ada.say(rooms[0], "the last")
                said = await ada.listen(7)
        for room in rooms:
            mine = [each.removeprefix(f"{room}: ") for each in said if each.startswith(room)]
            assert mine == ["one", "1004 bytes", "two"] + ["the last"] * (room == rooms[0])

    test(homeserver, tmp_path)


@pytest.mark.usefixtures("_short_waits")
def test_events_that_cannot_be_stored_are_requested_again(
    homeserver: Homeserver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    failures = fill_disk(monkeypatch)

    @live("Robin", "Ada")
    async def test(folder: Path, robin: Account, ada: Account) -> None:
        async with running(robin, folder):
            room = await ada.room(robin.id)
            await ada.say(room, "Hello")
            assert await ada.listen(1) == [f"{room}: Hello"]

    test(homeserver, tmp_path)
    assert not failures


# Synapse itself refuses events that are more malformed than these.
MALFORMED: list[tuple[str, dict[str, Any]]] = [
    ("m.room.message", {"msgtype": "m.text", "body": "x", "m.relates_to": 7}),
    ("m.room.message", {"msgtype": "m.text", "body": "x", "m.relates_to": {"rel_type": "m.replace"}}),
    ("m.room.message", {"msgtype": "m.image", "body": "x"}),
    ("m.room.message", {"msgtype": "m.audio", "body": "x", "url": {"a": 1}}),
    ("m.reaction", {"m.relates_to": []}),
    ("org.example.unknown", {"body": "x"}),
]


@live("Robin", "Ada")
async def test_malformed_events_are_ignored(tmp_path: Path, robin: Account, ada: Account) -> None:
    room = await ada.room(robin.id)
    async with running(robin, tmp_path):
        for kind, content in MALFORMED:
            await ada.send(room, kind, content)
        await ada.say(room, "Hello")
        assert await ada.listen(1) == [f"{room}: Hello"]


@live("Robin", "Ada")
async def test_a_picture_is_sent_with_its_content_type(tmp_path: Path, robin: Account, ada: Account) -> None:
    painter = rs.Module("painter", requires=(rawio,))

    @painter.rule(when=rawio.input.changed, reads=matrixio.chat)
    async def paint(ctx: rs.RuleContext) -> None:
        ctx[matrixio.chat].send_picture(b"\xff\xd8 and so on", "a house")
        ctx[matrixio.chat].send_picture(b"\x89PNG and so on", "a tree")

    room = await ada.room(robin.id)
    async with running(robin, tmp_path, painter):
        await ada.say(room, "Paint!")
        await ada.listen(2)
    urls = [event["content"]["url"] for event in ada.heard if event["content"].get("msgtype") == "m.image"]
    assert [await ada.kind(url) for url in urls] == ["image/jpeg", "image/png"]


def test_the_agent_joins_a_room_after_a_failure_and_a_restart(
    homeserver: Homeserver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("ravestate.modules.platform.chats.attempts.FIRST_WAIT", 1000.0)
    monkeypatch.setattr("ravestate.modules.platform.chats.attempts.LONGEST_WAIT", 1000.0)

    @live("Robin", "Ada")
    async def test(folder: Path, robin: Account, ada: Account) -> None:
        async with Proxy(homeserver.url) as proxy:
            failed = proxy.fail("join", "502")
            room = await ada.room(robin.id)
            async with running(robin, folder, homeserver=proxy.url):
                await failed.met.wait()
            await ada.say(room, "Hello")
            async with running(robin, folder, homeserver=proxy.url):
                assert await ada.listen(1) == [f"{room}: Hello"]

    test(homeserver, tmp_path)


@live("Robin", "Ada")
async def test_a_picture_of_20_MB_reaches_the_agent(tmp_path: Path, robin: Account, ada: Account) -> None:
    room = await ada.room(robin.id)
    size = 20 * 1024 * 1024
    async with running(robin, tmp_path):
        url = await ada.upload(b"\xff\xd8" + bytes(size - 2))
        await ada.send(room, "m.room.message", {"msgtype": "m.image", "body": "cat.jpg", "url": url})
        assert await ada.listen(1) == [f"{room}: {size} bytes"]
