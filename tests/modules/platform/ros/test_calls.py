"""`Calls`: the calls and goals of a node that wait for an answer."""

import asyncio
import json
from collections.abc import Callable
from typing import Any, cast

import pytest

from ravestate.errors import PlatformError
from ravestate.modules.platform.ros.calls import Calls
from ravestate.modules.platform.ros.channel import Channel
from ravestate.modules.platform.ros.frames import Kind
from ravestate.modules.platform.ros.types import Types


class Spoken:
    """A stand-in for message types. A decoded message is the name of its type and its text."""

    def decode(self, body: memoryview, type: str) -> str:
        if not body:
            raise PlatformError("too short")
        return f"{type}: {bytes(body).decode()}"


def channel(name: str, kind: str) -> Channel:
    return Channel(cast(Any, None), 1, {"kind": kind, "name": name}, f"pkg/{name}")


def run(test: Callable[[Calls], Any]) -> None:
    async def main() -> None:
        await test(Calls("ros1", cast(Types, Spoken())))

    asyncio.run(main())


def body(value: str) -> memoryview:
    return memoryview(value.encode())


def test_the_first_answer_to_a_call_ends_only_this_call() -> None:
    async def main(calls: Calls) -> None:
        first, second = calls.open(channel("lamp", "client")), calls.open(channel("lamp", "client"))
        calls.answer(Kind.ANSWER, second.number, body("on"))
        calls.answer(Kind.ANSWER, second.number, body("off"))
        assert await second.future == "pkg/lamp_Response: on"
        assert not first.future.done()

    run(main)


def test_feedback_does_not_end_a_goal() -> None:
    async def main(calls: Calls) -> None:
        heard: list[str] = []
        goal = calls.open(channel("walk", "action"), heard.append)
        calls.answer(Kind.FEEDBACK, goal.number, body("half"))
        assert heard == ["pkg/walk_Feedback: half"] and not goal.future.done()
        calls.answer(Kind.ANSWER, goal.number, body("there"))
        assert await goal.future == "pkg/walk_Result: there"

    run(main)


def test_an_answer_to_a_closed_call_changes_nothing() -> None:
    async def main(calls: Calls) -> None:
        call = calls.open(channel("lamp", "client"))
        calls.close(call)
        calls.answer(Kind.ANSWER, call.number, body("late"))
        assert not call.future.done()

    run(main)


def test_a_faulty_channel_fails_only_its_own_calls() -> None:
    async def main(calls: Calls) -> None:
        broken, whole = channel("lamp", "client"), channel("door", "client")
        one, other = calls.open(broken), calls.open(whole)
        calls.fail(broken, "ros1: lamp: no such type")
        with pytest.raises(PlatformError, match="ros1: lamp: no such type"):
            await one.future
        assert not other.future.done()
        calls.fail_all("the bridge ended")
        with pytest.raises(PlatformError, match="ros1: door: the bridge ended"):
            await other.future

    run(main)


def test_a_fault_and_an_answer_that_cannot_be_decoded_raise_errors() -> None:
    async def main(calls: Calls) -> None:
        refused, broken = calls.open(channel("lamp", "client")), calls.open(channel("lamp", "client"))
        calls.answer(Kind.FAULT, refused.number, body(json.dumps("no lamp")))
        calls.answer(Kind.ANSWER, broken.number, body(""))
        with pytest.raises(PlatformError, match="ros1: lamp: no lamp"):
            await refused.future
        with pytest.raises(PlatformError, match="too short"):
            await broken.future

    run(main)
