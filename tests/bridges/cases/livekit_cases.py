"""Tests of `RavestateAgent` with LiveKit's own tools. They run in LiveKit's environment: see `apart.py`."""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import agents
import pytest
from livekit.agents import AgentSession, ChatContext, ConversationItemAddedEvent
from livekit.agents.llm import ChatMessage
from sound import Loudspeaker, Voice

import ravestate as rs
from ravestate.bridges.livekit import RavestateAgent
from ravestate.bridges.port import AnyAgent
from ravestate.errors import DeclarationError, EngineError, PlatformError
from ravestate.modules import rawio


@asynccontextmanager
async def session_with(agent: AnyAgent, **options: Any) -> AsyncIterator[AgentSession[None]]:
    async with asyncio.timeout(60), AgentSession[None]() as session:
        await session.start(RavestateAgent(agent, **options), record=False)
        yield session


async def answers(session: AgentSession[None], words: str) -> list[str]:
    """Say something as the user; return the agent's answers."""
    result = await session.run(user_input=words)
    return [
        str(event.item.text_content)
        for event in result.events
        if event.type == "message" and event.item.role == "assistant"
    ]


def event_of(session: AgentSession[None], name: Any, fits: Callable[[Any], bool] = bool) -> asyncio.Future[Any]:
    """Return a future for the session's next event of this name for which `fits` is true."""
    found: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
    session.on(name, lambda event: found.set_result(event) if fits(event) and not found.done() else None)
    return found


class Items:
    """The agent's messages in a session, one after the other."""

    def __init__(self, session: AgentSession[None]) -> None:
        self._queue: asyncio.Queue[ChatMessage] = asyncio.Queue()
        session.on("conversation_item_added", self._add)

    def _add(self, event: ConversationItemAddedEvent) -> None:
        if isinstance(event.item, ChatMessage) and event.item.role == "assistant":
            self._queue.put_nowait(event.item)

    async def next(self) -> ChatMessage:
        return await self._queue.get()


# ------------------------------------------------------------------------------------------- answers


async def test_the_agent_answers_the_users_words() -> None:
    async with session_with(agents.echo) as session:
        result = await session.run(user_input="hello")
        result.expect.next_event().is_message(role="assistant")
        result.expect.no_more_events()
        assert await answers(session, "goodbye") == ["You said goodbye"]


async def test_an_answer_in_pieces_is_one_message() -> None:
    async with session_with(agents.talker) as session:
        assert await answers(session, "count") == ["One, two, three."]


async def test_a_filler_and_the_answer_after_it_are_one_message() -> None:
    async with session_with(agents.two_part) as session:
        assert await answers(session, "what is the capital of Peru?") == ["Let me think. It is Lima."]


async def test_the_session_does_not_wait_for_an_agent_that_does_not_answer() -> None:
    async with session_with(agents.silent) as session:
        assert await answers(session, "hello") == []
        assert await answers(session, "hello?") == []


async def test_the_agent_answers_neither_instructions_nor_old_messages() -> None:
    history = ChatContext.empty()
    history.add_message(role="user", content="old")
    async with session_with(agents.echo, chat_ctx=history) as session:
        await session.generate_reply(instructions="Greet the user.")
        result = session.generate_reply(user_input="new", instructions="Be kind.")
        await result
        assert [item.text_content for item in result.chat_items if isinstance(item, ChatMessage)] == ["You said new"]


async def test_two_simultaneous_replies_stay_separate() -> None:
    async with session_with(agents.talker) as session:
        handles = [session.generate_reply(user_input=words) for words in ("count", "count again")]
        for handle in handles:
            await handle
            assert [item.text_content for item in handle.chat_items if isinstance(item, ChatMessage)] == [
                "One, two, three."
            ]


# ------------------------------------------------------------------------------------------- interruption


async def test_an_interruption_cuts_the_answer_and_cancels_the_rule() -> None:
    context = rs.Context(agents.interrupted)
    async with session_with(context) as session:
        items = Items(session)
        speaking = event_of(session, "agent_state_changed", lambda event: event.new_state == "speaking")
        handle = session.generate_reply(user_input="wait")
        await speaking
        await session.interrupt()
        await handle
        assert handle.interrupted
        cut = await items.next()
        assert cut.interrupted
        assert cut.text_content == "One, two, "
        await context.quiet()  # returns once the rule has ended
        assert await answers(session, "what did I hear?") == ["You heard 'One, two, '"]


