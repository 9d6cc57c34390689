"""A user edits their last message: the new answer replaces the earlier one, part by part."""

import shutil
from pathlib import Path
from typing import Any

import pytest

import ravestate as rs
from modules.platform.chats.messenger import Post, letter, room
from modules.platform.webio.visit import in_virtual_time, past
from ravestate.modules import rawio
from ravestate.modules.platform.chats import Outgoing


class Board(Post):
    """A messenger that shows, for each message of the agent, its latest text. It deletes messages on request."""

    def __init__(self) -> None:
        super().__init__()
        self.shown_now: dict[str, str] = {}

    async def send(self, message: Outgoing, again: bool) -> str:
        id = await super().send(message, again)
        if message.kind == "delete":
            del self.shown_now[message.to]
        elif message.kind == "edit":
            assert message.to in self.shown_now
            self.shown_now[message.to] = message.text
            return message.to
        elif message.kind != "reaction":
            self.shown_now[id] = message.text
        return id

    @property
    def now(self) -> list[str]:
        return list(self.shown_now.values())


@pytest.fixture
def post() -> Board:
    return Board()


speaker = rs.Module("speaker", requires=(rawio,))


@speaker.rule(when=rawio.input.changed, writes=rawio.output)
async def speak(ctx: rs.RuleContext) -> rs.Resign | None:
    """Write an utterance for each word, with a pause after each; resign if there is none."""
    words = ctx.payload(rawio.input.changed).split()
    if words == ["nothing"]:
        return rs.Resign("there is nothing to say")
    for word in words:
        ctx[rawio.output] = word
        await ctx.sleep(1.0)
    return None


def edit(of: Any, text: str) -> Any:
    return letter(text, id=of.id, kind="edit")


@in_virtual_time
async def test_each_part_of_a_long_answer_is_replaced_or_deleted(tmp_path: Path, post: Board) -> None:
    repeater = rs.Module("repeater", requires=(rawio,))

    @repeater.rule(when=rawio.input.changed, writes=rawio.output)
    async def repeat(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = ctx.payload(rawio.input.changed)

    async with room(tmp_path, post, repeater) as opened:
        for parts in (3, 2, 4, 1):
            text = " ".join(f"{parts}{n}" * 45 for n in range(parts))
            opened.receive([message := letter(text)] if parts == 3 else [edit(message, text)])
            await past(5.0)
            assert post.now == text.split()


@in_virtual_time
async def test_each_utterance_of_an_answer_is_replaced_or_deleted(tmp_path: Path, post: Board) -> None:
    async with room(tmp_path, post, speaker) as opened:
        opened.receive([message := letter("one two three")])
        await past(10.0)
        opened.receive([edit(message, "four five")])
        await past(10.0)
        assert post.now == ["four", "five"]
        assert [each.kind for each in post.sent] == [*["text"] * 3, "edit", "edit", "delete"]
        opened.receive([edit(message, "six seven eight")])
        await past(10.0)
        assert post.now == ["six", "seven", "eight"]
        opened.receive([edit(message, "👍")])
        await past(10.0)
        assert post.now == []
        assert (post.sent[9].kind, post.sent[9].to) == ("reaction", message.id)
        opened.receive([edit(message, "nine")])
        await past(10.0)
        assert post.now == ["nine"]


@in_virtual_time
async def test_the_earlier_answer_stays_if_the_edited_message_gets_no_answer(tmp_path: Path, post: Board) -> None:
    async with room(tmp_path, post, speaker) as opened:
        opened.receive([message := letter("one two")])
        await past(10.0)
        opened.receive([edit(message, "nothing")])
        await past(10.0)
        assert post.now == ["one", "two"]
        opened.receive([edit(message, "three")])
        await past(10.0)
        assert post.now == ["three"]


@pytest.mark.parametrize("seconds", [0.5, 1.5, 2.5])
def test_after_a_crash_during_an_edit_the_rest_is_replaced_or_deleted(
    tmp_path: Path, post: Board, seconds: float
) -> None:
    @in_virtual_time
    async def test() -> None:
        before, after = tmp_path / "before", tmp_path / "after"
        async with room(before, post, speaker) as opened:
            opened.receive([message := letter("one two three four")])
            await past(10.0)
            opened.receive([edit(message, "five six seven")])
            await past(seconds)
            shutil.copytree(before, after)
            post_after = Board()
            post_after.shown_now = dict(post.shown_now)
        async with room(after, post_after, speaker) as opened:
            await past(20.0)
            assert post_after.now == ["five", "six", "seven"]
            assert opened.store.pending() == []

    test()
