"""Tests of `RavestateProcessor` with Pipecat's own tools. They run in Pipecat's environment: see `apart.py`."""

import asyncio
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import agents
import pytest
from pipecat.frames.frames import (
    CancelWorkerFrame,
    EagerEndOfTurnCancelFrame,
    EndFrame,
    EndWorkerFrame,
    ErrorFrame,
    Frame,
    InterimTranscriptionFrame,
    InterruptionFrame,
    LLMContextAssistantTurnFrame,
    LLMContextFrame,
    LLMContextUserTurnFrame,
    LLMFullResponseEndFrame,
    LLMFullResponseStartFrame,
    LLMTextFrame,
    OutputTransportMessageFrame,
    ProposedUserStartedSpeakingFrame,
    ProposedUserStoppedSpeakingFrame,
    TranscriptionFrame,
    UserStartedSpeakingFrame,
)
from pipecat.observers.base_observer import BaseObserver, FrameProcessed, FramePushed
from pipecat.pipeline.pipeline import Pipeline
from pipecat.processors.aggregators.llm_context import LLMContext
from pipecat.processors.aggregators.llm_response_universal import LLMContextAggregatorPair, LLMUserAggregatorParams
from pipecat.processors.frame_processor import FrameDirection, FrameProcessor
from pipecat.tests import utils
from pipecat.turns.user_start import ExternalUserTurnStartStrategy
from pipecat.turns.user_stop import ExternalUserTurnStopStrategy
from pipecat.turns.user_turn_strategies import UserTurnStrategies
from pipecat_sound import Loudspeaker, Voice

import ravestate as rs
from ravestate.bridges.pipecat import RavestateProcessor
from ravestate.bridges.port import AnyAgent
from ravestate.errors import DeclarationError, EngineError
from ravestate.modules import rawio

RESPONSE = [LLMFullResponseStartFrame, LLMTextFrame, LLMFullResponseEndFrame]


def said(text: str) -> TranscriptionFrame:
    return TranscriptionFrame(text, user_id="ada", timestamp="now")


def texts(frames: Sequence[Frame]) -> list[str]:
    return [frame.text for frame in frames if isinstance(frame, LLMTextFrame)]


def kinds(frames: Sequence[Frame]) -> list[type[Frame]]:
    return [type(frame) for frame in frames]


async def run_pipeline(processor: FrameProcessor, **options: Any) -> tuple[list[Frame], list[Frame]]:
    """Run Pipecat's `run_test`, with long timeouts; return the frames that went downstream and upstream."""
    async with asyncio.timeout(60):
        down, up = await utils.run_test(processor, start_timeout=60, **options)
    return [f for f in down if not isinstance(f, EndFrame)], [f for f in up if not isinstance(f, EndWorkerFrame)]


async def send(processor: FrameProcessor, frame: Frame) -> None:
    """Queue a frame for a processor. An `EndWorkerFrame` asks the pipeline to end."""
    if isinstance(frame, (EndWorkerFrame, CancelWorkerFrame)):
        await processor.push_frame(frame, FrameDirection.UPSTREAM)
    else:
        await processor.queue_frame(frame)


class Reaction(BaseObserver):
    """An observer that queues frames for a processor as soon as the processor has pushed a certain text."""

    def __init__(self, processor: FrameProcessor, text: str, frames: Sequence[Frame]) -> None:
        super().__init__()
        self.processor, self.text, self.frames = processor, text, list(frames)

    async def on_push_frame(self, data: FramePushed) -> None:
        if isinstance(data.frame, LLMTextFrame) and data.frame.text == self.text:
            while self.frames:
                await send(self.processor, self.frames.pop(0))


async def run(
    agent: AnyAgent, *frames: Frame, after: dict[str, Sequence[Frame]] | None = None, **options: Any
) -> tuple[list[Frame], list[Frame]]:
    """Send frames through a processor; return the frames that went downstream and upstream.

    `after` maps a text to more frames. When the processor has pushed the text, send these frames and end the pipeline.
    """
    processor = RavestateProcessor(agent)
    if after:
        options |= {"send_end_frame": False}
        options |= {"observers": [Reaction(processor, text, [*more, EndWorkerFrame()]) for text, more in after.items()]}
    return await run_pipeline(processor, frames_to_send=frames, **options)


