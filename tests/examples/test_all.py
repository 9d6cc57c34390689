"""Every example is short, says how to start it, and has no faults and no rule that can never run or win."""

import ast
import inspect

import pytest

import ravestate as rs
from examples.loading import FOLDER, example
from ravestate.policy.findings import BREAKING

NAMES = sorted(file.stem for file in FOLDER.glob("*.py"))


@pytest.mark.parametrize("name", NAMES)
def test_each_example_compiles_and_every_rule_can_run_and_win(name: str) -> None:
    kinds = {finding.kind for finding in rs.compile(example(name)).findings(inspect.getsource)}
    assert not kinds & {"unreachable", "never-wins", *BREAKING}


@pytest.mark.parametrize("name", NAMES)
def test_each_example_is_short_and_says_how_to_start_it(name: str) -> None:
    source = (FOLDER / f"{name}.py").read_text(encoding="utf-8")
    said = ast.get_docstring(ast.parse(source)) or ""
    assert f"python examples/{name}.py" in said
    assert len(source.splitlines()) <= 100
