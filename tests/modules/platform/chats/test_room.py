"""A room has all chats of an agent on one messenger. Each chat has its own context, which can rest and resume."""

import asyncio
import itertools
from pathlib import Path

import pytest

import ravestate as rs
from modules.platform.chats.messenger import Post, chat, letter, parrot, room
from modules.platform.webio.visit import in_virtual_time, past
from ravestate.modules import interloc, ontology, rawio
from ravestate.modules.platform.chats import DeliveryError, Outgoing, Person


@in_virtual_time
async def test_each_chat_has_a_separate_context(tmp_path: Path) -> None:
    counter = rs.Module("counter", requires=(rawio,))
    count = counter.slot("count", 0)

    @counter.rule(when=rawio.input.changed, writes=(rawio.output, count))
    async def number(ctx: rs.RuleContext) -> None:
        ctx[count] = ctx[count] + 1
        ctx[rawio.output] = f"{ctx.payload(rawio.input.changed)} {ctx[count]}"

    post = Post()
    async with room(tmp_path, post, counter) as opened:
        opened.receive([letter("x", "a"), letter("y", "b"), letter("x", "a")])
        assert sorted(await post.said(3)) == ["a: x 1", "a: x 2", "b: y 1"]
        assert len(opened) == 2


@in_virtual_time
async def test_a_silent_chat_rests_and_later_resumes_without_a_greeting(tmp_path: Path) -> None:
    post = Post()
    async with room(tmp_path, post, rest=60.0) as opened:
        opened.receive([letter("one")])
        assert await post.said(2) == ["a: Hello A!", "a: one"]
        await past(61.0)
        assert len(opened) == 0
        opened.receive([letter("two")])
        assert (await post.said(3))[2:] == ["a: two"]
        assert len(opened) == 1


@in_virtual_time
async def test_when_there_are_too_many_chats_the_one_that_was_silent_longest_rests(tmp_path: Path) -> None:
    post = Post()
    async with room(tmp_path, post, chats=2) as opened:
        for n, name in enumerate("abc", start=1):
            opened.receive([letter("x", name)])
            await post.said(2 * n)
            await past(1.0)
        assert len(opened) == 2
        opened.receive([letter("y", "a")])
        assert (await post.said(7))[6:] == ["a: y"]


@in_virtual_time
async def test_after_a_rush_of_new_chats_only_as_many_as_the_limit_stay_awake(tmp_path: Path) -> None:
    post = Post()
    async with room(tmp_path, post, chats=5) as opened:
        opened.receive([letter("x", name) for name in "abcde"])
        await post.said(10)
        await past(1.0)
        assert len(opened) == 5
        opened.receive([letter("x", f"new {n}") for n in range(20)])
        await post.said(50)
        await past(1.0)
        assert len(opened) == 5


@in_virtual_time
async def test_the_agent_hears_a_message_that_is_delivered_twice_only_once(tmp_path: Path) -> None:
    post = Post()
    message = letter("one")
    async with room(tmp_path, post, rs.Module("quiet", requires=(rawio,)), parrot) as opened:
        opened.receive([message, message])
        opened.receive([message])
        opened.receive([letter("two")])
        assert await post.said(3) == ["a: Hello A!", "a: one", "a: two"]
    async with room(tmp_path, post) as opened:
        opened.receive([message, letter("three")])
        assert (await post.said(4))[3:] == ["a: three"]


