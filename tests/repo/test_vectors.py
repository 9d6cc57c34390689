"""The package has a vector for each built-in example, so that the first start does not have to encode it."""

import subprocess
import sys
from pathlib import Path

TOOL = Path(__file__).parents[2] / "tools" / "vectors.py"


def test_each_built_in_example_has_a_vector_and_each_vector_an_example() -> None:
    """The tool runs in a separate process, in which nothing is loaded yet."""
    checked = subprocess.run([sys.executable, str(TOOL), "--check"], capture_output=True, text=True, check=False)
    assert checked.returncode == 0, checked.stdout + checked.stderr
