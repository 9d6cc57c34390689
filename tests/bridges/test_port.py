"""The part that all bridges share (``bridges/port.py``), in virtual time."""

import asyncio
from collections.abc import Awaitable, Callable
from contextlib import aclosing
from pathlib import Path

import pytest

import ravestate as rs
from ravestate.bridges.port import FAREWELL, LONGEST, Conversation, Utterance, contexts_of
from ravestate.errors import DeclarationError, DeclarationErrors, UsageError
from ravestate.modules import interloc, rawio
from ravestate.runtime.agent import Agent
from ravestate.testing.virtual_loop import VirtualLoop

echo = rs.Module("echo", requires=[rawio])


@echo.rule(when=rawio.input.changed, writes=rawio.output)
async def repeat(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = ctx.payload(rawio.input.changed).upper()


talker = rs.Module("talker", requires=[rawio])


@talker.rule(when=rawio.input.changed, writes=rawio.output, emits=rawio.piece, until=rawio.input.changed)
async def talk(ctx: rs.RuleContext) -> None:
    """Say "one" and "two", 1 s apart."""
    ctx.emit(rawio.piece, "one ")
    await ctx.sleep(1)
    ctx.emit(rawio.piece, "two")
    ctx[rawio.output] = "one two"


stubborn = rs.Module("stubborn", requires=[rawio])


@stubborn.rule(when=rawio.input.changed, writes=rawio.output, emits=rawio.piece)
async def insist(ctx: rs.RuleContext) -> None:
    """Say the same as `talk`, but as a rule that new input does not interrupt."""
    ctx.emit(rawio.piece, "one ")
    await ctx.sleep(1)
    ctx.emit(rawio.piece, "two")
    ctx[rawio.output] = "one two"


Talk = Callable[[Conversation, list[Utterance]], Awaitable[None]]


def converse(talk: Talk, *modules: rs.Module) -> None:
    """Run a test in virtual time. The test gets a conversation, and a list of the utterances outside of `answer`."""

    async def main() -> None:
        spoken: list[Utterance] = []
        conversation = Conversation(rs.Context(*modules), spoken.append, "test")
        await conversation.begin()
        try:
            await talk(conversation, spoken)
        finally:
            await conversation.end()

    with asyncio.Runner(loop_factory=VirtualLoop) as runner:
        runner.run(main())


async def past(seconds: float) -> None:
    """Wait for some seconds of virtual time."""
    over = asyncio.get_running_loop().create_future()
    asyncio.get_running_loop().call_later(seconds, over.set_result, None)
    await over


async def text(utterance: Utterance) -> str:
    """Wait for the end of an utterance; return its pieces, joined by "|"."""
    return "|".join([piece async for piece in utterance])


async def answer(conversation: Conversation, words: str) -> list[str]:
    return [await text(utterance) async for utterance in conversation.answer(words)]


# ------------------------------------------------------------------------------------------- utterances


def test_an_utterance_yields_its_pieces_and_no_piece_after_its_end() -> None:
    async def main() -> None:
        utterance = Utterance()
        for piece in ("a", "", "b"):
            utterance.grow(piece)
        utterance.end()
        utterance.grow("c")
        assert (await text(utterance), await text(utterance), utterance.text) == ("a|b", "", "abc")

    asyncio.run(main())


def test_pieces_and_an_output_with_the_same_text_are_one_utterance() -> None:
    async def talk(conversation: Conversation, spoken: list[Utterance]) -> None:
        assert await answer(conversation, "count") == ["one |two"]
        assert spoken == []

    converse(talk, talker)


def test_an_output_without_the_last_space_of_its_pieces_is_not_said_again() -> None:
    module = rs.Module("module", requires=[rawio])

    @module.rule(when=rawio.input.changed, writes=rawio.output, emits=rawio.piece)
    async def count(ctx: rs.RuleContext) -> None:
        for piece in ("one ", "two "):
            ctx.emit(rawio.piece, piece)
        ctx[rawio.output] = "one two"

    async def talk(conversation: Conversation, _: list[Utterance]) -> None:
        assert await answer(conversation, "count") == ["one |two "]

    converse(talk, module)


def test_an_output_that_differs_from_its_pieces_is_a_separate_utterance() -> None:
    module = rs.Module("module", requires=[rawio])

    @module.rule(when=rawio.input.changed, writes=rawio.output, emits=rawio.piece)
    async def stumble(ctx: rs.RuleContext) -> None:
        ctx.emit(rawio.piece, "uh")
        ctx[rawio.output] = "Hello"

    async def talk(conversation: Conversation, _: list[Utterance]) -> None:
        assert sorted(await answer(conversation, "hi")) == ["Hello", "uh"]

    converse(talk, module)


def test_a_rule_that_fails_ends_its_utterance() -> None:
    module = rs.Module("module", requires=[rawio])

    @module.rule(when=rawio.input.changed, writes=rawio.output, emits=rawio.piece)
    async def fail(ctx: rs.RuleContext) -> None:
        ctx.emit(rawio.piece, "I know")
        raise OSError

    async def talk(conversation: Conversation, _: list[Utterance]) -> None:
        assert await answer(conversation, "who?") == ["I know"]
        assert await answer(conversation, "who?") == ["I know"]

    converse(talk, module)


def test_an_utterance_outside_of_an_answer_goes_to_the_speak_function() -> None:
    async def talk(conversation: Conversation, spoken: list[Utterance]) -> None:
        conversation.hear("hello")
        await conversation.context.quiet()
        assert [await text(utterance) for utterance in spoken] == ["HELLO"]

    converse(talk, echo)


def test_a_second_answer_waits_for_the_first() -> None:
    async def talk(conversation: Conversation, spoken: list[Utterance]) -> None:
        both = await asyncio.gather(answer(conversation, "a"), answer(conversation, "b"))
        assert both == [["one |two"], ["one |two"]]
        assert conversation.context.now == 2

    converse(talk, talker)


def test_blank_input_does_not_reach_the_agent() -> None:
    async def talk(conversation: Conversation, spoken: list[Utterance]) -> None:
        assert await answer(conversation, " \n") == []
        assert conversation.context.read(rawio.input) == ""

    converse(talk, echo)


# ------------------------------------------------------------------------------------------- interruption


def test_closing_an_answer_interrupts_the_agent() -> None:
    async def talk(conversation: Conversation, spoken: list[Utterance]) -> None:
        async with aclosing(conversation.answer("count")) as utterances:
            async for utterance in utterances:
                assert await anext(utterance) == "one "
                break
        await conversation.context.quiet()
        assert conversation.context.now == 0  # the rule was cancelled
        assert await text(utterance) == ""
        assert await answer(conversation, "again") == ["one |two"]

    converse(talk, talker)


@pytest.mark.parametrize("module", [talker, stubborn])
def test_an_interrupted_utterance_gets_no_more_pieces(module: rs.Module) -> None:
    async def talk(conversation: Conversation, spoken: list[Utterance]) -> None:
        conversation.hear("count")
        await past(0.5)
        conversation.interrupt()
        await past(5)
        assert [await text(utterance) for utterance in spoken] == ["one "]
        assert await answer(conversation, "again") == ["one |two"]

    converse(talk, module)


def test_the_agent_answers_words_that_come_right_after_an_interruption() -> None:
    async def talk(conversation: Conversation, spoken: list[Utterance]) -> None:
        conversation.hear("count")
        await past(0.5)
        conversation.interrupt()
        assert await answer(conversation, "again") == ["one |two"]

    converse(talk, talker)


# ------------------------------------------------------------------------------------------- beginning and end


def test_the_user_is_added_at_the_beginning_and_removed_at_the_end() -> None:
    seen: list[list[str]] = []
    module = rs.Module("module", requires=[interloc, rawio])

    @module.rule(when=interloc.users.changed.detached(), reads=interloc.users)
    async def look(ctx: rs.RuleContext) -> None:
        seen.append([key[:5] for key in ctx[interloc.users]])

    async def talk(conversation: Conversation, spoken: list[Utterance]) -> None:
        await conversation.begin()  # the second call does nothing
        await conversation.end()
        await conversation.end()

    converse(talk, module)
    assert seen == [["test-"], []]


def test_ending_waits_for_an_answer_and_a_farewell_up_to_a_limit() -> None:
    module = rs.Module("module", requires=[interloc, rawio])

    @module.rule(when=rawio.input.changed | interloc.users.removed, writes=rawio.output)
    async def hang(ctx: rs.RuleContext) -> None:
        await asyncio.Event().wait()

    async def talk(conversation: Conversation, spoken: list[Utterance]) -> None:
        conversation.hear("hello")
        loop = asyncio.get_running_loop()
        await conversation.end()
        assert LONGEST + FAREWELL <= loop.time() <= LONGEST + 2 * FAREWELL

    converse(talk, module)


@pytest.mark.parametrize("whole", ["I think so.", "I think so. ", "I think so. Yes."])
def test_a_later_output_completes_the_utterance_of_its_pieces(whole: str) -> None:
    writer = rs.Module("writer", requires=[rawio])

    @writer.rule(when=rawio.input.changed, writes=rawio.output, emits=rawio.piece)
    async def write(ctx: rs.RuleContext) -> None:
        for piece in ("I ", "think ", "so. "):
            ctx.emit(rawio.piece, piece)
        await ctx.sleep(1)
        ctx[rawio.output] = whole

    async def talk(conversation: Conversation, spoken: list[Utterance]) -> None:
        conversation.hear("Is it?")
        await past(5)
        [utterance] = spoken
        assert (await text(utterance)).replace("|", "").strip() == whole.strip()

    converse(talk, writer)


def test_ending_immediately_does_not_wait_for_utterances() -> None:
    async def talk(conversation: Conversation, spoken: list[Utterance]) -> None:
        conversation.hear("count")
        await conversation.end(at_once=True)
        assert asyncio.get_running_loop().time() == 0
        assert [await text(utterance) for utterance in spoken] == ["one "]

    converse(talk, talker)


def test_the_method_until_agent_leaves_returns_only_if_the_agent_itself_ends_the_conversation() -> None:
    module = rs.Module("module", requires=[rawio])

    @module.rule(when=rawio.input.changed, writes=rawio.output)
    async def leave(ctx: rs.RuleContext) -> None:
        ctx.stop()

    async def talk(conversation: Conversation, spoken: list[Utterance]) -> None:
        leaving = asyncio.create_task(conversation.until_agent_leaves())
        if conversation.context.policy.rules.get("module:leave"):
            conversation.hear("bye")
            await leaving
        else:
            await conversation.end()
            await past(100)
            assert not leaving.done()
            leaving.cancel()

    converse(talk, module)
    converse(talk, echo)


# ------------------------------------------------------------------------------------------- agents


def test_each_conversation_gets_a_context_of_the_same_policy(tmp_path: Path) -> None:
    (tmp_path / "agent.yml").write_text("modules: [idle]\nsettings: {idle: {bored_after: 7}}\n")
    policy = rs.compile(echo)
    for agent in (
        echo,
        [echo, talker],
        policy,
        Agent(echo),
        tmp_path / "agent.yml",
        str(tmp_path / "agent.yml"),
        "idle",
    ):
        make = contexts_of(agent)
        one, other = make(), make()
        assert one is not other
        assert "rawio:output" in one.policy.slots
    assert contexts_of(policy)().policy.rules.keys() == policy.rules.keys()
    assert contexts_of(tmp_path / "agent.yml")().settings["idle"].bored_after == 7  # type: ignore[attr-defined]


def test_a_given_context_is_used_for_the_conversation() -> None:
    context = rs.Context(echo)
    assert contexts_of(context)() is context


def test_wrong_agents_are_refused_with_a_message(tmp_path: Path) -> None:
    with pytest.raises(DeclarationError, match="requires rawio"):
        contexts_of(rs.Module("deaf"))
    with pytest.raises(UsageError, match="cannot read"):
        contexts_of(tmp_path / "none.yaml")
    with pytest.raises(UsageError, match="no module 'no_such_module'"):
        contexts_of("no_such_module")
    with pytest.raises(DeclarationErrors) as caught:
        contexts_of(42)  # type: ignore[arg-type]
    assert "42" in str(caught.value.exceptions)
