"""The reading of an utterance by a language model, which may replace parts of the module's own analysis.

The server should constrain the model's answer to a JSON schema, so that the answer is a `Reading`. If the answer
is something else, the module's own analysis stays. Sometimes the model wrongly answers the user's question, or leaves
words out. `Reading.normal` rejects such a reading.
"""

from __future__ import annotations

import asyncio
import json
from collections.abc import Sequence
from contextlib import aclosing
from difflib import SequenceMatcher
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, SecretStr, ValidationError

from ravestate.errors import PlatformError
from ravestate.language.chat import Backend, Message
from ravestate.language.normal import Normal
from ravestate.language.openai import OpenAIBackend

from .answer import YesNo
from .question_word import QuestionWord

LONGEST = 400
"""If an utterance has more characters than this, the model does not read it, because this would take too long."""
FAITHFUL = 0.6
"""The least share of letters that `Reading.written` and the user's text must have in common."""
MOST_SKIPPED = 64
"""If the model fails repeatedly, at most this many utterances are analysed without the model before the next
try."""

_PROMPT = """\
You annotate what a user types to a robot. Answer in JSON.
written: the same words as correct written English, with capitals and punctuation. Change nothing else. Never answer the user.
question: the kind of the first question. PERSON: who. PLACE: where. TIME: when, what time. REASON: why, how come. AMOUNT: how \
many, how much, how old, how long, how far. FORM: how. OBJECT: what, which, "tell me your". YES_NO: a question without \
a question word. NONE: nothing is asked.
answer: what the text says as an answer to a yes-no question: yes, probably yes, unsure, probably no, no. none: the text is no \
answer, but a statement, a question or a greeting."""

_ANSWERS = {
    "yes": YesNo(2, 0, False),
    "probably yes": YesNo(1, 0, False),
    "unsure": YesNo(0, 0, True),
    "probably no": YesNo(0, 1, False),
    "no": YesNo(0, 2, False),
    "none": YesNo(),
}


class Reading(BaseModel):
    """The model's reading of an utterance."""

    model_config = ConfigDict(extra="forbid", frozen=True)  # the schema then says `additionalProperties: false`

    written: str
    """The utterance as written English."""
    question: Literal["NONE", "YES_NO", "PERSON", "PLACE", "TIME", "REASON", "AMOUNT", "FORM", "OBJECT"]
    """The name of the kind of the first question, or ``NONE``."""
    answer: Literal["none", "yes", "probably yes", "unsure", "probably no", "no"]
    """The meaning of the utterance as an answer to a yes-no question."""

    @property
    def question_word(self) -> QuestionWord | None:
        """The kind of the first question; None if nothing is asked."""
        return None if self.question == "NONE" else QuestionWord[self.question]

    @property
    def yesno(self) -> YesNo:
        """The meaning of the utterance as an answer."""
        return _ANSWERS[self.answer]

    def normal(self, text: str) -> Normal | None:
        """Return the normal form of the user's `text`; None if the model has not kept to the user's words.

        Example:
            >>> Reading(written="Where do you live?", question="PLACE", answer="none").normal("where u live")
            Normal(text='Where do you live?', original='where u live', origin=...)
        """
        written = " ".join(self.written.split())
        matcher = SequenceMatcher(None, written.lower(), text.lower(), autojunk=False)
        if not written or matcher.ratio() < FAITHFUL:
            return None
        origin: list[int] = []
        for _, start, end, low, high in matcher.get_opcodes():
            origin += [min(low + place, high) for place in range(end - start)]
        return Normal(written, text, (*origin, len(text)))


_EXAMPLES = (
    ("where u live", Reading(written="Where do you live?", question="PLACE", answer="none")),
    ("yeah why not", Reading(written="Yeah, why not.", question="NONE", answer="probably yes")),
    ("my bro works in leeds", Reading(written="My brother works in Leeds.", question="NONE", answer="none")),
    ("dunno tbh", Reading(written="I don't know, to be honest.", question="NONE", answer="unsure")),
    ("u got any pets?", Reading(written="Do you have any pets?", question="YES_NO", answer="none")),
    ("over my dead body", Reading(written="Over my dead body.", question="NONE", answer="no")),
)

SCHEMA: dict[str, Any] = {
    "type": "json_schema",
    "json_schema": {"name": "reading", "strict": True, "schema": Reading.model_json_schema()},
}
"""The field ``response_format`` of a request: the model can answer nothing but a `Reading`."""


class ModelReader:
    """Reads utterances with a language model. The reader never delays an answer for long.

    After a failure, the next utterance is analysed without the model. Each further failure in a row doubles the number of
    utterances without the model, up to `MOST_SKIPPED`. The reader belongs to one event loop.
    """

    def __init__(self, backend: Backend, timeout: float) -> None:
        """Take a language model. Its backend must send `SCHEMA` with each request.

        Args:
            backend: The language model.
            timeout: The number of seconds that the analysis waits for the model.
        """
        self._backend, self._timeout = backend, timeout
        self._failures = self._skipped = 0

    async def read(self, text: str) -> Reading | None:
        """Return the model's reading; None if the text is empty or too long, or the model is skipped after failures.

        Raises:
            PlatformError: The model failed, took too long, or answered something other than a reading.
        """
        if self._skipped or not text.strip() or len(text) > LONGEST:
            self._skipped = max(self._skipped - 1, 0)
            return None
        try:
            async with asyncio.timeout(self._timeout):
                reading = await self._ask(text)
        except TimeoutError:
            self._fail()
            raise PlatformError(
                f"nlp: the language model took more than {self._timeout:g} s: take a smaller model, or give it longer "
                f"with nlp.model_timeout={2 * self._timeout:g}. Meanwhile, nlp works without the model"
            ) from None
        except PlatformError:
            self._fail()
            raise
        self._failures = 0
        return reading

    async def close(self) -> None:
        """Close the connections."""
        await self._backend.close()

    async def _ask(self, text: str) -> Reading:
        async with aclosing(self._backend.stream(_messages(text), max_tokens=LONGEST, temperature=0.0)) as pieces:
            answer = "".join([piece async for piece in pieces])
        try:
            return Reading.model_validate_json(answer)
        except ValidationError:
            raise PlatformError(
                f"nlp: the language model answered {answer[:80]!r}, not JSON of the schema: does its server "
                "support response_format with json_schema?"
            ) from None

    def _fail(self) -> None:
        self._failures += 1
        self._skipped = min(2 ** (self._failures - 1), MOST_SKIPPED)


def model_reader(model: str, base_url: str, api_key: SecretStr | None, timeout: float) -> ModelReader:
    """Return a reader with a model on a server. The server is not contacted yet.

    Args:
        model: The model's name on the server.
        base_url: The address of the server's API, such as ``http://localhost:11434/v1``.
        api_key: The key, if the server needs one.
        timeout: Seconds; see `ModelReader`.

    Raises:
        PlatformError: `base_url` is not a web address.
    """
    schema = {"response_format": SCHEMA}
    return ModelReader(OpenAIBackend(base_url, model, api_key=api_key, extra=schema, owner="nlp"), timeout)


def _messages(text: str) -> Sequence[Message]:
    examples = [
        message
        for said, reading in _EXAMPLES
        for message in (Message("user", said), Message("assistant", json.dumps(reading.model_dump())))
    ]
    return Message("system", _PROMPT), *examples, Message("user", text)