# ------------------------------------------------------------------------------------------- answers


async def test_an_answer_has_the_same_frames_as_a_language_models() -> None:
    down, up = await run(agents.echo, said("hello"), expected_down_frames=RESPONSE)
    assert texts(down) == ["You said hello"]
    assert up == []


async def test_an_answer_in_pieces_is_one_response() -> None:
    down, _ = await run(agents.talker, said("count"))
    assert kinds(down) == [LLMFullResponseStartFrame, *[LLMTextFrame] * 3, LLMFullResponseEndFrame]
    assert "".join(texts(down)) == "One, two, three."


async def test_a_filler_and_the_answer_are_two_responses() -> None:
    down, _ = await run(agents.two_part, said("what is the capital of Peru?"), expected_down_frames=RESPONSE * 2)
    assert texts(down) == ["Let me think.", "It is Lima."]


async def test_the_pipeline_does_not_wait_for_an_agent_that_does_not_answer() -> None:
    down, up = await run(agents.silent, said("hello"), said("hello?"))
    assert (down, up) == ([], [])


async def test_each_user_message_of_an_llm_context_is_answered_once() -> None:
    context = LLMContext([{"role": "developer", "content": "Be kind."}, {"role": "user", "content": "one"}])
    later = LLMContext(
        [
            *context.get_messages(),
            {"role": "assistant", "content": "You said one"},
            {"role": "user", "content": "what is"},
            {"role": "user", "content": [{"type": "text", "text": "the time?"}]},
        ]
    )
    down, _ = await run(agents.echo, *map(LLMContextFrame, (context, context, later, later)))
    assert texts(down) == ["You said one", "You said what is the time?"]


async def test_the_processor_passes_other_frames_on() -> None:
    down, _ = await run(
        agents.echo, OutputTransportMessageFrame(message={}), expected_down_frames=[OutputTransportMessageFrame]
    )
    assert len(down) == 1


# ------------------------------------------------------------------------------------------- interruption


async def test_an_interruption_cuts_the_response_and_cancels_the_rule() -> None:
    down, _ = await run(agents.talker, said("wait"), after={"two, ": [InterruptionFrame(), said("count")]})
    once = [LLMFullResponseStartFrame, LLMTextFrame, LLMTextFrame, LLMFullResponseEndFrame]
    again = [LLMFullResponseStartFrame, *[LLMTextFrame] * 3, LLMFullResponseEndFrame]
    assert kinds(down) == [*once, InterruptionFrame, *again]
    assert texts(down) == ["One, ", "two, ", "One, ", "two, ", "three."]  # no "…", because the response was cut


async def test_new_words_interrupt_a_rule_without_an_interruption_frame() -> None:
    down, _ = await run(agents.talker, said("wait"), after={"two, ": [said("count")]})
    assert texts(down) == ["One, ", "two, ", "…", "One, ", "two, ", "three."]


async def test_a_pipeline_still_ends_if_an_interruption_comes_while_it_is_ending() -> None:
    processor = RavestateProcessor(agents.talker)
    reaction = Reaction(processor, "two, ", [InterruptionFrame()])
    down, _ = await run_pipeline(processor, frames_to_send=[said("wait")], observers=[reaction])
    assert texts(down) == ["One, ", "two, "]


async def test_an_interruption_drops_all_waiting_utterances() -> None:
    down, _ = await run(
        agents.talker, said("wait"), after={"One, ": [said("count"), InterruptionFrame(), said("count")]}
    )
    assert "".join(texts(down)).endswith("One, two, three.")


# ------------------------------------------------------------------------------------------- with aggregators


