"""The vectors that ship: each built-in example has one, so that a first start encodes nothing."""

import importlib.util
from pathlib import Path

TOOL = Path(__file__).parents[2] / "tools" / "vectors.py"


def test_each_built_in_example_has_a_vector_and_each_vector_an_example() -> None:
    spec = importlib.util.spec_from_file_location("vectors", TOOL)
    assert spec is not None
    assert spec.loader is not None
    tool = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tool)
    assert tool.main(["--check"]) == 0, "run: python tools/vectors.py"
