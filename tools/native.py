"""Compile the modules that every event passes through, with mypyc: ``python tools/native.py`` (``--help`` for more).

mypyc takes the types from the annotations, so the source stays plain Python. `ravestate.compiled` says how the compiled
modules are found. The same code is a build hook of hatchling, for wheels with compiled modules.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "src" / "ravestate"

COLD = ("__init__", "events", "explain", "reasons", "snapshot", "trace")
"""The modules of the engine that stay interpreted: they are for records and explanations."""

MODULES = (
    *sorted(f"engine/{file.name}" for file in (SOURCE / "engine").glob("*.py") if file.stem not in COLD),
    *(f"policy/{name}.py" for name in ("causes", "components", "model")),
    *(f"runtime/{name}.py" for name in (
        "async_rules", "blocking", "clock", "eager_task", "functions", "listeners", "rule_context", "runner", "spares", "timer", "waits",
    )),
)  # fmt: skip
"""The compiled modules. They are compiled together, because compiled modules reach each other's objects without a
look-up."""


FLAGS = "-O2 -g0 -w -fno-semantic-interposition -fvisibility=hidden"
"""The options of the C compiler. Without the last two options, another library could replace each function, so each
call between the modules would take longer."""


def load_compiled() -> Any:
    """Return the module ``ravestate.compiled`` of this checkout, without an import of the package."""
    spec = importlib.util.spec_from_file_location("compiled", SOURCE / "compiled.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def is_fresh(compiled: Any) -> bool:
    """Return whether the compiled modules are those of the present sources."""
    with contextlib.suppress(OSError):
        return Path(compiled.STAMP).read_text(encoding="utf-8").split() == [compiled.checksum(MODULES), *MODULES]
    return False


def compile_modules() -> Path:
    """Compile the modules, unless they are compiled already; return the folder with the compiled modules."""
    compiled = load_compiled()
    place = Path(compiled.PLACE)
    if is_fresh(compiled):
        return place
    from mypyc.build import mypycify
    from setuptools import Distribution

    stamp = "\n".join([compiled.checksum(MODULES), *MODULES, ""])
    before = Path.cwd()
    os.chdir(ROOT)
    try:
        with tempfile.TemporaryDirectory() as temporary:
            os.environ["CFLAGS"] = f"{os.environ.get('CFLAGS', '')} {FLAGS}"
            extensions = mypycify(
                [
                    "--config-file=pyproject.toml",
                    f"--cache-dir={temporary}/cache",
                    *(f"src/ravestate/{m}" for m in MODULES),
                ],
                opt_level="2",
                debug_level="0",
                target_dir=f"{temporary}/c",
                group_name="ravestate.native",
            )
            distribution = Distribution({"name": "ravestate", "ext_modules": extensions})
            build = distribution.get_command_obj("build_ext")
            build.build_lib, build.build_temp = f"{temporary}/lib", f"{temporary}/o"
            build.ensure_finalized()
            build.run()
            shutil.rmtree(place, ignore_errors=True)
            shutil.copytree(f"{temporary}/lib/ravestate", place)
    finally:
        os.chdir(before)
    Path(compiled.STAMP).write_text(stamp, encoding="utf-8")
    return place


class Hook(BuildHookInterface):
    """Adds the compiled modules to a wheel. Off by default; ``HATCH_BUILD_HOOKS_ENABLE=1`` turns it on."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile the modules before the wheel is made."""
        place = compile_modules()
        if version != "editable":
            build_data["pure_python"] = False
            build_data["infer_tag"] = True
            inside = Path("ravestate/native", place.name)
            build_data["force_include"] |= {
                str(file): str(inside / file.relative_to(place)) for file in place.rglob("*") if file.is_file()
            }


def can_compile() -> bool:
    """Return whether there is a C compiler and Python's headers; on Debian, install them first."""
    command = (os.environ.get("CC") or sysconfig.get_config_var("CC") or "cc").split()[0]
    headers = Path(sysconfig.get_path("include"), "Python.h")
    if not (shutil.which(command) and headers.exists()):
        packages = ["gcc", "libc6-dev"] + ["python3-dev"] * sysconfig.get_path("include").startswith("/usr/include")
        subprocess.run([ROOT / "tools" / "debian", "Compiling the engine", *packages], check=False)
    return bool(shutil.which(command)) and headers.exists()


def try_to_compile() -> None:
    """Compile the modules in place if that is possible; if not, say why the sources run as pure Python."""
    if is_fresh(load_compiled()):
        return
    why = "there is no C compiler, or Python's headers are missing"
    if can_compile():
        print("Compiling the engine (about a minute) ...", flush=True)
        log = ROOT / ".venv" / "native.log"
        with log.open("w", encoding="utf-8") as file:
            done = subprocess.run([sys.executable, __file__], stdout=file, stderr=file, check=False)
        if not done.returncode:
            return
        why = f"compiling failed, see {log.relative_to(ROOT)}"
    print(f"The engine runs as pure Python, which is slower: {why}.")


def main() -> int:
    """Compile the modules in place; exit code 1 if that fails."""
    parser = argparse.ArgumentParser(
        description="Compile the modules that every event passes through, unless they are compiled already."
    )
    parser.add_argument("--check", action="store_true", help="only say, by exit code 0 or 1, whether they are compiled")
    parser.add_argument(
        "--try", action="store_true", dest="soft", help="if compiling is impossible, say so, and end with exit code 0"
    )
    parser.add_argument("--remove", action="store_true", help="remove the compiled modules, for all interpreters")
    options = parser.parse_args()
    if options.check:
        return not is_fresh(load_compiled())
    if options.remove:
        shutil.rmtree(SOURCE / "native", ignore_errors=True)
        return 0
    if options.soft:
        try_to_compile()
        return 0
    compile_modules()
    return 0


if __name__ == "__main__":
    sys.exit(main())
