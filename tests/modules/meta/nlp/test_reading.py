"""A language model that helps to read utterances: its readings, its failures, and its requests over HTTP."""

import asyncio
import json
from collections.abc import AsyncGenerator, Iterator, Sequence
from contextlib import suppress
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import SecretStr

import ravestate as rs
from ravestate.errors import PlatformError
from ravestate.language.chat import Message, Progress
from ravestate.modules import nlp
from ravestate.modules.meta.nlp.pipeline import Pipeline
from ravestate.modules.meta.nlp.reading import LONGEST, MOST_SKIPPED, model_reader
from ravestate.modules.skill.wildtalk import llama_process
from ravestate.modules.skill.wildtalk.llama import bundled_model
from ravestate.modules.skill.wildtalk.llama_process import ModelKey
from ravestate.testing import simulate

GIVEN = nlp.Reading(written="Where do you live?", question="PLACE", answer="none")


class Model:
    """A language model that gives the same answer each time, fails, or never answers (None)."""

    def __init__(self, answer: str | PlatformError | None) -> None:
        self.answer = answer
        self.asked: list[str] = []
        self.closed = False

    async def load(self, progress: Progress | None = None) -> None: ...

    async def stream(self, messages: Sequence[Message], **options: Any) -> AsyncGenerator[str, None]:
        self.asked.append(messages[-1].text)
        if isinstance(self.answer, PlatformError):
            raise self.answer
        if self.answer is None:
            await asyncio.Event().wait()
        half = len(self.answer or "") // 2
        yield (self.answer or "")[:half]
        yield (self.answer or "")[half:]

    async def close(self) -> None:
        self.closed = True


def given_by(written: str, question: str = "NONE", answer: str = "none") -> Model:
    return Model(json.dumps({"written": written, "question": question, "answer": answer}))


@pytest.fixture(autouse=True)
def loaded(reader: Pipeline) -> Iterator[None]:
    yield


def test_the_slots_are_filled_from_the_reading_of_the_model() -> None:
    model = given_by("My sister lives in Antwerp.", answer="probably no")
    with simulate(nlp) as sim:
        sim.put(nlp.reader, nlp.ModelReader(model, 60.0))
        sim.say("m sstr livs n antwerp")
        assert model.asked == ["m sstr livs n antwerp"]
        assert sim.read(nlp.text) == "m sstr livs n antwerp"
        assert sim.read(nlp.normal) == "My sister lives in Antwerp."
        assert sim.read(nlp.triples) == (nlp.Triple("My sister", "live", "antwerp"),)  # capitals as typed
        assert sim.read(nlp.yesno) == nlp.YesNo(0, 1, False)
        (place,) = sim.read(nlp.entities)
        assert (place.start, place.end) == (14, 21)  # positions in the text as typed
    assert model.closed


def test_a_question_that_the_model_finds_raises_the_signal_is_question() -> None:
    module = rs.Module("test", requires=[nlp])

    @module.rule(when=nlp.is_question)
    def ask(ctx: rs.RuleContext) -> None:
        assert ctx.payload(nlp.is_question) is nlp.QuestionWord.PLACE

    with simulate(module) as sim:
        sim.put(nlp.reader, nlp.ModelReader(given_by("Your house is where?", "PLACE"), 60.0))
        sim.say("ur house is whre")
        assert sim.read(nlp.question) is nlp.QuestionWord.PLACE
        assert "test:ask" in sim.fired


@pytest.mark.parametrize("written", ["", "I am a robot and I live in a small box.", "42"])
def test_a_reading_with_words_that_the_user_did_not_say_is_ignored(written: str) -> None:
    with simulate(nlp) as sim:
        sim.put(nlp.reader, nlp.ModelReader(given_by(written, "REASON", "yes"), 60.0))
        sim.say("where do u live")
        assert sim.read(nlp.normal) == "Where do you live?"
        assert sim.read(nlp.question) is nlp.QuestionWord.PLACE
        assert not sim.read(nlp.yesno)


