"""The networks were trained on the sentences in ``tools/networks``."""

import subprocess
import sys
from pathlib import Path

import pytest

TOOLS = Path(__file__).parents[2] / "tools" / "networks"


@pytest.mark.parametrize("command", ["facts.py", "sentences.py answers", "sentences.py kinds", "responses.py"])
def test_a_network_knows_its_sentences(command: str) -> None:
    tool, *name = command.split()
    run = [sys.executable, str(TOOLS / tool), *name, "--check"]
    checked = subprocess.run(run, capture_output=True, text=True, check=False)
    assert checked.returncode == 0, checked.stdout + checked.stderr