@in_virtual_time
async def test_an_agent_that_has_left_returns_when_the_next_message_comes(tmp_path: Path) -> None:
    quitter = rs.Module("quitter", requires=(rawio,))

    @quitter.rule(when=rawio.input.changed, writes=rawio.output)
    async def go(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "I go."
        ctx.stop()

    post = Post()
    async with room(tmp_path, post, quitter) as opened:
        opened.receive([letter("one")])
        await post.said(1)
        opened.receive([letter("two")])
        assert await post.said(2) == ["a: I go.", "a: I go."]


@in_virtual_time
async def test_a_new_message_can_interrupt_a_slow_answer(tmp_path: Path) -> None:
    slow = rs.Module("slow", requires=(rawio,))

    @slow.rule(when=rawio.input.changed, writes=rawio.output, until=rawio.input.changed)
    async def think(ctx: rs.RuleContext) -> None:
        await ctx.sleep(30.0)
        ctx[rawio.output] = f"You said {ctx.payload(rawio.input.changed)}."

    post = Post()
    async with room(tmp_path, post, slow) as opened:
        opened.receive([letter("one")])
        await past(5.0)
        opened.receive([letter("stop")])
        assert await post.said(1) == ["a: You said stop."]
        assert post.shown  # meanwhile the chat showed that the agent was writing


@in_virtual_time
async def test_pieces_become_one_message_even_if_the_answer_is_cut(tmp_path: Path) -> None:
    stammer = rs.Module("stammer", requires=(rawio,))

    @stammer.rule(when=rawio.input.changed, writes=rawio.speaking, emits=rawio.piece)
    async def speak(ctx: rs.RuleContext) -> None:
        ctx[rawio.speaking] = True
        for piece in ("I ", "do ", "not know"):
            ctx.emit(rawio.piece, piece)
        ctx[rawio.speaking] = False

    post = Post()
    async with room(tmp_path, post, stammer) as opened:
        opened.receive([letter("one")])
        assert await post.said(1) == ["a: I do not know"]


@in_virtual_time
async def test_a_growing_answer_is_updated_about_once_a_second_and_becomes_one_message(tmp_path: Path) -> None:
    writer = rs.Module("writer", requires=(rawio,))
    words = [f"{n % 10} " for n in range(45)]

    @writer.rule(when=rawio.input.changed, writes=(rawio.output, rawio.speaking), emits=rawio.piece)
    async def write(ctx: rs.RuleContext) -> None:
        ctx[rawio.speaking] = True
        for word in words:
            ctx.emit(rawio.piece, word)
            await ctx.sleep(0.1)
        ctx[rawio.output] = "".join(words)
        ctx[rawio.speaking] = False

    post = Post()
    async with room(tmp_path, post, writer) as opened:
        opened.receive([letter("Write!")])
        await past(0.7)
        post.failures += [DeliveryError("too many messages", wait=1.0)]
        assert await post.said(1) == [f"a: {''.join(words).strip()}"]
        await past(60.0)
    assert len(post.sent) == 1
    times = [time for time, _ in post.shown]
    assert all(after - before > 0.9 for before, after in itertools.pairwise(times))
    assert times[2] - times[1] > 1.9  # because the messenger asked the agent to wait
    assert all(shown and "".join(words).startswith(shown) for _, shown in post.shown)


@in_virtual_time
async def test_a_rule_can_send_a_picture_to_its_chat(tmp_path: Path) -> None:
    painter = rs.Module("painter", requires=(rawio,))

    @painter.rule(when=rawio.input.changed, reads=chat)
    async def paint(ctx: rs.RuleContext) -> None:
        ctx[chat].send_picture(b"\x89PNG", "a house")

    post = Post()
    async with room(tmp_path, post, painter) as opened:
        opened.receive([letter("Paint!")])
        await post.said(1)
    assert [(each.kind, each.data, each.text) for each in post.sent] == [("picture", b"\x89PNG", "a house")]


# ------------------------------------------------------------------------------------ failures


@in_virtual_time
async def test_failed_deliveries_are_repeated_in_order_with_growing_pauses(tmp_path: Path) -> None:
    post = Post()
    post.failures += [DeliveryError("the server has failed", unsure=True)] * 4
    async with room(tmp_path, post) as opened:
        opened.receive([letter("one"), letter("two")])
        assert await post.said(3) == ["a: Hello A!", "a: one", "a: two"]
    times = [time for time, _ in post.attempts[:5]]
    waits = [after - before for before, after in itertools.pairwise(times)]
    assert all(0.7 * wait < found <= wait for wait, found in zip((0.5, 1.0, 2.0, 4.0), waits, strict=True))


@in_virtual_time
async def test_if_the_messenger_asks_to_wait_for_one_chat_only_this_chat_is_delayed(tmp_path: Path) -> None:
    post = Post()
    post.failures += [DeliveryError("too many messages", wait=30.0)]
    async with room(tmp_path, post) as opened:
        opened.receive([letter("one", "a")])
        await past(1.0)
        opened.receive([letter("two", "b")])
        said = await post.said(4)
    assert said == ["b: Hello B!", "b: two", "a: Hello A!", "a: one"]
    assert post.attempts[-1][0] >= post.attempts[0][0] + 30.0


@in_virtual_time
async def test_a_refused_message_does_not_stop_the_next_message(tmp_path: Path) -> None:
    post = Post()
    post.failures += [DeliveryError("the text is bad", final=True), RuntimeError("a mistake in the platform")]
    async with room(tmp_path, post) as opened:
        opened.receive([letter("one"), letter("two")])
        assert await post.said(1) == ["a: two"]


@in_virtual_time
async def test_a_closed_chat_is_forgotten(tmp_path: Path) -> None:
    post = Post()
    post.failures += [DeliveryError("blocked", gone=True)]
    async with room(tmp_path, post) as opened:
        opened.receive([letter("one"), letter("two")])
        await past(5.0)
        assert (post.sent, len(opened)) == ([], 0)
        opened.receive([letter("I am back")])
        assert await post.said(2) == ["a: Hello A!", "a: I am back"]
        opened.receive([letter(kind="left")])
        await past(1.0)
        assert len(opened) == 0
    async with room(tmp_path, post):
        await past(5.0)
        assert len(post.sent) == 2


@in_virtual_time
async def test_the_agent_admits_that_it_could_not_fetch_a_file(tmp_path: Path) -> None:
    post = Post()
    post.files["1"] = b"picture"
    looker = rs.Module("looker", requires=(rawio,))

    @looker.rule(when=rawio.picture.changed, writes=rawio.output)
    async def look(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = f"{ctx.payload(rawio.picture.changed)!r}"

    async with room(tmp_path, post, looker) as opened:
        post.failures += [DeliveryError("the server has failed")] * 2
        opened.receive([letter(kind="picture", file="1"), letter(kind="picture", file="2")])
        assert await post.said(2) == ["a: b'picture'", "a: I couldn't open that."]
        post.failures += [DeliveryError("the server has failed")] * 4
        opened.receive([letter(kind="picture", file="1")])
        assert (await post.said(3))[2:] == ["a: I couldn't open that."]


# ------------------------------------------------------------------------------------ people


@in_virtual_time
async def test_in_a_group_each_person_is_a_user_of_the_agent(tmp_path: Path) -> None:
    post = Post()
    ada, bob = Person("1", "Ada"), Person("2", "Bob")
    async with room(tmp_path, post) as opened:
        opened.receive([letter("one", "g", person=ada, group=True), letter("two", "g", person=bob, group=True)])
        assert await post.said(4) == ["g: Hello Ada!", "g: one", "g: Hello Bob!", "g: two"]
        [context] = opened.agent.contexts
        assert dict(context.read(interloc.users)) == {"letters-1": "Ada", "letters-2": "Bob"}
        opened.receive([letter("stop", "g", kind="command", person=ada, group=True)])
        await past(1.0)
        assert dict(context.read(interloc.users)) == {"letters-2": "Bob"}
    assert post.sent[1].to and post.sent[3].to  # in a group, an answer is a reply to a message


def remembering(tmp_path: Path, *steps: list[str]) -> list[str]:
    """Run an agent with memory once for each list of messages; return all its answers. Time is real."""
    post = Post()

    async def talk() -> None:
        expected = 0
        for step in steps:
            settings = {"ontology": {"path": tmp_path / "memory.lbug"}, "letters": {"path": tmp_path / "letters.db"}}
            from modules.platform.chats.messenger import letters
            from ravestate.modules.platform.chats import Room
            from ravestate.runtime.agent import Agent

            async with Room(Agent(parrot, knower, letters, settings=settings), "letters", post, "me") as opened:
                for text in step:
                    kind = "command" if text == "forget" else "text"
                    opened.receive([letter(text, kind=kind)])
                    expected += 1
                    await post.said(expected)

    asyncio.run(talk())
    return [each.text for each in post.sent]


knower = rs.Module("knower", requires=(rawio, interloc, ontology))


@knower.rule(when=rawio.input.changed, reads=(interloc.users, ontology.memory), writes=rawio.output, weight=9)
async def who_is_it(ctx: rs.RuleContext) -> None:
    [person] = ctx[interloc.users].values()
    people = await ctx[ontology.memory].find("Person")
    accounts = await ctx[ontology.memory].find("Account")
    await ctx[ontology.memory].update(person.node, name="Ada Lovelace")
    ctx[rawio.output] = f"{person} of {len(people)} {[each['name'] for each in accounts]}"


@knower.rule(when=interloc.users.added, writes=rawio.output, weight=9)
async def keep_silent(ctx: rs.RuleContext) -> None:
    """Make `parrot` greet nobody."""


def test_memory_keeps_a_person_with_their_account_until_they_ask_to_be_forgotten(tmp_path: Path) -> None:
    said = remembering(tmp_path, ["one"], ["two", "forget"], ["three"])
    assert said == [
        "A of 1 ['letters:a']",
        "Ada Lovelace of 1 ['letters:a']",
        "I have forgotten you, and everything that you told me.",
        "A of 1 ['letters:a']",
    ]


@in_virtual_time
async def test_only_a_reaction_to_the_agents_own_message_reaches_it(tmp_path: Path) -> None:
    feeler = rs.Module("feeler", requires=(rawio,))

    @feeler.rule(when=rawio.reaction, writes=rawio.output)
    async def feel(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = ctx.payload(rawio.reaction)

    ada, bob = Person("ada", "Ada"), Person("bob", "Bob")
    post = Post()
    async with room(tmp_path, post, parrot, feeler) as opened:
        opened.receive([hello := letter("Hello", person=ada, group=True)])
        assert await post.said(2) == ["a: Hello Ada!", "a: Hello"]
        await past(1.0)
        for other in (hello.id, "unheard"):
            opened.receive([letter("👎", id=other, person=bob, kind="reaction", group=True)])
        opened.receive([letter("👎", "b", id=hello.id, person=bob, kind="reaction", group=True)])
        await past(1.0)
        assert len(opened) == 1  # no chat has begun for a reaction
        opened.receive([letter("👏", id="answer 2", person=ada, kind="reaction", group=True)])
        assert (await post.said(3))[2:] == ["a: 👏"]
        opened.receive([letter("🎉", id="answer 2", person=bob, kind="reaction", group=True)])
        assert (await post.said(5))[3:] == ["a: Hello Bob!", "a: 🎉"]


@in_virtual_time
async def test_the_agent_is_called_by_its_name_before_the_first_chat(tmp_path: Path) -> None:
    async with room(tmp_path, Post()) as opened:
        assert opened.called == {interloc.agent.default}
        assert len(opened) == 0


def namer(name: str, seconds: float = 0.0) -> rs.Module:
    """Return a module that gives the agent a name some seconds after the start of each context."""
    module = rs.Module("namer", requires=(rawio, interloc))

    @module.rule(when=rs.startup, writes=interloc.agent)
    async def give_name(ctx: rs.RuleContext) -> None:
        await ctx.sleep(seconds)
        ctx[interloc.agent] = name

    return module


@in_virtual_time
async def test_the_agent_is_called_by_the_name_that_a_rule_gives_it_at_the_start(tmp_path: Path) -> None:
    post = Post()
    async with room(tmp_path, post, parrot, namer("Rosie", 2.0)) as opened:
        assert opened.called == {"Rosie"}
        assert not post.sent
        opened.receive([letter("Hello")])
        assert await post.said(2) == ["a: Hello A!", "a: Hello"]


@in_virtual_time
async def test_a_name_that_comes_late_does_not_keep_the_agent_from_starting(tmp_path: Path) -> None:
    post, begun = Post(), asyncio.get_running_loop().time()
    async with room(tmp_path, post, parrot, namer("Rosie", 60.0)) as opened:
        assert asyncio.get_running_loop().time() - begun < 30.0
        assert opened.called == {interloc.agent.default}
        opened.receive([letter("Hello")])
        assert await post.said(2) == ["a: Hello A!", "a: Hello"]


@pytest.mark.parametrize("text", ["👍", "yes"])
def test_only_an_emoji_that_the_messenger_knows_becomes_a_reaction(tmp_path: Path, text: str) -> None:
    post = Post()

    @in_virtual_time
    async def test() -> None:
        async with room(tmp_path, post) as opened:
            opened.receive([letter("hello"), message := letter(text)])
            await post.said(3)
            last: Outgoing = post.sent[-1]
            assert (last.kind, last.to) == (("reaction", message.id) if text == "👍" else ("text", ""))

    test()
