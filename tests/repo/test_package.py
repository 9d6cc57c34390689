"""The built wheel has the right files, version, licence and requirements."""

import email
import importlib.metadata
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

import ravestate

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
NOT_SHIPPED = {".pyc", ".pyo"}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> zipfile.ZipFile:
    """The wheel. It is built without a network, from a copy of the files outside of this checkout."""
    place = tmp_path_factory.mktemp("wheel")
    copy = place / "ravestate"
    copy.mkdir()
    for name in ("pyproject.toml", "README.md", "LICENSE", ".gitignore"):
        shutil.copy(ROOT / name, copy)
    shutil.copytree(ROOT / "src", copy / "src", ignore=shutil.ignore_patterns("__pycache__", "native"))
    run = subprocess.run(
        [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-index", "--no-deps", "--no-build-isolation",
         "--disable-pip-version-check", "--wheel-dir", str(place), str(copy)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert run.returncode == 0, run.stdout + run.stderr
    (built,) = place.glob("*.whl")
    return zipfile.ZipFile(built)


def test_wheel_has_every_file_of_the_package(wheel: zipfile.ZipFile) -> None:
    """These are code and data, such as phrases, model lists, the built user interface and READMEs."""
    source = ROOT / "src"
    wanted = {
        file.relative_to(source).as_posix()
        for file in (source / "ravestate").rglob("*")
        if file.is_file() and file.suffix not in NOT_SHIPPED and not {"__pycache__", "native"} & set(file.parts)
    }
    shipped = {name for name in wheel.namelist() if ".dist-info/" not in name}
    assert shipped == wanted
    assert "ravestate/py.typed" in shipped


def test_wheel_has_licence_and_command(wheel: zipfile.ZipFile) -> None:
    names = {name.partition(".dist-info/")[2]: name for name in wheel.namelist() if ".dist-info/" in name}
    metadata = email.message_from_bytes(wheel.read(names["METADATA"]))
    assert metadata["License-Expression"] == "Apache-2.0 AND MIT AND OFL-1.1"
    assert wheel.read(names["licenses/LICENSE"]) == (ROOT / "LICENSE").read_bytes()
    assert "ravestate = ravestate.__main__:script" in wheel.read(names["entry_points.txt"]).decode()


def test_wheel_has_the_licence_notices_of_all_libraries_and_fonts_in_the_web_pages(wheel: zipfile.ZipFile) -> None:
    texts = [wheel.read(name).decode() for name in wheel.namelist() if ".dist-info/licenses/" in name]
    for notice in ("Svelte Contributors", "Literata Project Authors", "The Inter Project Authors"):
        assert any(notice in text for text in texts), notice


def test_readme_of_the_wheel_has_no_relative_links(wheel: zipfile.ZipFile) -> None:
    """A package index shows this README, and relative links do not work there."""
    (name,) = (name for name in wheel.namelist() if name.endswith(".dist-info/METADATA"))
    links = re.findall(r"\]\(([^)]*)\)", email.message_from_bytes(wheel.read(name)).get_payload())
    assert links
    assert all(link.startswith("https://") for link in links), links


def test_wheel_works_without_the_checkout(wheel: zipfile.ZipFile, tmp_path: Path) -> None:
    """The import finds the built files, because the checkout is not on the path."""
    wheel.extractall(tmp_path)
    probe = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import ravestate; print(ravestate.__file__)"
    run = subprocess.run([sys.executable, "-S", "-c", probe], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    assert Path(run.stdout.strip()).is_relative_to(tmp_path)


def test_versions_agree() -> None:
    assert (
        "version" not in PROJECT and "version" in PROJECT["dynamic"]
    )  # __version__ is the only place where the version is written
    assert ravestate.__version__ == importlib.metadata.version("ravestate")


def test_base_requirements_stay_small() -> None:
    names = {re.split(r"[^\w.-]", requirement, maxsplit=1)[0].lower() for requirement in PROJECT["dependencies"]}
    assert names <= {"pydantic", "pydantic-settings", "pyyaml"}


def requirements_of(name: str, extra: str | None = None) -> set[str]:
    """Return the installed packages that `name` (with `extra`) requires, without `name` itself."""
    found: set[str] = set()
    open_ends = [(name, extra)]
    while open_ends:
        package, wanted = open_ends.pop()
        for line in importlib.metadata.requires(package) or []:
            requirement, _, marker = line.partition(";")
            conditions = re.findall(r"""extra\s*==\s*["']([^"']+)["']""", marker)
            if conditions and wanted not in conditions:
                continue
            parts = re.match(r"\s*([\w.-]+)\s*(?:\[([^\]]*)\])?", requirement)
            assert parts is not None
            needed = parts[1].lower().replace("_", "-")
            try:
                importlib.metadata.version(needed)
            except importlib.metadata.PackageNotFoundError:
                continue  # for another platform or another Python
            if needed not in found or parts[2]:
                found.add(needed)
                open_ends += [(needed, e.strip()) for e in (parts[2] or "").split(",") if parts[2]] or [(needed, None)]
    return found - {name}


@pytest.mark.parametrize("extra", [None, "console", "wildtalk", "chat"])
def test_no_requirement_is_under_the_gpl(extra: str | None) -> None:
    """Neither the base nor the packages of `make chat` have a strong copyleft licence."""
    packages = requirements_of("ravestate", extra)
    assert "pydantic" in packages
    guilty = {}
    for package in sorted(packages):
        about = importlib.metadata.metadata(package)
        licences = " ".join(
            [about.get("License-Expression") or (about.get("License") or "")[:80],
             *(c for c in about.get_all("Classifier") or [] if c.startswith("License"))]
        )  # fmt: skip
        if re.search(r"\bA?GPL|Affero|GNU General Public", licences):
            guilty[package] = licences
    assert not guilty
