"""Each answer belongs to the message that led to it, whatever the order of the answers, and also after a crash."""

import shutil
from pathlib import Path
from typing import Any

import pytest

import ravestate as rs
from modules.platform.chats.messenger import Post, chat, letter, parrot, room
from modules.platform.webio.visit import in_virtual_time, past
from ravestate.modules import interloc, rawio
from ravestate.modules.platform.chats import Incoming, Person

ANN, BEN = Person("1", "Ann"), Person("2", "Ben")


def answering(before: float = 0.0, after: float = 0.0, slow: str = "", **options: Any) -> rs.Module:
    """Return a module that answers each message. It waits before or after the answer, or only if the text is `slow`."""
    m = rs.Module("answering", requires=(rawio, interloc))

    @m.rule(when=rawio.input.changed, writes=rawio.output, **options)
    async def answer(ctx: rs.RuleContext) -> None:
        text = ctx.payload(rawio.input.changed)
        await ctx.sleep(before if slow in text else 0.0)
        ctx[rawio.output] = f"re {text}"
        await ctx.sleep(after)

    return m


def in_group(text: str, person: Person, **fields: Any) -> Incoming:
    return letter(text, "g", person=person, group=True, **fields)


def crash(folder: Path) -> Path:
    """Return a folder with a copy of the chats' file, as a crash would leave it now."""
    copy = folder.parent / "after the crash"
    shutil.copytree(folder, copy)
    return copy


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path / "before the crash"


def texts(post: Post) -> list[tuple[str, str]]:
    return [(each.text, each.to) for each in post.sent]


@in_virtual_time
async def test_a_quick_answer_that_overtakes_a_slow_one_replies_to_its_own_message(tmp_path: Path) -> None:
    post = Post()
    async with room(tmp_path, post, answering(before=5.0, slow="slow")) as opened:
        opened.receive([in_group("I am Ann", ANN), in_group("I am Ben", BEN)])
        await post.said(2)
        opened.receive([slow := in_group("slow", ANN)])
        await past(2.0)
        opened.receive([quick := in_group("quick", BEN)])
        await post.said(4)
        assert texts(post)[2:] == [("re quick", quick.id), ("re slow", slow.id)]
        opened.receive([in_group("quicker", BEN, id=quick.id, kind="edit")])
        await post.said(5)
        assert (post.sent[4].kind, post.sent[4].to) == ("edit", "answer 3")


@in_virtual_time
async def test_an_answer_to_a_second_message_is_not_sent_again_after_a_crash(folder: Path) -> None:
    post, next_post = Post(), Post()
    async with room(folder, post, answering(after=5.0)) as opened:
        opened.receive([one := letter("one")])
        await past(2.0)
        opened.receive([two := letter("two")])
        await past(2.0)
        assert texts(post) == [("re one", ""), ("re two", two.id)]
        assert one.id != two.id
        copy = crash(folder)
    async with room(copy, next_post, answering()) as opened:
        await past(30.0)
        assert next_post.sent == []
        opened.receive([letter("two")])
        await next_post.said(1)


