"""Checks that every platform for conversations must pass: order, separate users, failures, restarts.

A platform's test runs each check against the platform, with the agent `echo` and a `Driver`:

```python
@pytest.mark.parametrize("check", CHECKS)
def test_the_platform_conforms(check):
    asyncio.run(check(MyDriver()))
```
"""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncGenerator, Awaitable, Callable
from typing import Protocol

import ravestate as rs
from ravestate.modules import rawio

PATIENCE = 60.0
"""A check waits at most this many seconds for a message."""

USERS = ("ada", "bob", "cleo", "dora", "emil")

LAST = "the last message"
"""The last message of each check. If the agent answers an earlier message twice, its extra answer comes before its
answer to this message."""

echo = rs.Module("echo", requires=(rawio,))
"""The agent of the checks. It repeats each message, and answers ``count`` with the number of messages so far. In the
middle of its answer to ``fail``, its rule fails."""

PIECE = "I was about to"
"""The first and only piece of the answer to ``fail``."""

_count = echo.slot("count", 0)


@echo.rule(when=rawio.input.changed, writes=(rawio.output, rawio.speaking, _count), emits=rawio.piece)
async def repeat(ctx: rs.RuleContext) -> None:
    """Repeat the user's words, or say the number of messages in this context, or fail after a piece."""
    text = ctx.payload(rawio.input.changed)
    ctx[_count] = ctx[_count] + 1
    if text == "fail":
        ctx[rawio.speaking] = True
        ctx.emit(rawio.piece, PIECE)
        raise ValueError("the check has asked for a failure")
    ctx[rawio.output] = str(ctx[_count]) if text == "count" else text


class Driver(Protocol):
    """The users of a platform on which `echo` runs. Each check gets a new driver, so that all users are new.

    Use a driver as an async context manager: it starts the agent on entry, and ends the agent on exit.
    """

    async def __aenter__(self) -> object:
        """Start the platform with the agent."""
        ...

    async def __aexit__(self, *_: object) -> None:
        """End the platform."""
        ...

    async def say(self, user: str, text: str) -> None:
        """Send a message as a user. This must work even while the agent is down."""
        ...

    async def read(self, user: str, count: int) -> list[str]:
        """Wait until a user has received `count` messages from the agent; return all that they have received."""
        ...

    async def kill(self) -> None:
        """End the agent without warning, as a crash does. If the platform keeps no files, only cut the connections."""
        ...

    async def restart(self) -> None:
        """Start the agent again after `kill`, or connect the users again."""
        ...


async def check_answer(driver: Driver) -> None:
    """Check that a message gets an answer with the same text, whatever its characters."""
    texts = ["Hello", "Grüß dich, 世界! 🎈", "two\nlines", "<b>&amp;</b> *bold* `code`", "x" * 3000]
    async with _limited(driver):
        for n, text in enumerate(texts, start=1):
            await driver.say("ada", text)
            _agree(await _read(driver, "ada", n), texts[:n])
        await _end(driver, "ada", texts)


async def check_order(driver: Driver) -> None:
    """Check that the agent answers the messages of a user in order."""
    texts = [f"message {n}" for n in range(12)]
    async with _limited(driver):
        for text in texts:
            await driver.say("ada", text)
        await _end(driver, "ada", texts)


async def check_users(driver: Driver) -> None:
    """Check that users who write at the same time get only answers to their own messages, from their own contexts."""
    async with _limited(driver):
        for n in range(3):
            await asyncio.gather(*(driver.say(user, f"{n} of {user}") for user in USERS))
        for user in USERS:
            texts = [f"{n} of {user}" for n in range(3)]
            _agree(await _read(driver, user, 3), texts)
            await driver.say(user, "count")
            await _end(driver, user, [*texts, "4"])


async def check_failure(driver: Driver) -> None:
    """Check that, if a rule fails in the middle of its utterance, the user gets the words so far as a message."""
    async with _limited(driver):
        await driver.say("ada", "fail")
        _agree(await _read(driver, "ada", 1), [PIECE])
        await _end(driver, "ada", [PIECE])


async def check_restart(driver: Driver) -> None:
    """Check that the agent answers messages from before, during and after a crash exactly once, and in order."""
    texts: dict[str, list[str]] = {user: [] for user in USERS}

    async def say_all(round: str) -> None:
        for user in USERS:
            texts[user].append(f"{round} of {user}")
        await asyncio.gather(*(driver.say(user, texts[user][-1]) for user in USERS))

    async with _limited(driver):
        for n in range(2):
            await say_all(f"before {n}")
            await _read(driver, USERS[n], 2 * n + 1)
            await driver.kill()
            await say_all(f"during {n}")
            await driver.restart()
        await say_all("after")
        for user in USERS:
            await _end(driver, user, texts[user])


CHECKS: tuple[Callable[[Driver], Awaitable[None]], ...] = (
    check_answer,
    check_order,
    check_users,
    check_failure,
    check_restart,
)
"""All checks of a platform, each an async function of a driver."""


@contextlib.asynccontextmanager
async def _limited(driver: Driver) -> AsyncGenerator[None]:
    """Enter a driver, for a limited time."""
    async with driver, asyncio.timeout(5 * PATIENCE):
        yield


async def _read(driver: Driver, user: str, count: int) -> list[str]:
    """Wait until a user has received `count` messages; return all that they have received."""
    try:
        async with asyncio.timeout(PATIENCE):
            return await driver.read(user, count)
    except TimeoutError:
        raise AssertionError(
            f"{user} has not received message {count} within {PATIENCE:g} s: see whether the agent still runs, and what "
            "it logs"
        ) from None


async def _end(driver: Driver, user: str, wanted: list[str]) -> None:
    """Check that a user has received only these messages: send `LAST`, and check that its answer comes next."""
    await driver.say(user, LAST)
    _agree(await _read(driver, user, len(wanted) + 1), [*wanted, LAST])


def _agree(found: list[str], wanted: list[str]) -> None:
    if found != wanted:
        raise AssertionError(f"the user should have received {wanted}, but has received {found}")
