"""A spoken conversation over the WebSocket.

The tests cover sound in both directions, captions, the words that the visitor heard, and mistakes of clients.
"""

import asyncio
import contextlib
from collections.abc import AsyncGenerator
from typing import Any

import pytest
from starlette.applications import Starlette
from starlette.testclient import TestClient

from modules.platform.webio.ears import WORD, ears, story, tone
from modules.platform.webio.visit import Visit, in_virtual_time, page, past
from ravestate.modules import rawio
from ravestate.modules.platform.webio.fields import LONGEST_SOUND
from ravestate.modules.platform.webio.line import PageLine, Window
from ravestate.modules.platform.webio.session import Session

SPEECH = tone(1.0, rawio.IN_RATE)
SILENCE = bytes(rawio.IN_RATE)  # half a second
ANSWER = "I heard a sound, and that pleases me."
LENGTH = len(ANSWER.split()) * WORD
"""The time that the spoken answer takes (seconds)."""


class Caller(Visit):
    """A visitor who speaks and listens."""

    def __init__(self, app: Starlette, **headers: str) -> None:
        super().__init__(app, **headers)
        self.stream = -1
        self.sound = 0
        """The number of samples received of the current stream."""

    async def call(self, **fields: Any) -> dict[str, Any]:
        """Say hello, and turn the microphone on."""
        welcome = await self.hello(**fields)
        self.tell("microphone", on=True)
        await self.until("flush")
        return welcome

    def speak(self, sound: bytes = SPEECH + SILENCE) -> None:
        """Send sound in blocks of 40 ms."""
        for at in range(0, len(sound), 1280):
            self.send(sound[at : at + 1280])

    async def next(self) -> dict[str, Any]:
        """Return the next frame. Count the samples of sound."""
        frame = await super().next()
        if frame["type"] == "sound":
            self.sound += len(frame["sound"]) // 2
        elif frame["type"] == "flush":
            self.stream, self.sound = frame["n"], 0
        return frame

    async def until(self, type: str) -> dict[str, Any]:
        """Return the next frame of a type. Skip other frames."""
        return (await self.frames(type))[-1]

    async def rest(self) -> list[dict[str, Any]]:
        """Return the frames that have arrived and that the test has not read."""
        found: list[dict[str, Any]] = []
        while not self.nothing_more():
            found.append(await self.next())
        return found

    def played(self, seconds: float) -> None:
        """Report the position of the loudspeaker."""
        self.tell("played", n=self.stream, samples=round(seconds * rawio.OUT_RATE))


@contextlib.asynccontextmanager
async def calling() -> AsyncGenerator[tuple[Starlette, Caller]]:
    """Open a page with a caller whose microphone is on."""
    async with page(ears, story) as app, Caller(app) as caller:
        assert (await caller.call())["voice"] is True
        yield app, caller


def now() -> float:
    return asyncio.get_running_loop().time()


def session_of(app: Starlette) -> Session:
    (session,) = app.state.sessions
    return session


@in_virtual_time
async def test_spoken_words_are_shown_as_captions_and_then_as_a_message() -> None:
    async with calling() as (_, caller):
        caller.speak()
        frames = await caller.frames("sound")
        captions = [frame["text"] for frame in frames if frame["type"] == "caption"]
        assert captions[0] == "a sound of 0.2 seconds so far"
        assert captions[-1] == ""
        assert [(f["n"], f["from"], f["text"]) for f in frames if f["type"] == "message"] == [
            (1, "user", "a sound"),
            (2, "agent", ANSWER),
        ]


@in_virtual_time
async def test_the_page_gets_a_frame_each_time_the_agent_begins_to_listen() -> None:
    async with calling() as (_, caller):
        await caller.until("listening")
        caller.tell("microphone", on=False)
        caller.tell("microphone", on=True)
        await caller.until("listening")


@in_virtual_time
async def test_the_sound_is_sent_at_most_a_second_ahead_of_the_loudspeaker() -> None:
    async with calling() as (_, caller):
        caller.speak()
        for second in (1.0, 2.0, LENGTH):
            while caller.sound < round(second * rawio.OUT_RATE):
                await caller.until("sound")
            await past(0.0)
            assert caller.nothing_more()
            caller.played(second)
        assert caller.sound == round(LENGTH * rawio.OUT_RATE)


@in_virtual_time
async def test_after_stop_no_sound_is_sent_and_the_message_has_the_heard_words() -> None:
    async with calling() as (app, caller):
        caller.speak()
        await caller.until("sound")
        caller.played(0.0)
        while caller.sound < rawio.OUT_RATE:
            await caller.until("sound")
        caller.played(1.0)
        await caller.until("sound")
        stream = caller.stream
        caller.tell("hush")
        frames = await caller.frames("heard")
        assert caller.stream == stream + 1
        assert frames[-1] == {"type": "heard", "n": 2, "text": "I heard a"}
        await past(60.0)
        assert caller.sound == 0
        async with Visit(app) as other:  # a window that opens later gets the mark, too
            await other.hello(session=caller.session)
            assert (await other.frames("message"))[-1]["text"] == "a sound"
            assert (await other.next())["heard"] == "I heard a"