@in_virtual_time
async def test_words_of_the_agents_own_initiative_belong_to_no_message(tmp_path: Path) -> None:
    herald = answering(before=5.0)
    news = herald.signal("news", input=True)

    @herald.rule(when=news, writes=rawio.output)
    async def tell(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "News!"

    post = Post()
    async with room(tmp_path, post, herald) as opened:
        opened.receive([question := in_group("one", ANN)])
        await past(1.0)
        opened.agent.contexts[0].emit(news)
        await post.said(2)
        assert texts(post) == [("News!", ""), ("re one", question.id)]
        opened.receive([in_group("One?", ANN, id=question.id, kind="edit")])
        await post.said(3)
        assert (post.sent[2].kind, post.sent[2].to) == ("edit", "answer 2")


@in_virtual_time
async def test_a_filler_without_a_cause_is_not_repeated_after_a_crash(folder: Path) -> None:
    filling = answering(before=5.0)

    @filling.rule(when=rs.activity.true.min_age(1.0).max_age(None), writes=rawio.output, detached=True, background=True)
    async def fill(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "Hmm"

    post, next_post = Post(), Post()
    async with room(folder, post, filling) as opened:
        opened.receive([letter("one")])
        await past(2.0)
        assert texts(post) == [("Hmm", "")]
        copy = crash(folder)
    async with room(copy, next_post, filling) as opened:
        await past(30.0)
        assert texts(next_post) == [("re one", "")]
        assert opened.store.alone("a") == []
        opened.receive([letter("two")])
        await next_post.said(3)
        assert [each.text for each in next_post.sent] == ["re one", "Hmm", "re two"]


@in_virtual_time
async def test_an_emoji_of_a_detached_rule_is_a_reaction_to_the_message_that_caused_it(tmp_path: Path) -> None:
    feeling = answering(before=5.0, slow="slow")
    glad = feeling.signal("glad")

    @feeling.rule(when=rawio.input.changed.where(lambda text: "slow" in text), emits=glad)
    async def feel(ctx: rs.RuleContext) -> None:
        await ctx.sleep(3.0)
        ctx.emit(glad)

    @feeling.rule(when=glad.detached(), writes=rawio.output, detached=True)
    async def show(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "👍"

    post = Post()
    async with room(tmp_path, post, feeling) as opened:
        opened.receive([slow := letter("slow")])
        await past(2.0)
        opened.receive([letter("quick")])
        await post.said(3)
        assert [(each.kind, each.to) for each in post.sent if each.text == "👍"] == [("reaction", slow.id)]


@in_virtual_time
async def test_two_answers_that_grow_at_once_do_not_mix(tmp_path: Path) -> None:
    stammer = rs.Module("stammer", requires=(rawio,))

    @stammer.rule(when=rawio.input.changed, writes=(rawio.output, rawio.speaking), emits=rawio.piece)
    async def speak(ctx: rs.RuleContext) -> None:
        text = ctx.payload(rawio.input.changed)
        ctx[rawio.speaking] = True
        for n in range(5):
            ctx.emit(rawio.piece, f"{text}{n} ")
            await ctx.sleep(1.0)
        if text == "b":
            ctx[rawio.output] = "b0 b1 b2 b3 b4"
        ctx[rawio.speaking] = False

    post = Post()
    async with room(tmp_path, post, stammer) as opened:
        opened.receive([a := letter("a")])
        await past(2.0)
        opened.receive([b := letter("b")])
        await past(20.0)
        assert sorted(texts(post)) == [("a0 a1 a2 a3 a4", a.id), ("b0 b1 b2 b3 b4", b.id)]


@in_virtual_time
async def test_the_words_of_a_rule_that_fails_become_an_answer_to_its_message(tmp_path: Path) -> None:
    failing = rs.Module("failing", requires=(rawio,))

    @failing.rule(when=rawio.input.changed, writes=(rawio.output, rawio.speaking), emits=rawio.piece)
    async def tell(ctx: rs.RuleContext) -> None:
        text = ctx.payload(rawio.input.changed)
        ctx[rawio.speaking] = True
        ctx.emit(rawio.piece, f"{text}, and ")
        await ctx.sleep(5.0)
        if text == "a":
            raise ValueError("the rest is lost")
        ctx[rawio.output] = f"{text}, and so on"
        ctx[rawio.speaking] = False

    post = Post()
    async with room(tmp_path, post, failing) as opened:
        opened.receive([a := in_group("a", ANN)])
        await past(2.0)
        opened.receive([b := in_group("b", BEN)])
        await past(10.0)
        assert texts(post) == [("a, and", a.id), ("b, and so on", b.id)]


@in_virtual_time
async def test_the_words_of_a_rule_that_failed_do_not_come_before_the_next_growing_words(tmp_path: Path) -> None:
    herald = answering()
    news = herald.signal("news", payload=str, input=True)

    @herald.rule(when=news, writes=(rawio.output, rawio.speaking), emits=rawio.piece)
    async def tell(ctx: rs.RuleContext) -> None:
        if ctx.payload(news) == "lost":
            ctx.emit(rawio.piece, "Lost ")
            raise ValueError("the rest is lost")
        ctx[rawio.speaking] = True
        for piece in ("Good ", "news"):
            await ctx.sleep(3.0)
            ctx.emit(rawio.piece, piece)
        ctx[rawio.speaking] = False

    post = Post()
    async with room(tmp_path, post, herald) as opened:
        opened.receive([letter("one")])
        await post.said(1)
        opened.agent.contexts[0].emit(news, "lost")
        await past(1.0)
        opened.receive([letter("two")])
        await past(5.0)
        opened.agent.contexts[0].emit(news, "good")
        await past(4.0)
        opened.receive([letter("three")])  # its answer ends while the news are growing
        await past(10.0)
        assert [text for text, _ in texts(post)] == ["re one", "re two", "re three", "Good news"]


@in_virtual_time
async def test_a_picture_replies_to_its_message_and_is_not_sent_again_after_a_crash(folder: Path) -> None:
    painter = rs.Module("painter", requires=(rawio,))

    @painter.rule(when=rawio.input.changed, reads=chat, writes=rawio.output)
    async def paint(ctx: rs.RuleContext) -> None:
        ctx[chat].send_picture(b"\x89PNG", "a house", origin=ctx.origin)
        await ctx.sleep(5.0)

    post, next_post = Post(), Post()
    async with room(folder, post, painter) as opened:
        opened.receive([wish := in_group("Paint!", ANN)])
        await past(2.0)
        assert [(each.kind, each.to) for each in post.sent] == [("picture", wish.id)]
        copy = crash(folder)
    async with room(copy, next_post, painter):
        await past(30.0)
        assert next_post.sent == []


@in_virtual_time
async def test_a_greeting_in_a_group_replies_to_the_newcomer_while_an_earlier_message_has_no_answer(
    tmp_path: Path,
) -> None:
    post = Post()
    slow = answering(before=5.0)

    @slow.rule(when=interloc.users.added, writes=rawio.output)
    async def greet(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = f"Hello {ctx.payload(interloc.users.added).item}!"

    async with room(tmp_path, post, slow) as opened:
        opened.receive([one := in_group("one", ANN)])
        await past(2.0)
        opened.receive([two := in_group("two", BEN)])
        await post.said(4)
        assert texts(post) == [("Hello Ann!", one.id), ("Hello Ben!", two.id), ("re one", one.id), ("re two", two.id)]


@in_virtual_time
async def test_a_command_and_a_reaction_are_causes_too(tmp_path: Path) -> None:
    post = Post()
    async with room(tmp_path, post, parrot) as opened:
        opened.receive([in_group("one", ANN), help_ := in_group("help", ANN, kind="command")])
        await post.said(3)
        assert post.sent[2].to == help_.id


@in_virtual_time
async def test_the_words_of_an_answer_that_was_cut_do_not_show_again_with_the_next_answer(tmp_path: Path) -> None:
    writer = rs.Module("writer", requires=(rawio,))

    @writer.rule(when=rawio.input.changed, writes=rawio.output, emits=rawio.piece)
    async def write(ctx: rs.RuleContext) -> None:
        text = ctx.payload(rawio.input.changed)
        if text == "one":
            ctx.emit(rawio.piece, "Once")
        await ctx.sleep(3.0)
        if text == "two":
            ctx[rawio.output] = "Two."

    post = Post()
    async with room(tmp_path, post, writer) as opened:
        opened.receive([letter("one")])
        await past(10.0)
        assert {words for _, words in post.shown} == {"Once"}
        post.shown.clear()
        opened.receive([letter("two")])
        await post.said(1)
        assert {words for _, words in post.shown} == {""}
