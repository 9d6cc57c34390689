"""The checks for platforms: a platform without faults passes them, and a faulty platform does not."""

import asyncio
from collections import defaultdict
from collections.abc import Awaitable, Callable

import pytest

from ravestate.testing import CHECKS, Driver, platforms
from ravestate.testing.platforms import check_answer, check_failure, check_order, check_restart, check_users


class InMemory:
    """A platform in memory, seen by its users. It answers the message `doubled` twice."""

    def __init__(self, doubled: str = "") -> None:
        self._doubled = doubled
        self._answers: dict[str, list[str]] = defaultdict(list)

    async def __aenter__(self) -> None:
        pass

    async def __aexit__(self, *_: object) -> None:
        pass

    async def say(self, user: str, text: str) -> None:
        answers = self._answers[user]
        answer = {"count": str(len(answers) + 1), "fail": platforms.PIECE}.get(text, text)
        answers += [answer] * (2 if text == self._doubled else 1)

    async def read(self, user: str, count: int) -> list[str]:
        assert len(self._answers[user]) >= count
        return list(self._answers[user])

    async def kill(self) -> None:
        pass

    async def restart(self) -> None:
        pass


@pytest.mark.parametrize("check", CHECKS)
def test_a_platform_without_faults_passes(check: Callable[[Driver], Awaitable[None]]) -> None:
    async def test() -> None:
        await check(InMemory())

    asyncio.run(test())


class Late(InMemory):
    """A platform that answers the message `doubled` a second time when the next message comes."""

    def __init__(self, doubled: str) -> None:
        super().__init__()
        self._late = doubled
        self._owed: dict[str, str] = {}

    async def say(self, user: str, text: str) -> None:
        if owed := self._owed.pop(user, ""):
            await super().say(user, owed)
        await super().say(user, text)
        if text == self._late:
            self._owed[user] = text


@pytest.mark.parametrize("platform", [InMemory, Late])
@pytest.mark.parametrize(
    ("check", "last"),
    [
        (check_answer, "x" * 3000),
        (check_order, "message 11"),
        (check_users, "count"),
        (check_failure, "fail"),
        (check_restart, "after of emil"),
    ],
)
def test_a_check_fails_if_the_last_message_is_answered_twice(
    check: Callable[[Driver], Awaitable[None]], last: str, platform: Callable[[str], InMemory]
) -> None:
    async def test() -> None:
        with pytest.raises(AssertionError, match="the user should have received"):
            await check(platform(last))

    asyncio.run(test())


class Silent(InMemory):
    """A platform that answers nobody."""

    async def read(self, user: str, count: int) -> list[str]:
        await asyncio.Event().wait()
        return []


def test_the_error_names_the_user_who_gets_no_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(platforms, "PATIENCE", 0.01)
    with pytest.raises(AssertionError, match=r"ada has not received message 1 within 0\.01 s: see whether the agent"):
        asyncio.run(check_answer(Silent()))
