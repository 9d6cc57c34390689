"""Inspectors are connections to the board: the records they get, their questions, commands and limits."""

import json
from typing import Any

import pytest

import ravestate as rs
from board.looking import Look, board, gossip, in_virtual_time, passing, secret
from modules.platform.webio.visit import Visit
from ravestate.board import inspector
from ravestate.board.description import describe
from ravestate.board.trace_file import Recording
from ravestate.modules import interloc, rawio
from ravestate.modules.platform.webio import channel


@in_virtual_time
async def test_an_inspector_gets_the_policy_and_the_records_from_the_start() -> None:
    async with board() as app, Visit(app) as visit:
        await visit.hello()
        visit.say("Really?")
        await visit.messages(3)
        async with Look(app) as look:
            welcome = await look.begin(session=visit.session)
            born = await look.until("born", signal="rawio:input:changed")
            await look.until("settled", rule="gossip:answer", outcome="done")
    assert (welcome["v"], welcome["title"], welcome["live"], welcome["whole"]) == (1, "Elske", True, True)
    assert [rule["name"] for rule in welcome["policy"]["rules"]][:3] == [
        "gossip:classify",
        "gossip:answer",
        "gossip:talk",
    ]
    assert born["payload"] == {"text": '"Really?"'}
    assert look.records[0]["kind"] == "born"
    assert look.records[0]["signal"] == "core:startup"
    assert welcome["visitor"].startswith("webio-")
    assert visit.session not in json.dumps(welcome)


@in_virtual_time
async def test_the_chat_page_gets_the_address_of_the_board() -> None:
    async with board() as app, Visit(app) as visit:
        assert (await visit.hello())["inside"] == "board/"


@in_virtual_time
async def test_an_inspector_that_names_no_conversation_gets_the_newest_or_begins_one() -> None:
    async with board() as app:
        async with Look(app) as look:
            first = await look.begin()
        assert len(app.state.sessions) == 1
        async with Visit(app) as visit:
            await visit.hello()
            async with Look(app) as look:
                second = await look.begin()
                listed = await look.answer("conversations")
            async with Look(app) as look:
                again = await look.begin(visitor=first["visitor"])
    assert [c["visitor"] for c in listed["conversations"]] == [first["visitor"], second["visitor"]]
    assert again["visitor"] == first["visitor"] != second["visitor"]


@in_virtual_time
async def test_the_list_shows_the_start_and_last_words_of_conversations_and_is_updated() -> None:
    async with board() as app, Visit(app) as visit, Look(app) as look:
        await visit.hello()
        await look.begin(session=visit.session)
        (before,) = (await look.answer("conversations"))["conversations"]
        visit.say("My name is Ada, and I live " + "x" * 100)
        await passing(2)
        (after,) = (await look.answer("conversations"))["conversations"]
        (session,) = app.state.sessions
    assert before == {"visitor": session.visitor, "name": None, "began": session.began, "said": None}
    assert after == {**before, "said": "My name is Ada, and I live xxxxxxxxxxxxxxxxxxxxx"}


