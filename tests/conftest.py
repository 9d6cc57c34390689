"""Settings and fixtures for all tests: a temporary data folder, and the profiles of Hypothesis.

- `ci` (the default of `make test` and of continuous integration): the same examples each time, so that only a change of
  the code can cause a failure.
- `dev` (the default of a bare `pytest`): new examples each time. Hypothesis remembers those that fail.
- `fuzz` (`make fuzz`): many new examples each time.

The variable `HYPOTHESIS_PROFILE` chooses a profile. No profile has a deadline, because benchmarks measure time.
"""

import contextlib
import ctypes
import functools
import gc
import os
import tempfile
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

# Each test process has one core, so several threads for a matrix product would only wait for each other.
for _library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{_library}_NUM_THREADS", "1")

# Keep freed memory in the test process, because the next test with models needs it again. These numbers set
# M_TRIM_THRESHOLD and M_MMAP_THRESHOLD of glibc's malloc.h to their maxima (bytes).
with contextlib.suppress(AttributeError, OSError, TypeError):
    _malloc = ctypes.CDLL(None)
    _malloc.mallopt(-1, 2**31 - 1)
    _malloc.mallopt(-3, 32 * 2**20)

_folder = tempfile.TemporaryDirectory(prefix="ravestate-tests-")
os.environ["XDG_DATA_HOME"] = _folder.name  # the commands that tests start also use this folder
os.environ["RAVESTATE_WILDTALK_SEARCH"] = "false"  # no test looks at the ports and folders of this machine

_shared = {
    "deadline": None,
    "print_blob": True,
    "suppress_health_check": [HealthCheck.too_slow],
}
settings.register_profile("dev", max_examples=100, **_shared)
settings.register_profile("ci", max_examples=100, derandomize=True, database=None, **_shared)
settings.register_profile("fuzz", max_examples=5_000, **_shared)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE") or ("ci" if "CI" in os.environ else "dev"))

TESTS = Path(__file__).parent
FIRST = ("quality", "properties", "end_to_end", "bridges", "modules", "examples", "cli", "repo", "board", "draw")
"""The folders with the slowest tests, which run first."""
REAL = ("end_to_end", "bridges", "modules/platform")
"""The folders whose tests need a browser, a server or a robot in real time. A busy machine can stall these programs
for seconds, so continuous integration runs a failing test a second time. The report names such tests."""


SERVERS = {"matrixio": "a homeserver", "ros": "two networks", "roboyio": "two networks"}
"""For the folder of a platform: the servers that its tests need, which start slowly."""


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Run all files that share servers in one process, so that each server starts only once."""
    from xdist.scheduler import LoadFileScheduling

    class Scheduling(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            file = super()._split_scope(nodeid)
            _, _, place = file.partition("/platform/")
            return SERVERS.get(place.partition("/")[0], file)

    return Scheduling(config, log) if config.getvalue("dist") == "loadfile" else None


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Run files that take long first, so that the processes of `make test` end at about the same time."""

    @functools.cache  # thousands of tests are in hundreds of files
    def rank(file: Path) -> int:
        folders = [place.name for place in file.parents if place.parent == TESTS]
        return FIRST.index(folders[0]) if folders and folders[0] in FIRST else len(FIRST)

    items.sort(key=lambda item: rank(item.path))
    if "CI" in os.environ and config.pluginmanager.hasplugin("rerunfailures"):
        for item in items:
            if any(item.path.is_relative_to(TESTS / folder) for folder in REAL):
                item.add_marker(pytest.mark.flaky(reruns=1))


@pytest.fixture(scope="module", autouse=True)
def small_heap() -> None:
    """Exclude all objects that exist before a file's tests from garbage collection.

    Otherwise, each collection would visit the tests, the modules and the models. This would take a third of the time.
    """
    gc.collect()
    gc.freeze()


@pytest.fixture
def chat_server() -> Any:
    """The class `ChatServer`: a server that speaks OpenAI's protocol."""
    from chat_server import ChatServer

    return ChatServer
