"""The environments of the peers, in a folder that git ignores.

The reference implementation cannot use this project's environment, because both have the same import name. The other
peers have environments of their own as well.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

__all__ = ["clips", "peers", "reference"]

ROOT = Path(__file__).resolve().parent.parent / ".bench"

# The reference is installed without dependencies: PyPI no longer has some of them, and the benchmark does not need the
# others.
REFERENCE = ["--no-deps", "ravestate==0.7.0.post1", "reggol==0.2.0", "pyyaml==6.0.3", "pyyaml-include==1.3.2"]
CLIPS = ["clipspy==1.0.6"]
# experta requires a version of frozendict that does not run on present versions of Python.
PEERS = ["--no-deps", "durable_rules==2.0.28", "experta==1.9.4", "frozendict==2.4.6", "py_trees==2.6.0", "pydot==4.0.1",
         "pyparsing==3.3.3", "schema==0.7.7"]  # fmt: skip


def reference(progress: Callable[[str], None]) -> Path:
    """Return the interpreter that has the reference implementation."""
    return _interpreter("reference", REFERENCE, progress)


def clips(progress: Callable[[str], None]) -> Path:
    """Return the interpreter that has CLIPS."""
    return _interpreter("clips", CLIPS, progress)


def peers(progress: Callable[[str], None]) -> Path:
    """Return the interpreter that has durable_rules, experta and py_trees."""
    return _interpreter("peers", PEERS, progress)


def _interpreter(name: str, requirements: list[str], progress: Callable[[str], None]) -> Path:
    folder = ROOT / name
    python = folder / "bin" / "python"
    stamp = folder / "requirements"
    wanted = "\n".join([sys.version, *requirements])
    if stamp.exists() and stamp.read_text(encoding="utf-8") == wanted and python.exists():
        return python
    packages = " ".join(r for r in requirements if not r.startswith("-"))
    progress(f"once: environment .bench/{name} with {packages}")
    shutil.rmtree(folder, ignore_errors=True)
    ROOT.mkdir(exist_ok=True)
    (ROOT / ".gitignore").write_text("*\n", encoding="utf-8")
    _run(sys.executable, "-m", "venv", "--without-pip", str(folder))
    _run(sys.executable, "-m", "pip", "--quiet", "--python", str(python), "install", *requirements)
    stamp.write_text(wanted, encoding="utf-8")
    return python


def _run(*command: str) -> None:
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)} failed:\n{done.stdout}")
