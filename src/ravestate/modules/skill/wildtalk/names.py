"""The names of `wildtalk`: its settings, its module, its slots and its signal."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime
from pathlib import Path
from typing import Annotated, Literal

from pydantic import ConfigDict, Field, SecretStr

import ravestate as rs
from ravestate.language.chat import Backend, Message
from ravestate.modules import interloc, nlp, rawio
from ravestate.settings import NameOrPath

from .history import EXAMPLES, PERSONA
from .listening.state import Overheard, State

Seconds = Annotated[float, Field(gt=0)]

OLLAMA = "http://localhost:11434/v1"
"""The address that the backend ``openai`` uses if the search finds no server on this machine."""


class Settings(rs.Settings):
    """The choice of the language model, its persona, and the limits of an answer."""

    model_config = ConfigDict(protected_namespaces=())  # otherwise, pydantic reserves the name `model_path`

    backend: Literal["auto", "openai", "gguf", "transformers", "listen"] = "auto"
    """``openai``: a server that speaks OpenAI's protocol; ``gguf``: a model file on this machine; ``transformers``: a model in
    the format of Hugging Face; ``listen``: no model. ``auto`` chooses by what this machine has."""
    search: bool = True
    """Whether to look for servers on this machine's usual ports, and for models in the user's folders."""
    model: NameOrPath | None = None
    """openai: the model's name on the server; gguf: the name (``ravestate model list``) or path of a file;
    transformers: a folder or a name on the hub of Hugging Face, by default gpt2."""
    model_path: Path | None = None
    """gguf: a chat model in GGUF format."""
    context_tokens: Annotated[int, Field(ge=256)] = 4096
    """gguf: the size of the context in tokens, for all conversations of this process together."""
    threads: Annotated[int, Field(ge=0)] = 0
    """gguf: CPU threads; 0 takes half of the cores."""
    base_url: str | None = None
    """openai: the address of the API; by default a server on this machine."""
    api_key: SecretStr | None = None
    """openai: the key, if the server needs one. Set it as ``RAVESTATE_WILDTALK_API_KEY`` in the environment."""
    connect_timeout: Seconds = 5.0
    """openai: seconds to wait for a connection."""
    read_timeout: Seconds = 60.0
    """Seconds of silence after which a model counts as stuck."""

    name: str | None = None
    """The agent's name, by default ``interloc.agent``."""
    persona: str = PERSONA
    """The system prompt; ``{name}`` stands for the name."""
    examples: tuple[tuple[str, str], ...] = EXAMPLES
    """Utterances and answers that show the model how to talk. Small models need a few of these examples."""
    facts: bool = False
    """Whether the model may answer questions about facts. Small models make facts up."""
    no_facts: str = "I don't know that, I'm afraid."
    """The answer to a question about facts, unless `facts` lets the model answer."""
    gate: bool = True
    """Whether to check each generated sentence before it is spoken. If none is fit, the listening skill answers, with
    authored phrases."""
    no_model: str = "I cannot think just now."
    """The answer when the model cannot be loaded, or fails before its first word."""

    max_tokens: Annotated[int, Field(ge=1)] = 96
    """The longest answer, in tokens; ``sentences`` usually ends it earlier."""
    sentences: Annotated[int, Field(ge=1)] = 2
    """The longest answer, in sentences."""
    temperature: Annotated[float, Field(ge=0, le=2)] = 0.5
    """The randomness: 0 always takes the likeliest word, 1 is the model's own distribution."""
    history_turns: Annotated[int, Field(ge=1)] = 6
    """The maximum number of turns in the prompt. A turn is an utterance of the user with its answer."""
    history_characters: Annotated[int, Field(ge=100)] = 4000
    """The maximum number of characters of these turns; about four make a token."""


module = rs.Module("wildtalk", requires=[rawio, interloc, nlp], settings=Settings)

history: rs.Collection[Message] = module.collection("history")
"""The last messages of all speakers, oldest first; the keys begin with the time."""

model: rs.Slot[Backend | None] = module.slot("model", None, input=True)
"""The backend. You may write a backend of your own into this slot."""

chosen: rs.Signal[object] = module.signal("chosen", payload=object)
"""A backend was chosen, by the settings or by what this machine has. The payload is the backend, or None."""

trouble: rs.Slot[str] = module.slot("trouble", "")
"""The reason why the model does not answer; empty while the model answers."""

listening: rs.Slot[State] = module.slot("listening", State(), type=State)
"""The memory of the listening skill: the last phrases, the tone, opinions, a game."""

overheard: rs.Slot[tuple[Overheard, ...]] = module.slot("overheard", ())
"""The tones of the last utterances, including those that other modules answered."""

notes: rs.Collection[str] = module.collection("notes", input=True)
"""Notes of other modules about the user and the situation: short sentences for the prompt, such as ``The user lives in Rome.``"""


def machine_clock() -> datetime:
    """Return the current moment in the machine's time zone."""
    return datetime.now().astimezone()


clock: rs.Slot[Callable[[], datetime]] = module.slot("clock", machine_clock, input=True)
"""The clock, by default the machine's. The prompt names the day and the time."""
