"""Run tests in a separate environment, and report the result of each test function.

Pipecat and LiveKit each need their own environment, `.venvs/NAME`, which `make test` creates. Their tests are in
`cases/NAME_cases.py`. The pytest of the main environment does not collect these files.
"""

import ast
import os
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest

ROOT = Path(__file__).parents[2]
CASES = Path(__file__).with_name("cases")

Failures = dict[str, list[str]]
"""For the name of each test function: a message for each of its runs, which is empty if the run passed."""


def names_in(name: str) -> list[str]:
    """Return the names of the test functions in a file of cases."""
    tree = ast.parse((CASES / f"{name}_cases.py").read_text(encoding="utf-8"))
    functions = [node.name for node in tree.body if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))]
    return [function for function in functions if function.startswith("test_")]


def run_apart(name: str, folder: Path) -> Failures:
    """Run `cases/NAME_cases.py` in the environment of that name. Write the report to `folder`."""
    python = ROOT / ".venvs" / name / "bin" / "python"
    if not python.exists():
        pytest.fail(f"there is no {python.relative_to(ROOT)}: `make test` creates it", pytrace=False)
    report = folder / "report.xml"
    environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST")}
    environment["PYTHONPATH"] = os.pathsep.join(map(str, (ROOT / "src", CASES)))
    options = ["-c", os.devnull, "--rootdir", CASES, "--confcutdir", CASES, "-p", "no:cacheprovider", "--tb", "short"]
    run = subprocess.run(
        [python, "-m", "pytest", *options, "--junitxml", report, CASES / f"{name}_cases.py"],
        cwd=ROOT, env=environment, capture_output=True, text=True, timeout=240, check=False,
    )  # fmt: skip
    if not report.exists():
        pytest.fail(f"{run.stdout}{run.stderr}", pytrace=False)
    failures: Failures = {}
    for case in ElementTree.parse(report).iter("testcase"):
        bad = [element for element in case if element.tag in ("failure", "error", "skipped")]
        message = "\n".join(f"{case.get('name')}: {element.get('message')}\n{element.text}" for element in bad)
        failures.setdefault(str(case.get("name")).partition("[")[0], []).append(message)
    return failures
