"""A reply can be awaited on an event loop or waited for in a thread, and no error is lost."""

from __future__ import annotations

import asyncio
from concurrent.futures import Future

import pytest

from ravestate.errors import PlatformError
from ravestate.modules.meta.ontology.reply import Reply
from ravestate.testing.virtual_loop import VirtualLoop


def done(value: object) -> Future[object]:
    future: Future[object] = Future()
    if isinstance(value, Exception):
        future.set_exception(value)
    else:
        future.set_result(value)
    return future


async def wait(reply: Reply[object]) -> object:
    return await reply


def test_each_caller_gets_the_result() -> None:
    reply = Reply(done(3), "Memory.find")
    assert reply.result() == reply.result(1) == asyncio.run(wait(reply)) == 3
    assert repr(reply) == "<reply of Memory.find: done>"
    assert repr(Reply(Future(), "Memory.find")) == "<reply of Memory.find: pending>"


def test_a_reply_raises_the_error() -> None:
    reply = Reply(done(PlatformError("no")), "Memory.find")
    with pytest.raises(PlatformError, match="no"):
        reply.result()
    with pytest.raises(PlatformError, match="no"):
        asyncio.run(wait(reply))


def test_a_timeout_ends_the_wait_but_not_the_operation() -> None:
    future: Future[int] = Future()
    reply = Reply(future, "Memory.save")
    with pytest.raises(TimeoutError):
        reply.result(0)

    async def impatient() -> None:
        with pytest.raises(TimeoutError):
            await asyncio.wait_for(wait(reply), 0.001)  # type: ignore[arg-type]

    asyncio.run(impatient())
    assert not future.cancelled()
    future.set_result(3)
    assert reply.result() == 3


def test_virtual_time_waits_for_a_reply_and_names_the_operation() -> None:
    loop = VirtualLoop()
    future: Future[int] = Future()
    task = loop.create_task(wait(Reply(future, "Memory.find")))  # type: ignore[arg-type]

    def finish() -> None:
        assert loop.running_functions() == ["Memory.find"]
        future.set_result(3)

    loop.call_soon(lambda: loop.call_soon(finish))
    loop.run_to(1.0)
    assert task.result() == 3
    loop.close()


@pytest.mark.parametrize("late", [False, True])
def test_an_ignored_error_is_logged(caplog: pytest.LogCaptureFixture, late: bool) -> None:
    future: Future[object] = Future() if late else done(PlatformError("the disk is full"))
    reply = Reply(future, "Memory.save")
    del reply
    if late:
        future.set_exception(PlatformError("the disk is full"))
    assert "Memory.save failed, and nobody waited for it: the disk is full" in caplog.text


def test_an_error_that_the_caller_gets_is_not_logged(caplog: pytest.LogCaptureFixture) -> None:
    reply = Reply(done(PlatformError("no")), "Memory.save")
    with pytest.raises(PlatformError):
        reply.result()
    del reply
    Reply(done(3), "Memory.save")
    assert caplog.text == ""
