"""Ravestate inside a Pipecat pipeline: a processor that takes the place of the language model."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable
from typing import Any, cast

from ravestate.errors import PlatformError, RavestateError

from .port import AnyAgent, Conversation, Utterance, contexts_of

try:
    from pipecat.frames.frames import (
        EagerEndOfTurnCancelFrame,
        EndFrame,
        EndWorkerFrame,
        Frame,
        InterimTranscriptionFrame,
        InterruptionFrame,
        LLMContextAssistantTurnFrame,
        LLMContextFrame,
        LLMContextUserTurnFrame,
        LLMFullResponseEndFrame,
        LLMFullResponseStartFrame,
        LLMTextFrame,
        StartFrame,
        TranscriptionFrame,
        UserStartedSpeakingFrame,
    )
    from pipecat.processors.aggregators.llm_context import LLMContext
    from pipecat.processors.frame_processor import FrameDirection, FrameProcessor
except ImportError as error:
    raise PlatformError("ravestate.bridges.pipecat needs Pipecat: pip install 'ravestate[pipecat]'") from error


class RavestateProcessor(FrameProcessor):
    """A processor that answers with a Ravestate agent instead of a language model.

    It takes the user's words from the `LLMContextFrame` of a user aggregator, Pipecat's collector of the user's words.
    Without an aggregator, it takes them from each `TranscriptionFrame`. It pushes each utterance of the agent, an
    answer or not, as the frames of a language model's response.

    Args:
        agent: The agent; see `AnyAgent`.
        options: The arguments of `FrameProcessor`, such as ``name``.

    Raises:
        DeclarationErrors: The modules or the settings have faults.
        DeclarationError: The agent can neither hear nor speak.
        UsageError: There is no such module, or the agent file has mistakes.

    Example:
        ```python
        Pipeline([transport.input(), stt, user, RavestateProcessor(policy), tts, transport.output(), assistant])
        ```
    """

    def __init__(self, agent: AnyAgent, **options: Any) -> None:
        super().__init__(**options)
        self._utterances: asyncio.Queue[Utterance] = asyncio.Queue()
        self._conversation = Conversation(contexts_of(agent)(), self._utterances.put_nowait, "pipecat")
        self._tasks: list[asyncio.Task[None]] = []  # they run until `cleanup`
        self._taken: object = None  # the last message of the user that the agent has heard
        self._guessed = False  # whether Pipecat has only guessed that the user's turn is over

    async def process_frame(self, frame: Frame, direction: FrameDirection) -> None:
        """Tell the agent about a frame. Pass it on, except a `TranscriptionFrame` or an `LLMContextFrame`."""
        await super().process_frame(frame, direction)
        conversation = self._conversation
        match frame:
            case TranscriptionFrame():
                conversation.hear(frame.text)
                return
            case LLMContextFrame():
                self._guessed = frame.speculation
                if not frame.speculation:
                    conversation.hear(self._new_words(frame.context))
                return
            case LLMContextUserTurnFrame() if self._guessed:  # Pipecat guessed right: the turn has ended
                self._guessed = False
                conversation.hear(frame.text)
            case EagerEndOfTurnCancelFrame():
                self._guessed = False
            case UserStartedSpeakingFrame():
                conversation.notice_speech()
            case InterimTranscriptionFrame():
                conversation.notice_speech(frame.text)
            case LLMContextAssistantTurnFrame() if direction is FrameDirection.UPSTREAM:
                conversation.heard(frame.text)
            case StartFrame():
                await conversation.begin()
                self._tasks = [self.create_task(self._speak()), self.create_task(self._watch())]
            case InterruptionFrame():
                conversation.interrupt()
                while not self._utterances.empty():
                    self._utterances.get_nowait()
                    self._utterances.task_done()
                await self._utterances.join()  # so that the interrupted response ends before this frame is passed on
            case EndFrame():
                await conversation.end()
                await self._utterances.join()
            case _:
                pass
        await self.push_frame(frame, direction)

    async def cleanup(self) -> None:
        """Stop the agent immediately, unless an `EndFrame` has stopped it already. Then end this processor's tasks."""
        await self._conversation.end(at_once=True)
        for task in self._tasks:
            await self.cancel_task(task)
        await super().cleanup()

    async def _speak(self) -> None:
        """Push the agent's utterances, one after the other."""
        while True:
            utterance = await self._utterances.get()
            await self.push_frame(LLMFullResponseStartFrame())
            async for piece in utterance:
                await self.push_frame(LLMTextFrame(piece))
            await self.push_frame(LLMFullResponseEndFrame())
            self._utterances.task_done()

    async def _watch(self) -> None:
        """End the pipeline when the agent wants to leave. If the agent has failed, report the error to the pipeline."""
        try:
            await self._conversation.until_agent_leaves()
            await self.push_frame(EndWorkerFrame(), FrameDirection.UPSTREAM)
        except RavestateError as failure:
            await self.push_error(str(failure), exception=failure, force_treat_as_permanent=True)

    def _new_words(self, context: LLMContext) -> str:
        """Return the user's words since the last call; the framework may cut a sentence into several messages."""
        words: list[str] = []
        newest = self._taken
        for message in reversed([cast("dict[str, Any]", m) for m in context.get_messages() if isinstance(m, dict)]):
            role = message["role"]
            if message is self._taken or (role != "user" and (words or role != "assistant")):
                break
            if role == "user":  # in the list, the agent's previous message may come after the user's message
                content = message["content"]
                newest = newest if words else message
                words.insert(0, content if isinstance(content, str) else _text_in(content))
        self._taken = newest
        return " ".join(words)


def _text_in(parts: Iterable[dict[str, str]]) -> str:
    """Return the text of a message, which may also have pictures."""
    return " ".join(part["text"] for part in parts if part["type"] == "text")
