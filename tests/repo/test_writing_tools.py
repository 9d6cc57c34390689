"""The tools that write files do so only without an argument."""

import subprocess
import sys
from pathlib import Path

import pytest

TOOLS = Path(__file__).parents[2] / "tools"


@pytest.mark.parametrize("tool", ["pictures.py", "protocol.py", "vectors.py"])
@pytest.mark.parametrize(("argument", "code"), [("--help", 0), ("--verify", 2)])
def test_a_tool_prints_its_usage_instead_of_writing_files(tool: str, argument: str, code: int) -> None:
    run = subprocess.run([sys.executable, TOOLS / tool, argument], capture_output=True, text=True, check=False)
    assert run.returncode == code
    assert (run.stdout or run.stderr).startswith(f"usage: {tool} [-h] [--check]")
