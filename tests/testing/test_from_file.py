"""``simulate.from_file`` simulates the agent of an agent file."""

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from ravestate.errors import DeclarationErrors, UsageError
from ravestate.modules import rawio
from ravestate.testing import simulate

CLERK = """
import ravestate as rs
from ravestate.modules import rawio

class Settings(rs.Settings):
    greeting: str = "Good morning."
    pause: float = 1.0

module = rs.Module("clerk", requires=[rawio], settings=Settings)
till = module.flag("till")

@module.rule(when=rawio.input.changed, writes=rawio.output)
async def greet(ctx):
    await ctx.sleep(ctx.settings.pause)
    ctx[rawio.output] = f"{ctx.settings.greeting} {ctx.random.randrange(10**6)}"

@module.rule(when=till.true, writes=rawio.output)
async def print_receipt(ctx):
    ctx[rawio.output] = "Your receipt, please."
"""
AGENT = """
modules: [conio, ./clerk.py]
settings:
  conio: {prompt: "> "}
  clerk: {greeting: "${WORD:-Hello.}", pause: 2}
"""


@pytest.fixture
def agent(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    (tmp_path / "clerk.py").write_text(CLERK, encoding="utf-8")
    (tmp_path / "agent.yaml").write_text(AGENT, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    yield tmp_path / "agent.yaml"
    sys.modules.pop("clerk", None)


def greeting(path: Path, **options: object) -> str:
    with simulate.from_file(path, **options) as sim:  # type: ignore[arg-type]
        sim.say("Hello")
        sim.advance(2.0)
        (said,) = sim.said
        return said


def test_a_simulation_has_the_modules_and_settings_of_the_file(agent: Path) -> None:
    with simulate.from_file(str(agent)) as sim:
        sim.say("Hello")
        sim.advance(1.9)
        assert sim.said == []
        sim.advance(0.1)
        assert sim.said[0].startswith("Hello. ")
        assert sim.fired == ["clerk:greet"]


def test_a_simulation_leaves_out_the_platforms_of_the_file(agent: Path) -> None:
    with simulate.from_file(agent) as sim:
        assert [module.name for module in sim.context.policy.modules] == ["core", "rawio", "clerk"]


def test_settings_in_code_override_the_environment_which_overrides_the_file(
    agent: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("WORD", "Servus.")
    assert greeting(agent).startswith("Servus. ")
    monkeypatch.setenv("RAVESTATE_CLERK_GREETING", "Moin.")
    assert greeting(agent).startswith("Moin. ")
    assert greeting(agent, settings={"clerk": {"greeting": "Ahoy."}}).startswith("Ahoy. ")


def test_the_seed_comes_from_the_call_or_the_file_or_is_0(agent: Path) -> None:
    usual = greeting(agent)
    assert greeting(agent) == usual == greeting(agent, seed=0)
    agent.write_text(f"{AGENT}\nseed: 7\n", encoding="utf-8")
    assert greeting(agent) == greeting(agent, seed=7) != usual


def test_a_test_can_import_the_slots_of_a_module_of_the_file(agent: Path) -> None:
    clerk = importlib.import_module("clerk")
    with simulate.from_file(agent) as sim:
        sim.put(clerk.till, True)
        assert sim.said == ["Your receipt, please."]
        assert sim.read(rawio.output) == "Your receipt, please."


def test_one_message_lists_all_mistakes_of_the_file(agent: Path) -> None:
    agent.write_text("modules: [rawoi, ./gone.py]\nseed: x\n", encoding="utf-8")
    with pytest.raises(UsageError) as caught:
        simulate.from_file(agent)
    assert [line.partition(" (")[0] for line in str(caught.value).splitlines()] == [
        f"{agent}: seed must be a whole number, not 'x'",
        "there is no module 'rawoi'; did you mean 'rawio'?",
        "there is no file ./gone.py",
    ]
    agent.write_text("modules: [./clerk.py]\nsettings: {clerk: {greeting: [1]}}\n", encoding="utf-8")
    with pytest.raises(DeclarationErrors) as faults:
        simulate.from_file(agent)
    assert "setting clerk.greeting = [1]" in str(faults.value)