async def converse(
    agent: AnyAgent, *turns: list[Frame], barge_in: str = "", voice: Sequence[FrameProcessor] = ()
) -> list[tuple[str, str]]:
    """Hold a conversation in a pipeline with aggregators; return Pipecat's record of the speakers and their utterances.

    The user's next turn begins when the agent's turn is over. It begins earlier if the agent says the piece `barge_in`,
    or if the loudspeaker stops.

    Args:
        agent: The agent.
        turns: The frames of each turn of the user.
        barge_in: The user interrupts the agent when it says this piece.
        voice: A voice and a loudspeaker; none for a conversation in text.
    """
    context = LLMContext()
    strategies = UserTurnStrategies(
        start=[ExternalUserTurnStartStrategy(enable_interruptions=True)], stop=[ExternalUserTurnStopStrategy(timeout=0)]
    )
    pair = LLMContextAggregatorPair(context, user_params=LLMUserAggregatorParams(user_turn_strategies=strategies))
    rest = [*turns[1:], [EndWorkerFrame()]]
    processor = RavestateProcessor(agent)

    class Turns(BaseObserver):
        async def on_process_frame(self, data: FrameProcessed) -> None:
            if (
                data.processor is pair.assistant()
                and isinstance(data.frame, LLMTextFrame)
                and data.frame.text == barge_in
            ):
                await send(pair.user(), rest[0].pop(0))  # the user begins to speak

        async def on_push_frame(self, data: FramePushed) -> None:
            over = data.source is processor and isinstance(data.frame, LLMContextAssistantTurnFrame)
            # When this frame goes upstream, the processor knows that the agent's turn is over.
            if over and data.direction is FrameDirection.UPSTREAM:
                for frame in rest.pop(0):
                    await send(pair.user(), frame)

    async def interrupt() -> None:
        for each in voice:
            if isinstance(each, Loudspeaker):
                await each.stopped.wait()
                await send(pair.user(), rest[0].pop(0))

    interrupting = asyncio.create_task(interrupt())
    pipeline = Pipeline([pair.user(), processor, *voice, pair.assistant()])
    await run_pipeline(pipeline, frames_to_send=turns[0], send_end_frame=False, observers=[Turns()])
    interrupting.cancel()
    return [(str(message["role"]), str(message["content"])) for message in context.get_messages()]


def turn(text: str) -> list[Frame]:
    return [ProposedUserStartedSpeakingFrame(), said(text), ProposedUserStoppedSpeakingFrame()]


async def test_a_pipeline_with_aggregators_keeps_the_conversation() -> None:
    assert await converse(agents.echo, turn("hello"), turn("goodbye")) == [
        ("user", "hello"),
        ("assistant", "You said hello"),
        ("user", "goodbye"),
        ("assistant", "You said goodbye"),
    ]


async def test_the_agent_knows_what_the_user_heard() -> None:
    talk = await converse(agents.listener, turn("hello"), turn("and now?"))
    assert talk[1] == ("assistant", "heard '', captions '', speech 1")
    assert talk[3] == ("assistant", f"heard {talk[1][1]!r}, captions '', speech 2")


async def test_the_agent_knows_what_the_user_heard_of_an_interrupted_utterance() -> None:
    talk = await converse(agents.interrupted, turn("wait"), turn("what did I hear?"), barge_in="two, ")
    assert talk[1:] == [
        ("assistant", "One, two,"),
        ("user", "what did I hear?"),
        ("assistant", "You heard 'One, two,'"),
    ]


async def test_a_voice_speaks_the_answers() -> None:
    loudspeaker = Loudspeaker()
    talk = await converse(agents.counter, turn("count"), turn("what did I hear?"), voice=[Voice(), loudspeaker])
    # A voice gets each sentence without the spaces around it.
    assert loudspeaker.played == "One.Two.Three.You heard One.Two.Three."
    assert talk[1] == ("assistant", "One. Two. Three.")


