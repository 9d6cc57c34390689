"""The package as a command."""

import subprocess
import sys

import ravestate as rs


def test_the_package_runs_as_a_module() -> None:
    run = subprocess.run([sys.executable, "-m", "ravestate", "--version"], capture_output=True, text=True, check=False)
    assert (run.returncode, run.stdout.strip()) == (0, f"ravestate {rs.__version__}")
