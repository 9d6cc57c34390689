"""The package runs as a command: ``python -m ravestate``."""

import subprocess
import sys

import pytest

import ravestate as rs
from ravestate import compiled


def test_python_m_ravestate_runs_the_command() -> None:
    run = subprocess.run([sys.executable, "-m", "ravestate", "--version"], capture_output=True, text=True, check=False)
    assert (run.returncode, run.stdout.strip()) == (0, f"ravestate {rs.__version__} ({compiled.build()})")


INTERRUPTED = """
import sys

class Interrupt:
    def find_spec(self, name, path=None, target=None):
        if name == sys.argv[1]:
            raise KeyboardInterrupt

sys.meta_path.insert(0, Interrupt())
from ravestate.__main__ import script
sys.argv[1:] = ["check", "rawio"]
sys.exit(script())
"""


@pytest.mark.parametrize("during", ["ravestate.cli", "ravestate.cli.check"])
def test_ctrl_c_during_the_imports_gives_exit_code_130_without_a_traceback(during: str) -> None:
    program = INTERRUPTED.replace("sys.argv[1]:", f"{during!r}:")
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert (run.returncode, run.stderr) == (130, "")