@in_virtual_time
async def test_an_answer_that_was_heard_completely_is_not_marked() -> None:
    async with calling() as (app, caller):
        caller.speak()
        for second in (1.0, 2.0, LENGTH):
            while caller.sound < round(second * rawio.OUT_RATE):
                await caller.until("sound")
            caller.played(second)
        await past(1.0)
        assert session_of(app).context.read(rawio.heard) == ANSWER
        assert "heard" not in [frame["type"] for frame in await caller.rest()]


@in_virtual_time
async def test_a_visitor_who_types_gets_no_sound_and_no_marks() -> None:
    async with page(ears, story) as app, Visit(app) as visit:
        assert (await visit.hello())["voice"] is True
        visit.say("words")
        assert await visit.messages(2) == ["user: words", "agent: I heard words, and that pleases me."]
        await past(60.0)
        assert visit.nothing_more()
        assert session_of(app).context.read(rawio.sound) is None  # the visitor has no audio line
        visit.tell("hush")  # without a line, this frame has no effect


@in_virtual_time
async def test_the_line_is_kept_for_half_a_minute_after_the_microphone_goes_off() -> None:
    async with calling() as (app, caller):
        context = session_of(app).context
        line = context.read(rawio.sound)
        for seconds, kept in ((29.0, True), (29.0, True), (31.0, False)):
            caller.tell("microphone", on=False)
            await past(seconds)
            assert (context.read(rawio.sound) is line) is kept
            caller.tell("microphone", on=True)
            await caller.until("flush")
        caller.speak()
        assert (await caller.until("message"))["text"] == "a sound"
        assert context.read(rawio.sound) not in (None, line)


@in_virtual_time
async def test_a_line_that_the_agent_closes_is_replaced_when_the_microphone_goes_on_again() -> None:
    async with calling() as (app, caller):
        line = session_of(app).line
        assert line is not None
        line.close()
        assert (await caller.until("taken"))["text"] == "the agent does not listen any more"
        caller.tell("microphone", on=True)
        await caller.until("flush")
        caller.speak()
        assert (await caller.until("message"))["text"] == "a sound"


@in_virtual_time
async def test_turning_the_microphone_on_in_one_window_turns_it_off_in_the_other() -> None:
    async with calling() as (app, caller), Caller(app) as second:
        await second.call(session=caller.session)
        assert await caller.until("taken") == {"type": "taken", "text": "the microphone is on in another window"}
        caller.speak()  # the agent does not hear this
        await past(5.0)
        assert session_of(app).history.last == 0
        second.speak()
        await second.until("sound")
        await past(0.0)
        types = [frame["type"] for frame in await caller.rest()]
        assert types.count("message") == 2  # this window still gets the messages
        assert "sound" not in types


@in_virtual_time
async def test_after_a_lost_connection_a_new_connection_gets_the_later_sound() -> None:
    async with calling() as (app, caller):
        caller.speak()
        await caller.until("sound")
        await caller.drop()
        line = session_of(app).line
        assert line is not None
        assert line.window is None
        async with Caller(app) as again:
            await again.call(session=caller.session, last=2)
            again.speak()
            assert (await again.until("message"))["text"] == "a sound"
            assert (await again.until("sound"))["sound"] == tone(WORD)[:9600]


@in_virtual_time
async def test_an_utterance_ends_when_the_microphone_goes_off() -> None:
    async with calling() as (_, caller):
        caller.speak(SPEECH)
        caller.tell("microphone", on=False)
        assert (await caller.until("message"))["text"] == "a sound"
        caller.tell("microphone", on=True)
        await caller.until("flush")


@in_virtual_time
async def test_a_visitor_can_leave_while_the_agent_speaks() -> None:
    async with calling() as (app, caller):
        caller.speak()
        await caller.until("sound")
        caller.tell("bye")
        caller.tell("hush")
        assert await caller.until("ended")
        assert list(app.state.sessions) == []


@in_virtual_time
async def test_the_message_that_begins_with_the_heard_words_is_marked() -> None:
    async with page() as app, Visit(app) as visit:
        await visit.hello()
        context = session_of(app).context
        for text in ("one two  three", "four"):
            visit.say(text)
        await visit.messages(5)
        for heard, frame in (
            ("one  two", {"n": 3, "text": "one two"}),
            ("one two three", {"n": 3, "text": "one two  three"}),  # after a false alarm, the agent has continued
            ("", {"n": 5, "text": ""}),  # the visitor heard nothing of the newest message
        ):
            context.put(rawio.heard, heard)
            assert (await visit.frames("heard"))[-1] == {"type": "heard", **frame}
        context.put(rawio.heard, "nothing of the kind")
        context.put(rawio.heard, "Hello!")  # the visitor heard the whole message, so it gets no mark
        await past(1.0)
        assert visit.nothing_more()


