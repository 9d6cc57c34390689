"""`import ravestate` loads no third-party package and no event loop, starts no thread, and logs nothing."""

import json
import subprocess
import sys

import pytest

PROBE = """
import json, logging, sys, threading, warnings

before = set(sys.modules)
handlers, filters = list(logging.root.handlers), list(warnings.filters)
hooks = sys.excepthook, sys.displayhook, sys.breakpointhook
import {module}
print(json.dumps({{
    "loaded": sorted(set(sys.modules) - before),
    "threads": threading.active_count(),
    "handlers": len(logging.root.handlers) - len(handlers),
    "filters": len(warnings.filters) - len(filters),
    "hooks": hooks == (sys.excepthook, sys.displayhook, sys.breakpointhook),
}}))
"""


def loaded_by(module: str) -> dict[str, object]:
    """Import `module` in a new interpreter, and return the side effects of the import."""
    run = subprocess.run(
        [sys.executable, "-c", PROBE.format(module=module)], capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr
    assert run.stderr == "", run.stderr
    return json.loads(run.stdout)


def test_import_loads_no_third_party_package() -> None:
    found = loaded_by("ravestate")
    tops = {name.partition(".")[0] for name in found["loaded"]}  # type: ignore[attr-defined]
    assert tops - sys.stdlib_module_names - {"ravestate"} == set()


def test_import_loads_no_event_loop() -> None:
    assert "asyncio" not in loaded_by("ravestate")["loaded"]  # type: ignore[operator]


def test_import_has_no_side_effects() -> None:
    found = loaded_by("ravestate")
    assert (found["threads"], found["handlers"], found["filters"], found["hooks"]) == (1, 0, 0, True)


@pytest.mark.parametrize("package", ["declare", "policy", "engine", "errors"])
def test_pure_packages_load_nothing_impure(package: str) -> None:
    """Indirect imports count, too. The event loop and the thread pool belong to `runtime`."""
    loaded = set(loaded_by(f"ravestate.{package}")["loaded"])  # type: ignore[call-overload]
    assert not loaded & {"asyncio", "concurrent.futures", "queue", "pydantic", "yaml", "ravestate.runtime"}
