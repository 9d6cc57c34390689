"""The documentation is complete: its pages are linked, and it lists all commands, extras and models."""

import re
import tomllib
from pathlib import Path

from ravestate.cli import COMMANDS

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"


def text_of(path: str) -> str:
    return (ROOT / path).read_text(encoding="utf-8")


def test_the_first_page_leads_to_every_other_page() -> None:
    linked = set(re.findall(r"\]\(([\w/.-]+\.md)\)", text_of("docs/index.md")))
    pages = {page.relative_to(DOCS).as_posix() for page in DOCS.rglob("*.md")}
    # a reader reaches the pages of the reference through the index of the reference
    of_the_reference = {page for page in pages if page.startswith("reference/")}
    assert linked == pages - of_the_reference - {"index.md"} | {"reference/index.md"}


def test_every_link_has_a_target() -> None:
    made = re.compile(r"reference/(?:modules/)?[\w-]+\.md$")  # tools/docs.py writes this file
    broken: list[str] = []
    for page in [ROOT / "README.md", *sorted(DOCS.rglob("*.md"))]:
        text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
        for link in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", text):
            target = (page.parent / link).resolve()
            if not target.exists() and not made.search(str(target)):
                broken.append(f"{page.relative_to(ROOT)}: {link}")
    assert not broken, "\n".join(broken)


def test_the_reference_names_every_command() -> None:
    assert set(re.findall(r"`ravestate (\w+)", text_of("docs/reference/index.md"))) >= set(COMMANDS)


def test_the_readme_is_about_a_page_long() -> None:
    before, _, _ = text_of("README.md").partition("## Where to read on")
    assert len(before.split()) <= 700


def test_the_page_about_installing_lists_every_extra() -> None:
    extras = set(tomllib.loads(text_of("pyproject.toml"))["project"]["optional-dependencies"])
    page = text_of("docs/how-to/install-it-in-a-project.md")
    assert set(re.findall(r"^\| `([\w-]+)` \|", page, re.MULTILINE)) == extras - {"dev", "docs"}


def test_the_pages_name_the_models_that_the_makefile_installs() -> None:
    found = re.search(r"^SENTENCES := (.*)$", text_of("Makefile"), re.MULTILINE)
    assert found is not None
    page = text_of("docs/how-to/install-it-in-a-project.md")
    assert re.findall(r"pip install --no-deps (\S+)", page) == found[1].split()
    told = re.findall(r"--no-deps (\S+==[\d.]+)", text_of("docs/how-to/answer-from-documents.md"))
    assert set(told) <= set(found[1].split())
