"""Hooks of the documentation's build: the order of pages, and the reference made from docstrings.

Within a section, pages are sorted by the `order:` of their front matter (10 if there is none), and then by name.
The reference has a page for each part of the public interface, and one for each built-in module: its README, and then
its docstrings. The build reads the source and imports nothing.
"""

import ast
import re
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "ravestate"
SECTIONS = {
    "tutorial": "Tutorial",
    "how-to": "How to",
    "explanation": "Explanation",
    "reference": "Reference",
}
PARTS = {
    "declare": "Declaring",
    "settings": "Settings",
    "policy": "Knowing before running",
    "runtime": "Running",
    "testing": "Testing",
    "errors": "Errors",
    "engine": "The engine",
    "board": "Raveboard",
    "serve": "Serving",
    "study": "Studies",
}
READING_ORDER = {
    "declare": ["module", "signal", "slot", "condition", "rule", "outcome", "settings", "core"],
    "policy": ["compile", "policy", "model", "conflicts", "findings"],
    "runtime": ["run", "context", "rule_context", "journal"],
    "testing": ["simulation"],
    "engine": ["trace", "explain", "snapshot", "engine", "events", "effects", "activation"],
}
"""The public files of a part, in reading order. A part without an entry shows all its files, by name."""
KINDS = {"modality": "Modalities", "meta": "Meta modules", "skill": "Skills", "platform": "Platforms"}


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Fill the navigation from the folders."""
    docs = Path(config.docs_dir)
    nav: list[object] = [{"Home": "index.md"}] if (docs / "index.md").exists() else []
    for folder, title in SECTIONS.items():
        pages: list[object] = [path.relative_to(docs).as_posix() for path in _in_order(docs / folder)]
        if folder == "reference":
            pages += [{PARTS[part]: f"reference/{part}.md"} for part in _parts()]
            for kind, kind_title in KINDS.items():
                if modules := _modules(kind):
                    pages.append({kind_title: [{name: f"reference/modules/{name}.md"} for name in modules]})
        if pages:
            nav.append({title: pages})
    config.nav = nav
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the reference's pages."""
    for part in _parts():
        files.append(_page(config, f"reference/{part}.md", f"# {PARTS[part]}\n\n" + _reference(part)))
    for kind in KINDS:
        for name in _modules(kind):
            readme = SOURCE / "modules" / kind / name / "README.md"
            text = readme.read_text(encoding="utf-8").rstrip() if readme.exists() else f"# {name}"
            dotted = f"ravestate.modules.{kind}.{name}"
            files.append(
                _page(
                    config,
                    f"reference/modules/{name}.md",
                    f"{text}\n\n## Reference\n\n::: {dotted}\n    options:\n      filters: public\n",
                )
            )
    return files


def _page(config: MkDocsConfig, uri: str, text: str) -> File:
    return File.generated(config, uri, content=text)


def _parts() -> list[str]:
    return [part for part in PARTS if (SOURCE / part).is_dir() or (SOURCE / f"{part}.py").exists()]


def _modules(kind: str) -> list[str]:
    return sorted(place.parent.name for place in (SOURCE / "modules" / kind).glob("[!_]*/__init__.py"))


def _reference(part: str) -> str:
    """Return the docstring of a package, and one directive for each of its files."""
    if not (SOURCE / part).is_dir():
        return f"::: ravestate.{part}\n"
    room = SOURCE / part
    said = ast.get_docstring(ast.parse((room / "__init__.py").read_text(encoding="utf-8"))) or ""
    found = sorted(file.stem for file in room.glob("*.py") if not file.stem.startswith("_"))
    text = f"{said}\n\n"
    for name in READING_ORDER.get(part, found):
        text += f"## `{part}.{name}`\n\n::: ravestate.{part}.{name}\n    options:\n      heading_level: 3\n      filters: public\n      show_signature_annotations: true\n\n"
    return text


def _in_order(folder: Path) -> list[Path]:
    def place(page: Path) -> tuple[bool, float, str]:
        head = re.match(r"---\n(.*?)\n---\n", page.read_text(encoding="utf-8"), re.DOTALL)
        order = re.search(r"^order:\s*([\d.]+)\s*$", head[1], re.MULTILINE) if head else None
        return page.stem != "index", float(order[1]) if order else 10.0, page.stem

    return sorted(folder.rglob("*.md"), key=place)
