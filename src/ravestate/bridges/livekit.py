"""Ravestate inside a LiveKit session: an agent whose words come from rules instead of a language model."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncGenerator
from contextlib import aclosing
from typing import Any

from ravestate.errors import PlatformError, RavestateError

from .port import AnyAgent, Conversation, Utterance, contexts_of

try:
    from livekit.agents import (
        Agent,
        ConversationItemAddedEvent,
        ErrorEvent,
        FlushSentinel,
        ModelSettings,
        UserInputTranscribedEvent,
        UserStateChangedEvent,
        llm,
    )
except ImportError as error:
    raise PlatformError("ravestate.bridges.livekit needs LiveKit: pip install 'ravestate[livekit]'") from error

log = logging.getLogger("ravestate.livekit")


class RavestateAgent(Agent):
    """A LiveKit agent that answers with a Ravestate agent instead of a language model.

    The session needs no ``llm``. The agent may also speak unasked. LiveKit's preemptive generation is off, because it
    would send words to the agent before the user has finished.

    Args:
        agent: The Ravestate agent; see `AnyAgent`.
        options: The arguments of LiveKit's `Agent` other than ``instructions`` and ``llm``, such as ``tts``.

    Raises:
        DeclarationErrors: The modules or the settings have faults.
        DeclarationError: The agent can neither hear nor speak.
        UsageError: There is no such module, or the agent file has mistakes.

    Example:
        ```python
        await AgentSession(stt=stt, vad=vad, tts=tts).start(RavestateAgent(policy), room=job.room)
        ```
    """

    def __init__(self, agent: AnyAgent, **options: Any) -> None:
        turns: Any = {**options.pop("turn_handling", {}), "preemptive_generation": {"enabled": False}}
        super().__init__(instructions="", llm=_NoModel(), turn_handling=turns, **options)
        self._contexts = contexts_of(agent)
        self._conversation: Conversation | None = None
        self._watching: asyncio.Task[None] | None = None
        self._known: set[str] = set()  # the ids of messages that the agent has heard, or that are older than the agent

    async def on_enter(self) -> None:
        """Start the agent."""
        self._known |= {item.id for item in self.chat_ctx.items}  # ignore messages from before the agent's start
        await self._begun()

    async def on_exit(self) -> None:
        """Stop the agent immediately, because the session no longer speaks the agent's words."""
        conversation, self._conversation = self._conversation, None
        if self._watching is not None:
            self._watching.cancel()
        if conversation is not None:
            await conversation.end(at_once=True)

    async def llm_node(
        self, chat_ctx: llm.ChatContext, tools: list[llm.Tool], model_settings: ModelSettings
    ) -> AsyncGenerator[str | FlushSentinel, None]:
        """Tell the agent what the user has said, and yield its answer."""
        words = self._new_words(chat_ctx)
        if not words:  # LiveKit asks for a reply, although the user has said nothing
            return
        conversation = await self._begun()
        gap = ""
        async with aclosing(conversation.answer(words)) as answer:
            async for utterance in answer:
                async for piece in utterance:
                    yield gap + piece
                    gap = ""
                yield FlushSentinel()  # speak now: the rest of the answer may take long
                gap = " "

    async def _begun(self) -> Conversation:
        """Return the conversation. The first call begins it."""
        if self._conversation is None:
            self._conversation = Conversation(self._contexts(), self._say, "livekit")
            self.session.on("conversation_item_added", self._notice)
            self.session.on("user_state_changed", self._notice)
            self.session.on("user_input_transcribed", self._notice)
            await self._conversation.begin()
            self._watching = asyncio.create_task(self._watch(self._conversation))
        return self._conversation

    def _say(self, utterance: Utterance) -> None:
        """Say an utterance that LiveKit has not asked for."""
        if self._conversation is None:
            return
        try:
            self.session.say(utterance)
        except RuntimeError as error:  # the session is closing, or has no voice
            log.warning("LiveKit does not say the agent's words: %s", error)

    async def _watch(self, conversation: Conversation) -> None:
        """End the session when the agent wants to leave, or has failed."""
        failure = None
        try:
            await conversation.until_agent_leaves()
        except RavestateError as error:
            failure = error
            log.error("the agent has failed: %s", failure)
            self.session.emit("error", ErrorEvent(error=failure, source=self))
        self.session.shutdown(drain=failure is None)

    def _notice(self, event: ConversationItemAddedEvent | UserStateChangedEvent | UserInputTranscribedEvent) -> None:
        """Tell the agent which of its words the user has heard, or that the user is speaking."""
        if self._conversation is None:  # the session has switched to another agent
            return
        match event:
            case ConversationItemAddedEvent(item=llm.ChatMessage(role="assistant") as message):
                self._conversation.heard(message.text_content or "")  # after an interruption, only the words before it
            case UserStateChangedEvent(new_state="speaking"):
                self._conversation.notice_speech()
            case UserInputTranscribedEvent(is_final=False):
                self._conversation.notice_speech(event.transcript)
            case _:
                pass

    def _new_words(self, context: llm.ChatContext) -> str:
        """Return the user's words since the last call."""
        said = [item for item in context.items if isinstance(item, llm.ChatMessage) and item.role == "user"]
        words = [item.text_content or "" for item in said if item.id not in self._known]
        self._known |= {item.id for item in said}
        return " ".join(words).strip()


class _NoModel(llm.LLM[Any]):
    """A model that never answers. Without a model, LiveKit would not call `llm_node`."""

    @property
    def model(self) -> str:
        return "rules"

    @property
    def provider(self) -> str:
        return "ravestate"

    def chat(self, **_: Any) -> llm.LLMStream:
        raise RuntimeError("RavestateAgent has no language model to chat with: its method llm_node answers")