async def test_the_agent_knows_which_of_its_words_the_user_heard() -> None:
    loudspeaker = Loudspeaker()
    async with asyncio.timeout(60), AgentSession[None]() as session:
        session.output.audio = loudspeaker
        await session.start(RavestateAgent(agents.interrupted, tts=Voice()), record=False)
        items = Items(session)
        assert await answers(session, "count") == ["One, two, three."]
        assert (await items.next()).text_content == "One, two, three."
        loudspeaker.most = len("One, two,")
        # The rule ends immediately, but speaking its words takes longer.
        handle = session.generate_reply(user_input="count again")
        await loudspeaker.stopped.wait()
        await session.interrupt()
        await handle
        assert (await items.next()).text_content == "One, two,"
        loudspeaker.most = 10**6
        loudspeaker.stopped.clear()
        assert await answers(session, "what did I hear?") == ["You heard 'One, two,'"]
    assert loudspeaker.played == ["One, two, three.", "One, two,", "You heard 'One, two,'"]


async def test_many_simultaneous_sessions_stay_separate() -> None:
    policy = rs.compile(agents.echo)

    async def talk(n: int) -> list[str]:
        async with session_with(policy) as session:
            return [*await answers(session, f"{n}"), *await answers(session, f"{n}, {n}")]

    talks = await asyncio.gather(*map(talk, range(20)))
    assert talks == [[f"You said {n}", f"You said {n}, {n}"] for n in range(20)]


# ------------------------------------------------------------------------------------------- beginning and end


async def test_the_agent_greets_its_user() -> None:
    async with session_with(agents.host) as session:
        assert (await Items(session).next()).text_content == "Welcome!"


async def test_an_agent_can_speak_unprompted_and_end_the_session() -> None:
    async with session_with(agents.leaver) as session:
        items, closed = Items(session), event_of(session, "close")
        assert (await items.next()).text_content == "I have to go."
        assert (await closed).error is None


@pytest.mark.parametrize("words", ["hello", "go on"])
async def test_a_rule_that_fails_does_not_hang_the_session(words: str) -> None:
    async with session_with(agents.broken) as session:
        for _ in range(2):
            assert await answers(session, words) == ([] if words == "hello" else ["I know that"])


async def test_a_failed_agent_ends_the_session_with_an_error() -> None:
    async with session_with(agents.hopeless) as session:
        error, closed = event_of(session, "error"), event_of(session, "close")
        assert await answers(session, "hello") == []
        await closed
        assert isinstance((await error).error, PlatformError)
        assert str((await error).error) == "the library has burnt down"


async def test_the_end_of_the_session_stops_the_agent() -> None:
    context = rs.Context(agents.talker)
    async with session_with(context) as session:
        session.generate_reply(user_input="wait")
        await context.next(rawio.piece)
    with pytest.raises(EngineError, match="ended"):
        await context.next(rawio.output.changed)


async def test_the_end_of_the_session_does_not_wait_for_an_unfinished_utterance() -> None:
    slow, begun, said = rs.Module("slow", requires=[rawio]), asyncio.Event(), list[str]()

    @slow.rule(when=rs.startup, writes=rawio.output)
    async def greet(ctx: rs.RuleContext) -> None:
        begun.set()
        await ctx.sleep(3)
        said.append("Hello")
        ctx[rawio.output] = "Hello"

    async with session_with(slow):
        await begun.wait()
    assert said == []


@pytest.mark.parametrize("form", ["file", "module", "several", "policy", "context"])
async def test_the_agent_can_be_a_file_a_module_a_list_a_policy_or_a_context(form: str, tmp_path: Path) -> None:
    file = tmp_path / "agent.yaml"
    (tmp_path / "parrot.py").write_text("from agents import echo\n")
    file.write_text("modules: [./parrot.py]\n")
    forms: dict[str, AnyAgent] = {
        "file": file,
        "module": agents.echo,
        "several": [agents.echo, agents.listener],
        "policy": rs.compile(agents.echo),
        "context": rs.Context(agents.echo, seed=3),
    }
    async with session_with(forms[form]) as session:
        assert await answers(session, "hello") == ["You said hello"]


def test_an_agent_without_rawio_is_refused() -> None:
    with pytest.raises(DeclarationError, match="rawio"):
        RavestateAgent(rs.Module("deaf"))
