"""Ravestate inside a Pipecat pipeline: a processor that stands where the language model would."""

from __future__ import annotations

import asyncio
from typing import Any

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
    """A processor that answers with a Ravestate agent, in the place of a language model.

    It takes the user's words from a user aggregator's `LLMContextFrame`, or from each `TranscriptionFrame` where there is
    no aggregator. It pushes each utterance of the agent, asked for or not, as the frames of a language model's response.

    Args:
        agent: The agent; see `AnyAgent`.
        options: The arguments of `FrameProcessor`, such as ``name``.

    Raises:
        DeclarationErrors: The modules or the settings have faults.
        DeclarationError: The agent can neither hear nor speak.

    Example:
        ```python
        Pipeline([transport.input(), stt, user, RavestateProcessor(policy), tts, transport.output(), assistant])
        ```
    """

    def __init__(self, agent: AnyAgent, **options: Any) -> None:
        super().__init__(**options)
        self._utterances: asyncio.Queue[Utterance] = asyncio.Queue()
        self._conversation = Conversation(contexts_of(agent)(), self._utterances.put_nowait, "pipecat")
        self._tasks: list[asyncio.Task[None]] = []  # until cleanup
        self._taken: object = None  # the last message of the user that the agent has heard
        self._guessed = False  # whether the last words may not be the user's whole turn

    async def process_frame(self, frame: Frame, direction: FrameDirection) -> None:
        """Tell the agent what a frame means for it, and pass the frame on unless it is meant for a language model."""
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
            case LLMContextUserTurnFrame() if self._guessed:  # the guess was right
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
                await self._utterances.join()  # the end of the interrupted response goes before the interruption
            case EndFrame():
                await conversation.end()
                await self._utterances.join()
            case _:
                pass
        await self.push_frame(frame, direction)

    async def cleanup(self) -> None:
        """Stop the agent, if the pipeline was cancelled instead of ended."""
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
        """End the pipeline when the agent wants to leave; if it has failed, leave the decision to the pipeline."""
        try:
            await self._conversation.until_agent_leaves()
            await self.push_frame(EndWorkerFrame(), FrameDirection.UPSTREAM)
        except RavestateError as failure:
            await self.push_error(str(failure), exception=failure, force_treat_as_permanent=True)

    def _new_words(self, context: LLMContext) -> str:
        """Return what the user has said since the last call; the framework may cut a sentence into several messages."""
        words: list[str] = []
        messages = context.get_messages()
        for message in reversed(messages):
            if message is self._taken or not isinstance(message, dict) or message["role"] != "user":
                break
            content = message["content"]
            parts = [content] if isinstance(content, str) else [p["text"] for p in content if p["type"] == "text"]
            words[:0] = parts
        self._taken = messages[-1] if messages else None
        return " ".join(words)