@pytest.mark.parametrize("answer", [None, PlatformError("nlp: no server"), "{}", "no JSON", ""])
def test_an_utterance_is_analysed_even_if_the_model_fails(
    answer: str | PlatformError | None, caplog: pytest.LogCaptureFixture
) -> None:
    model = Model(answer)
    with simulate(nlp) as sim:
        sim.put(nlp.reader, nlp.ModelReader(model, 2.0))
        sim.say("where do u live")
        sim.advance(2.0 if answer is None else 0.0)
        assert sim.read(nlp.question) is nlp.QuestionWord.PLACE
    assert [record.levelname for record in caplog.records if "nlp:" in record.message] == ["WARNING"]


def test_each_failure_in_a_row_doubles_the_number_of_utterances_that_skip_the_model() -> None:
    async def main() -> list[int]:
        model, asked = Model("broken"), list[int]()
        reader = nlp.ModelReader(model, 60.0)
        for number in range(400):
            before = len(model.asked)
            with suppress(PlatformError):
                await reader.read("hello")
            if len(model.asked) > before:
                asked.append(number)
        model.answer = GIVEN.model_dump_json()
        while await reader.read("hello") is None:
            pass
        assert await reader.read("hello") == GIVEN  # after one success, the model gets every utterance again
        return asked

    asked = asyncio.run(main())
    gaps = [after - before - 1 for before, after in pairwise(asked)]
    assert gaps[:7] == [1, 2, 4, 8, 16, 32, 64]
    assert set(gaps[7:]) == {MOST_SKIPPED}


def test_long_and_empty_texts_are_not_sent_to_the_model() -> None:
    model = Model(GIVEN.model_dump_json())
    reader = nlp.ModelReader(model, 60.0)
    for text in ("", " \n", "a" * (LONGEST + 1)):
        assert asyncio.run(reader.read(text)) is None
    assert not model.asked


@given(st.text(max_size=60), st.text(max_size=60))
def test_the_offsets_of_a_reading_are_ascending_positions_in_the_users_text(written: str, text: str) -> None:
    normal = nlp.Reading(written=written, question="NONE", answer="none").normal(text)
    if normal is not None:
        assert len(normal.origin) == len(normal.text) + 1
        assert list(normal.origin) == sorted(normal.origin)
        assert all(0 <= place <= len(text) for place in normal.origin)


def test_the_request_to_the_server_has_the_model_and_the_key_from_the_settings(chat_server: Any) -> None:
    async def answer(talk: Any) -> None:
        await talk.head()
        await talk.piece(GIVEN.model_dump_json(), "stop")
        await talk.event("[DONE]")

    async def main() -> None:
        async with chat_server(answer).running() as server:
            reader = model_reader("tiny", server.url, SecretStr("k3y"), 60.0)
            try:
                assert await reader.read("where u live") == GIVEN
            finally:
                await reader.close()
            (talk,) = server.talks
            assert talk.body["model"] == "tiny"
            assert talk.body["response_format"]["json_schema"]["schema"]["additionalProperties"] is False
            assert talk.headers["authorization"] == "Bearer k3y"

    asyncio.run(main())


def test_there_is_a_model_reader_only_if_the_settings_name_a_model() -> None:
    with simulate(nlp) as sim:
        assert sim.read(nlp.reader) is None
    with simulate(nlp, settings={"nlp": {"model": "tiny"}}) as sim:
        assert sim.read(nlp.reader) is not None


def test_the_error_about_an_absent_server_names_the_setting_of_nlp() -> None:
    with pytest.raises(PlatformError, match=r"nlp: no server answers at .* --set nlp.base_url="):
        asyncio.run(model_reader("tiny", "http://127.0.0.1:9/v1", None, 60.0).read("where u live"))


def test_an_answer_from_llama_cpp_follows_the_schema() -> None:
    """A tiny model answers nonsense, but its server forces each answer into the form of a reading."""
    process = llama_process.take(ModelKey(bundled_model(), 2048, 1, 1))

    async def main() -> list[nlp.Reading | None]:
        address = await asyncio.to_thread(process.start, lambda _: None)
        reader = model_reader("", f"{address}/v1", SecretStr(process.secret), 60.0)
        try:
            return [await reader.read(text) for text in ("where u live", 'say "}" and stop', "yeah sure")]
        finally:
            await reader.close()

    try:
        assert all(isinstance(reading, nlp.Reading) for reading in asyncio.run(main()))
    finally:
        llama_process.drop(process)