@in_virtual_time
async def test_the_heard_words_of_a_growing_utterance_mark_its_later_message() -> None:
    async with page() as app, Visit(app) as visit:
        await visit.hello()
        await visit.messages(1)
        context = session_of(app).context
        context.put(rawio.speaking, True)
        context.emit(rawio.piece, "I once knew a raven who")
        context.put(rawio.heard, "I once")
        context.put(rawio.speaking, False)
        (*_, message) = await visit.frames("message")
        assert (message["text"], message["heard"]) == ("I once knew a raven who", "I once")


@in_virtual_time
async def test_input_from_another_source_is_shown_as_a_message_and_typed_input_only_once() -> None:
    async with page() as app, Visit(app) as visit:
        await visit.hello()
        await visit.messages(1)
        rawio.say(session_of(app).context, "from\x1b[31m elsewhere")
        assert await visit.messages(2) == ["user: from elsewhere", "agent: from elsewhere"]
        visit.say("typed")
        visit.say("typed")
        assert sorted(await visit.messages(4)) == ["agent: typed", "agent: typed", "user: typed", "user: typed"]


# ------------------------------------------------------------------------------------ mistakes of clients


@in_virtual_time
async def test_a_page_whose_agent_cannot_hear_answers_sound_frames_with_an_error() -> None:
    async with page() as app, Visit(app) as visit:
        assert "voice" not in await visit.hello()
        await visit.next()
        for frame in ({"type": "microphone", "on": True}, {"type": "played", "n": 0, "samples": 0}, {"type": "hush"}):
            visit.tell(**frame)
            assert await visit.next() == {
                "type": "error",
                "code": "deaf",
                "text": "this agent neither hears nor speaks: it needs a module such as voiceio",
            }
        visit.send(bytes(640))
        assert (await visit.next())["text"] == "a frame is a text message, not a binary one"


@in_virtual_time
async def test_sound_before_hello_ends_the_connection() -> None:
    async with page(ears, story) as app, Visit(app) as visit:
        visit.send(bytes(640))
        assert (await visit.next())["code"] == "malformed"
        assert (await visit.next())["code"] == 4400


@pytest.mark.parametrize("size", [1, 641, LONGEST_SOUND + 2])
def test_sound_with_half_a_sample_or_too_many_samples_is_refused(size: int) -> None:
    @in_virtual_time
    async def test() -> None:
        async with calling() as (_, caller):
            caller.send(b"\x70" * size)
            frame = await caller.until("error")
            assert (frame["type"], frame["code"]) == ("error", "malformed")
            assert f"not {size:,} bytes" in frame["text"]
            caller.speak()
            await caller.until("sound")

    test()


@in_virtual_time
async def test_sound_that_arrives_faster_than_real_time_is_ignored(monkeypatch: pytest.MonkeyPatch) -> None:
    heard: list[int] = []
    hear = PageLine.hear

    def note(line: PageLine, window: Window, sound: bytes) -> None:
        heard.append(len(sound))
        hear(line, window, sound)

    monkeypatch.setattr(PageLine, "hear", note)
    async with calling() as (_, caller):
        for _ in range(1000):
            caller.send(bytes(LONGEST_SOUND))
        await past(0.0)
        assert 0 < sum(heard) <= 2 * LONGEST_SOUND
        await past(5.0)
        caller.speak()  # the agent hears this again
        assert (await caller.until("message"))["text"] == "a sound"


@in_virtual_time
async def test_sound_and_reports_do_not_count_for_the_limit_of_texts() -> None:
    async with calling() as (_, caller):
        for _ in range(100):
            caller.send(bytes(640))
            caller.played(0.0)
        caller.say("words")
        assert (await caller.until("message"))["text"] == "words"
        assert now() == 0.0


@pytest.mark.parametrize(
    ("frame", "why"),
    [
        ({"type": "microphone"}, 'microphone lacks "on": true or false'),
        ({"type": "microphone", "on": 1}, "microphone: \"on\": '1' is not true or false"),
        ({"type": "played", "n": -1, "samples": 0}, "played: \"n\": '-1' is not a whole number from 0 on"),
        ({"type": "played", "n": 0, "samples": 1.5}, "played: \"samples\": '1.5' is not a whole number from 0 on"),
    ],
)
def test_a_faulty_frame_gets_an_error_with_the_reason(frame: dict[str, Any], why: str) -> None:
    @in_virtual_time
    async def test() -> None:
        async with calling() as (_, caller):
            caller.tell(**frame)
            assert (await caller.until("error"))["text"] == why

    test()


def test_only_the_page_of_an_agent_that_hears_may_use_the_microphone() -> None:
    from ravestate.modules import webio
    from ravestate.runtime.agent import Agent

    for modules, allowed in (((ears, story), "microphone=(self)"), ((story,), "microphone=()")):
        with TestClient(webio.app(Agent(*modules, webio)), base_url="http://127.0.0.1:8420") as client:
            headers = client.get("/").headers
            assert allowed in headers["permissions-policy"]
            assert "script-src 'self'" in headers["content-security-policy"]  # this also allows the audio worklet
            assert client.get("/assets/worklet.js").status_code == 200