async def test_an_interruption_stops_the_voice_and_the_agent_knows_what_the_user_heard() -> None:
    loudspeaker = Loudspeaker()
    loudspeaker.most = len("One.Tw")
    talk = await converse(agents.counter, turn("count"), turn("what did I hear?"), voice=[Voice(), loudspeaker])
    assert loudspeaker.played == "One.TwYou heard One."
    assert talk[1:] == [("assistant", "One."), ("user", "what did I hear?"), ("assistant", "You heard One.")]


async def test_the_agent_notices_that_the_user_speaks() -> None:
    interim = InterimTranscriptionFrame("and n", user_id="ada", timestamp="now")
    down, _ = await run(agents.listener, UserStartedSpeakingFrame(), interim, said("and now?"))
    assert texts(down) == ["heard '', captions 'and n', speech 2"]


async def test_a_speculative_turn_reaches_the_agent_only_after_its_confirmation() -> None:
    guess = LLMContextFrame(LLMContext([{"role": "user", "content": "how are you?"}]), speculation=True)
    wrong = LLMContextFrame(LLMContext([{"role": "user", "content": "how"}]), speculation=True)
    confirmed = LLMContextUserTurnFrame(text="how are you?", timestamp="now")
    down, _ = await run(agents.echo, wrong, EagerEndOfTurnCancelFrame(), guess, confirmed)
    assert texts(down) == ["You said how are you?"]


# ------------------------------------------------------------------------------------------- beginning and end


async def test_the_agent_greets_its_user_and_says_goodbye() -> None:
    down, _ = await run(agents.host)
    assert texts(down) == ["Welcome!", "Goodbye!"]


async def test_an_agent_can_speak_unprompted_and_end_the_pipeline() -> None:
    down, up = await run(agents.leaver, send_end_frame=False)
    assert texts(down) == ["I have to go."]
    assert up == []


@pytest.mark.parametrize("words", ["hello", "go on"])
async def test_a_rule_that_fails_does_not_hang_the_pipeline(words: str) -> None:
    down, _ = await run(agents.broken, said(words))
    assert kinds(down) == ([] if words == "hello" else RESPONSE)


async def test_a_failed_agent_raises_a_pipeline_error() -> None:
    _, up = await run(agents.hopeless, said("hello"))
    errors = [frame for frame in up if isinstance(frame, ErrorFrame)]
    assert [error.error for error in errors] == ["the library has burnt down"]
    assert isinstance(errors[0].processor, RavestateProcessor)
    assert not errors[0].processor.is_usable


async def test_a_cancelled_pipeline_stops_the_agent() -> None:
    context = rs.Context(agents.talker)
    processor = RavestateProcessor(context)
    reaction = Reaction(processor, "two, ", [CancelWorkerFrame()])
    await run_pipeline(processor, frames_to_send=[said("wait")], send_end_frame=False, observers=[reaction])
    with pytest.raises(EngineError, match="ended"):
        await context.next(rawio.output.changed)


async def test_many_simultaneous_sessions_stay_separate() -> None:
    policy = rs.compile(agents.echo, agents.listener)
    talks = await asyncio.gather(*(run(policy, said(f"{n}"), said(f"{n}, {n}")) for n in range(40)))
    for n, (down, _) in enumerate(talks):
        assert texts(down) == [f"You said {n}", f"You said {n}, {n}"]


@pytest.mark.parametrize("form", ["file", "module", "several", "policy", "context"])
async def test_the_agent_can_be_a_file_a_module_a_list_a_policy_or_a_context(form: str, tmp_path: Path) -> None:
    file = tmp_path / "agent.yaml"
    file.write_text("modules: [hibye]\n")
    forms: dict[str, AnyAgent] = {
        "file": file,
        "module": agents.host,
        "several": [agents.host, agents.echo],
        "policy": rs.compile(agents.host),
        "context": rs.Context(agents.host, seed=3),
    }
    down, _ = await run(forms[form], said("hello"))
    assert texts(down)


def test_an_agent_without_rawio_is_refused() -> None:
    with pytest.raises(DeclarationError, match="rawio"):
        RavestateProcessor(rs.Module("deaf"))