def test_the_list_has_the_newest_conversations_and_the_one_in_view(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    @in_virtual_time
    async def test() -> None:
        async with board() as app:
            opened = [await app.state.sessions.open() for _ in range(8)]
            for own, others in ((opened[0], opened[-4:]), (opened[-1], opened[-5:-1])):
                async with Look(app) as look:
                    await look.begin(session=own.id)
                    listed = await look.answer("conversations")
                visitors = {conversation["visitor"] for conversation in listed["conversations"]}
                assert visitors == {own.visitor, *(session.visitor for session in others)}
                assert (len(listed["conversations"]), listed["more"]) == (5, 3)
                began = [conversation["began"] for conversation in listed["conversations"]]
                assert began == sorted(began)

    monkeypatch.setattr(inspector, "LIST", 5)
    test()


@in_virtual_time
async def test_an_ending_conversation_is_not_the_default_one() -> None:
    slow = rs.Module("slow", requires=(rawio, interloc))

    @slow.rule(when=interloc.users.removed, writes=rawio.output)
    async def bid_farewell(ctx: rs.RuleContext) -> None:
        await ctx.sleep(3.0)
        ctx[rawio.output] = "Bye!"

    async with board(slow) as app, Visit(app) as visit:
        await visit.hello()
        visit.tell("bye")
        await passing(1)
        (leaving,) = app.state.sessions
        async with Look(app) as look:
            assert (await look.begin())["visitor"] != leaving.visitor
        async with Look(app) as look:
            assert (await look.begin(visitor=leaving.visitor))["visitor"] == leaving.visitor


@in_virtual_time
async def test_lone_surrogates_are_sent_unchanged() -> None:
    recording = Recording("Els\ud800", describe(rs.compile(gossip)), (), whole=True)
    async with board(recording=recording) as app, Look(app) as look:
        assert (await look.begin())["title"] == "Els\ud800"


@in_virtual_time
async def test_an_inspector_gets_only_the_records_of_its_own_conversation() -> None:
    async with board() as app, Visit(app) as one, Visit(app) as other:
        await one.hello()
        await other.hello()
        async with Look(app) as look:
            await look.begin(session=one.session)
            other.say("whisper")
            one.say("shout")
            await look.until("born", signal="rawio:input:changed")
            await passing(2)
            look.tell("ping")
            await look.answer("pong")
        assert "whisper" not in json.dumps(look.records)


@in_virtual_time
async def test_why_not_is_answered_with_the_right_reason() -> None:
    async with board() as app, Look(app) as look:
        await look.begin()
        look.tell("say", text="Hello")
        await look.until("settled", rule="gossip:talk", outcome="done")
        spike = (await look.until("born", signal="rawio:input:changed"))["spike"]
        look.tell("why", rule="gossip:answer", spike=spike)
        found = await look.answer("why")
    assert found["verdict"] == "untouched"
    assert found["missing"][0]["raisers"][0]["words"].startswith("gossip:classify finished without raising it")
    assert found["whole"] is True


@in_virtual_time
async def test_a_waiting_rule_can_be_explained() -> None:
    async with board() as app, Look(app) as look:
        await look.begin()
        look.tell("pause")  # otherwise, the rule may have stopped waiting before the board answers
        look.tell("say", text="Hello")
        await step_until(look, "waits", rule="gossip:talk")
        look.tell("explain", rule="gossip:talk")
        found = await look.answer("explained")
    (activation,) = found["activations"]
    assert activation["state"] == "waiting"
    assert activation["waits_for"][0][0] == "gossip:answer"
    assert found["clauses"][0]["effective"] > 0


async def step_until(look: Look, kind: str, **fields: Any) -> dict[str, Any]:
    """Step until a record of a kind with these fields arrives."""
    for _ in range(20):
        found = look.found(kind, **fields)
        if found is not None:
            return found
        look.tell("step")
        await passing(1)
        look.tell("ping")
        await look.answer("pong")
    raise AssertionError(f"no record of kind {kind} with {fields} after 20 steps")


@in_virtual_time
async def test_the_clock_can_be_paused_stepped_and_resumed() -> None:
    async with board() as app, Look(app) as look:
        await look.begin()
        look.tell("pause")
        assert (await look.answer("records"))["paused"] is True
        look.tell("say", text="Hello")
        await look.until("born", signal="rawio:input:changed")
        await passing(30)
        assert not [r for r in look.records if r.get("rule") == "gossip:classify" and r["kind"] == "started"]
        started = await step_until(look, "started", rule="gossip:classify")
        assert started["time"] < 1
        settled = await step_until(look, "settled", rule="gossip:classify")
        # Nothing else was due, so a step advanced the clock.
        assert settled["time"] == pytest.approx(started["time"] + 0.2)
        await passing(30)
        assert not look.found("settled", rule="gossip:talk")
        look.tell("resume")
        await look.until("settled", rule="gossip:talk", outcome="done")
        look.tell("look")
        assert (await look.answer("state"))["paused"] is False


@in_virtual_time
async def test_a_step_that_does_nothing_says_why() -> None:
    async with board(gossip) as app, Look(app) as look:
        await look.begin()
        look.tell("step")
        assert "pause it first" in (await look.answer("error"))["text"]
        look.tell("pause")
        look.tell("emit", signal="gossip:cheered", payload={})
        look.tell("step")
        await look.until("started", rule="gossip:bow")
        for _ in range(40):
            look.tell("step")
            await passing(0.1)
        assert (await look.answer("error"))["text"].startswith("nothing is due")


@in_virtual_time
async def test_the_board_can_write_slots_and_raise_signals() -> None:
    async with board() as app, Look(app) as look:
        await look.begin()
        look.tell("put", slot="gossip:secret", value={"of": ["Ada", 1]})
        look.tell("emit", signal="gossip:cheered", payload={"how": "loud"})
        written = await look.until("set", slot="gossip:secret")
        await look.until("settled", rule="gossip:bow")
        look.tell("look")
        slots = (await look.answer("state"))["slots"]
    assert written["value"] == {"text": '{"of": ["Ada", 1]}'}
    assert slots["gossip:secret"] == {"text": '{"of": ["Ada", 1]}'}


@pytest.mark.parametrize(
    ("frame", "words"),
    [
        ({"type": "put", "slot": "gossip:sercet", "value": 1}, "no slot 'gossip:sercet'; did you mean"),
        ({"type": "put", "slot": "rawio:input", "value": 7}, "which takes str, not int"),
        ({"type": "put", "slot": "rawio:speaking", "value": "banana"}, "write true or false, not 'banana'"),
        ({"type": "emit", "signal": "gossip:cheered"}, "carries a payload of type dict: give a payload"),
        ({"type": "emit", "signal": "gossip:cheered", "payload": 1}, "a payload of type dict, not int"),
        ({"type": "emit", "signal": "gossip:nothing"}, "this agent has no signal 'gossip:nothing'"),
        ({"type": "explain", "rule": "gossip:nobody"}, "the policy has no rule 'gossip:nobody'"),
        ({"type": "why", "rule": "gossip:talk", "spike": 10**9}, "spike 1000000000 is not in the history"),
        ({"type": "why", "rule": "gossip:talk", "spike": "one"}, "why: spike: Input should be a valid integer"),
        ({"type": "why", "rule": "gossip:talk"}, "why: spike: Field required"),
        ({"type": "dance"}, "dance: Input tag 'dance'"),
        ({"type": "say", "text": ""}, "say: text: String should have at least 1 character"),
        ({"type": "diagram", "unfolded": "all"}, "diagram: unfolded: Input should be a valid list"),
        ({"type": "hello", "v": 1}, "hello comes first, and only once"),
        ([], "a frame is an object"),
    ],
)  # fmt: skip
def test_a_wrong_command_gets_an_error(frame: Any, words: str) -> None:
    @in_virtual_time
    async def test() -> None:
        async with board() as app, Look(app) as look:
            await look.begin()
            look.send(json.dumps(frame))
            error = await look.answer("error")
            assert words in error["text"]
            assert error.get("of") == (None if error["code"] == "malformed" else frame["type"])
            look.tell("ping")
            await look.answer("pong")

    test()


@in_virtual_time
async def test_a_malformed_frame_gets_an_error() -> None:
    async with board() as app, Look(app) as look:
        await look.begin()
        for text in ("{", b"\x00", "[" * 5000, '{"type": []}'):
            look.send(text)
            assert (await look.answer("error"))["code"] == "malformed"


@pytest.mark.parametrize(
    ("first", "code"),
    [
        ({"type": "ping"}, 4400),
        ({"type": "hello", "v": 2}, 4400),
        ({"type": "hello", "v": 1, "session": "guessed"}, 4404),
        ({"type": "hello", "v": 1, "visitor": "webio-nobody"}, 4404),
        ({"type": "hello", "v": 1, "recording": "lost"}, 4404),
    ],
)
def test_a_wrong_hello_closes_the_connection(first: dict[str, Any], code: int) -> None:
    @in_virtual_time
    async def test() -> None:
        async with board() as app, Look(app) as look:
            look.send(json.dumps(first))
            assert (await look.next())["type"] == "error"
            assert (await look.next())["type"] == "websocket.close"
            assert look.closed == code

    test()


@in_virtual_time
async def test_a_frame_that_is_too_large_closes_the_connection() -> None:
    async with board() as app:
        async with Look(app) as look:
            look.tell("hello", v=1, token="x" * channel.LONGEST)
            assert (await look.answer("error"))["code"] == "too-large"
            await look.next()
            assert look.closed == 1009
        async with Look(app) as look:
            await look.begin()
            look.tell("say", text="x" * channel.LONGEST)
            assert (await look.answer("error"))["code"] == "too-large"
            await look.next()
            assert look.closed == 1009


@in_virtual_time
async def test_a_silent_client_is_dropped() -> None:
    async with board() as app, Look(app) as look:
        assert (await look.next())["code"] == "silent"
        await look.next()
        assert look.closed == 4408


@in_virtual_time
async def test_the_board_requires_the_token_and_the_origin_of_the_chat_page() -> None:
    async with board(token="open sesame, please") as app:
        async with Look(app) as look:
            await look.begin()
            await look.next()
            assert look.closed == 4401
        async with Look(app) as look:
            assert (await look.begin(token="open sesame, please"))["type"] == "welcome"
        async with Look(app, origin="https://elsewhere.example") as look:
            await look.next()
            assert not look.accepted


@in_virtual_time
async def test_a_browser_that_stops_reading_misses_records_but_does_not_delay_the_agent() -> None:
    ticks = rs.Module("ticks", requires=(rawio,))
    tick = ticks.signal("tick")

    @ticks.rule(when=tick)
    async def count(ctx: rs.RuleContext) -> None: ...

    async with board(ticks) as app, Look(app) as look:
        await look.begin()
        (session,) = app.state.sessions
        look.reading.clear()
        for _ in range(200):
            for _ in range(250):
                session.context.emit(tick)
            await passing(2)
        assert session.context.now >= 400  # the conversation continued
        look.reading.set()
        missed = 0
        frame: dict[str, Any] = {}
        while frame.get("behind") != 0 or not missed:
            frame = await look.answer("records")
            missed += frame["missed"]
    assert missed > 0
    assert len(look.records) <= 130_000


@in_virtual_time
async def test_a_client_that_sends_requests_without_reading_the_replies_is_dropped() -> None:
    async with board() as app, Look(app) as look:
        await look.begin()
        look.reading.clear()
        for _ in range(inspector.REPLIES + 60):
            look.tell("look")
        await passing(60)
        look.reading.set()
        await look.over()


@in_virtual_time
async def test_huge_values_are_cut_and_strange_values_shown_as_text() -> None:
    class Odd:
        def __repr__(self) -> str:
            raise ValueError("no")

    async with board() as app, Look(app) as look:
        await look.begin()
        (session,) = app.state.sessions
        session.context.put(secret, "x" * 10_000_000)
        large = await look.until("set", slot="gossip:secret")
        look.records.clear()
        session.context.put(secret, Odd())
        odd = await look.until("set", slot="gossip:secret")
        look.records.clear()
        session.context.put(secret, {"script": "<script>alert(1)</script>"})
        markup = await look.until("set", slot="gossip:secret")
    assert len(large["value"]["text"]) <= 2000
    assert large["value"]["cut"] is True
    assert odd["value"] == {"text": "<Odd whose repr fails: ValueError>", "json": False}
    assert "<script>" in markup["value"]["text"]


@in_virtual_time
async def test_a_new_rule_is_announced() -> None:
    async with board() as app, Look(app) as look:
        await look.begin()
        (session,) = app.state.sessions

        @rs.Module("late").rule(when=rawio.input.changed)
        async def listen(ctx: rs.RuleContext) -> None: ...

        session.context.add_rule(listen)
        policy = (await look.answer("policy"))["policy"]
    assert policy["rules"][-1]["name"] == "late:listen"


@in_virtual_time
async def test_an_inspector_gets_the_diagram_folded_or_partly_unfolded() -> None:
    async with board() as app, Look(app) as look:
        await look.begin()
        look.tell("diagram", unfolded=[])
        folded = await look.answer("diagram")
        look.tell("diagram", unfolded=["gossip"])
        partly = await look.answer("diagram")
    assert {node["kind"] for node in folded["nodes"]} == {"module"}
    assert "rule gossip:answer" in [node["id"] for node in partly["nodes"]]
    assert "module rawio" in [node["id"] for node in partly["nodes"]]


def names_told(frames: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the records in some frames that write the agent's name."""
    records = [record for frame in frames for record in frame.get("records", ())]
    return [record for record in records if record.get("slot") == "interloc:agent"]


@in_virtual_time
async def test_the_agents_new_name_becomes_the_title_unless_the_title_is_fixed() -> None:
    async with board(title=None) as app, Look(app) as look:
        assert (await look.begin())["title"] == "Ravestate"
        look.tell("put", slot="interloc:agent", value="Robin")
        assert (await look.answer("renamed"))["title"] == "Robin"
        async with Look(app) as other:
            assert (await other.begin())["title"] == "Robin"
    async with board() as app, Look(app) as look:
        assert (await look.begin())["title"] == "Elske"
        look.tell("put", slot="interloc:agent", value="Robin")
        told: list[dict[str, Any]] = []
        while not names_told(told):
            told += await look.frames("records")
        look.tell("say", text="Hello")  # also look at the next frames
        told += await look.frames("records")
        assert "renamed" not in [frame["type"] for frame in told]


@in_virtual_time
async def test_the_end_of_a_conversation_is_announced() -> None:
    async with board() as app, Visit(app) as visit, Look(app) as look:
        await visit.hello()
        await look.begin(session=visit.session)
        visit.tell("bye")
        assert (await look.answer("ended"))["text"] == "the visitor left"
        await look.next()
        assert look.closed == 1000


@in_virtual_time
async def test_an_open_board_keeps_its_conversation_alive() -> None:
    async with board(keep=5) as app:
        async with Look(app) as look:
            await look.begin()
            await passing(60)
            assert len(app.state.sessions) == 1
        await passing(60)
        assert len(app.state.sessions) == 0
