"""The engine reports only signals that have a listener."""

import asyncio
from typing import Any

import pytest

from ravestate.engine.effects import Spiked
from ravestate.runtime.listeners import Listeners
from runtime.on_loop import on_loop, turns


@on_loop
async def test_a_signal_is_watched_while_a_task_waits_for_it() -> None:
    watched: dict[str, int] = {}
    listeners = Listeners(watched, {})
    one, other = (asyncio.create_task(listeners.next("m:s")) for _ in range(2))
    await turns(1)
    assert watched == {"m:s": 1}
    one.cancel()
    await turns()
    assert watched == {"m:s": 1}
    listeners.tell(Spiked("m:s", 7))
    assert await other == 7 and watched == {}


@on_loop
async def test_a_cancelled_task_no_longer_watches_its_signal() -> None:
    watched: dict[str, int] = {}
    task = asyncio.create_task(Listeners(watched, {}).next("m:s"))
    await turns(1)
    task.cancel()
    await turns()
    assert task.cancelled() and watched == {}


@on_loop
async def test_a_function_hears_every_spike_and_remains_a_listener() -> None:
    watched: dict[str, int] = {}
    heard: list[Any] = []
    listeners = Listeners(watched, {"m:s": heard.append})
    waiting = asyncio.create_task(listeners.next("m:s"))
    await turns(1)
    for value in range(3):
        listeners.tell(Spiked("m:s", value))
    assert heard == [0, 1, 2] and await waiting == 0 and watched == {"m:s": 1}


@on_loop
async def test_tasks_that_wait_get_an_error_that_names_their_signal() -> None:
    listeners = Listeners({}, {})
    waiting = asyncio.create_task(listeners.next("m:s"))
    await turns(1)
    listeners.fail(LookupError)
    with pytest.raises(LookupError, match="m:s"):
        await waiting
