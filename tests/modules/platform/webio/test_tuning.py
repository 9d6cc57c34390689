"""A server changes settings of the Python interpreter for a low latency, and restores them at its end."""

import contextlib
import gc
import sys

import pytest

from modules.platform.webio.visit import parrot
from ravestate.modules import webio
from ravestate.modules.platform.webio.server import COLLECT, SWITCH, Server, low_latency
from ravestate.runtime.agent import Agent
from runtime.on_loop import on_loop


def setting() -> tuple[float, tuple[int, int, int]]:
    return sys.getswitchinterval(), gc.get_threshold()


OURS = (pytest.approx(SWITCH), COLLECT)


def test_the_settings_are_restored_when_the_last_context_manager_ends() -> None:
    before = setting()
    first, second = contextlib.ExitStack(), contextlib.ExitStack()
    first.enter_context(low_latency())
    second.enter_context(low_latency())
    assert setting() == OURS
    first.close()
    assert setting() == OURS
    second.close()
    assert setting() == before


def test_the_settings_are_restored_after_a_failure() -> None:
    before = setting()
    with pytest.raises(OSError, match="the disk"), low_latency():
        raise OSError("the disk")
    assert setting() == before


@on_loop
async def test_a_server_tunes_the_interpreter_while_it_runs() -> None:
    before = setting()
    async with Server(Agent(parrot, webio, settings={"webio": {"port": 0}})):
        assert setting() == OURS
    assert setting() == before
