"""Run every Python block of README.md and docs/; see `snippets.py` for the rules."""

import contextlib
import inspect
import sys
from pathlib import Path

import pytest

import ravestate as rs
from ravestate.policy.findings import BREAKING
from repo.snippets import Block, Page, blocks_in

ROOT = Path(__file__).parents[2]
FILES = [
    ROOT / "README.md",
    *sorted((ROOT / "docs").rglob("*.md")),
    *sorted((ROOT / "src").rglob("README.md")),
]
BLOCKS = [block for file in FILES if file.exists() for block in blocks_in(file) if block.runs]


def name_of(block: Block) -> str:
    return f"{block.file.relative_to(ROOT)}:{block.line}"


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[Path, Page]:
    return {file: Page(file, tmp_path_factory.mktemp(file.stem)) for file in {b.file for b in BLOCKS}}


@pytest.mark.parametrize("block", BLOCKS, ids=name_of)
def test_a_code_block_of_the_documentation_runs(block: Block, pages: dict[Path, Page]) -> None:
    if block.not_run is not None:
        pytest.skip(f"not run: {block.not_run}")
    pages[block.file].run(block)


@pytest.mark.parametrize("file", sorted({block.file for block in BLOCKS}), ids=lambda file: file.name)
def test_a_page_that_leaves_files_behind_can_be_run_again(file: Path, pages: dict[Path, Page]) -> None:
    page = pages[file]
    page.run(page.blocks[-1])
    if page.leavings():
        again = Page(file, page.folder)
        again.run(again.blocks[-1])


@pytest.mark.parametrize("file", sorted({block.file for block in BLOCKS}), ids=lambda file: file.name)
def test_check_finds_no_fault_in_the_rules_of_the_documentation(file: Path, pages: dict[Path, Page]) -> None:
    page = pages[file]
    page.run(page.blocks[-1])
    for module in {
        v for m in (page.module, *page.files.values()) for v in vars(m).values() if isinstance(v, rs.Module)
    }:
        with contextlib.suppress(rs.DeclarationErrors):  # a page can show a fault on purpose
            findings = rs.compile(module).findings(inspect.getsource)
            assert [str(finding) for finding in findings if finding.kind in BREAKING] == []


# ------------------------------------------------------------------------------- tests of snippets.py


def page_of(tmp_path: Path, text: str) -> Page:
    file = tmp_path / "page.md"
    file.write_text(text, encoding="utf-8")
    (tmp_path / "folder").mkdir()
    return Page(file, tmp_path / "folder")


def test_a_block_can_use_the_names_of_earlier_blocks(tmp_path: Path) -> None:
    page = page_of(tmp_path, "```python\na = 1\n```\nwords\n```py\nassert a == 1\nb = 2\n```\n")
    page.run(page.blocks[-1])
    assert page.module.b == 2


def test_await_is_allowed_at_the_top_level_of_a_block(tmp_path: Path) -> None:
    page = page_of(tmp_path, "```python\nimport asyncio\nawait asyncio.sleep(0)\nc = 3\n```\n")
    page.run(page.blocks[0])
    assert page.module.c == 3


def test_a_block_with_a_title_is_saved_as_a_file(tmp_path: Path) -> None:
    text = '```python title="hello_there.py"\nx = 5\n```\n```yaml title="a/b.yaml"\ny: 6\n```\n'
    page = page_of(
        tmp_path,
        text
        + "```python\nfrom pathlib import Path\nimport hello_there\nz = hello_there.x, Path('a/b.yaml').read_text()\n```\n",
    )
    page.run(page.blocks[-1])
    assert page.module.z == (5, "y: 6\n")
    assert "hello_there" not in sys.modules


def test_a_block_marked_not_run_is_skipped_with_its_reason(tmp_path: Path) -> None:
    page = page_of(tmp_path, "<!-- not run: needs a robot -->\n\n```python\n1 / 0\n```\n```python\nd = 4\n```\n")
    assert [block.not_run for block in page.blocks] == ["needs a robot", None]
    page.run(page.blocks[-1])
    assert page.module.d == 4


def test_blocks_of_other_languages_are_not_run(tmp_path: Path) -> None:
    page = page_of(tmp_path, "```bash\nrm nothing\n```\n````text\n```python\n1/0\n```\n````\n```\nplain\n```\n")
    assert [block.runs for block in page.blocks] == [False, False, False]


def test_a_traceback_shows_the_line_in_the_markdown_file(tmp_path: Path) -> None:
    page = page_of(tmp_path, "# Title\n\n```python\ndef f():\n    raise KeyError('k')\n\nf()\n```\n")
    with pytest.raises(KeyError) as caught:
        page.run(page.blocks[0])
    assert (Path(caught.traceback[-1].path).name, caught.traceback[-1].lineno + 1) == ("page.md", 5)


def test_an_indented_block_is_found(tmp_path: Path) -> None:
    page = page_of(tmp_path, "- item\n\n    ```python\n    if True:\n        e = 1\n    ```\n")
    page.run(page.blocks[0])
    assert page.module.e == 1


def test_a_pycon_block_fails_if_its_output_differs(tmp_path: Path) -> None:
    page = page_of(tmp_path, "```pycon\n>>> g = 7\n>>> g\n7\n```\n```pycon\n>>> g + 1\n9\n```\n")
    page.run(page.blocks[0])
    with pytest.raises(AssertionError, match="Expected"):
        page.run(page.blocks[1])


def test_a_fence_that_is_never_closed_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"page\.md:1: .* never closed"):
        page_of(tmp_path, "```python\nx = 1\n")


def test_tests_on_a_page_run_with_pytest(tmp_path: Path) -> None:
    page = page_of(
        tmp_path,
        '```python title="thing.py"\nsize = 3\n```\n'
        '```python title="test_good.py"\nimport pytest, thing\n\n'
        '@pytest.mark.parametrize("n", [1, 2])\ndef test_size(n, tmp_path):\n    assert n < thing.size\n```\n'
        '```python title="test_bad.py"\nimport thing\n\ndef test_size():\n    assert thing.size == 4\n```\n',
    )
    page.run(page.blocks[1])
    with pytest.raises(AssertionError, match=r"page\.md:\d+:\n(.|\n)*assert 3 == 4"):
        page.run(page.blocks[2])


def test_a_block_with_a_title_has_its_own_namespace_and_can_be_continued(tmp_path: Path) -> None:
    page = page_of(
        tmp_path,
        '```python title="thing.py"\nsize = 3\n```\n'
        '```python title="thing.py, continued"\nassert size == 3\ncolour = "red"\n```\n'
        "```python\nimport thing\nassert (thing.size, thing.colour) == (3, 'red')\n```\n```python\nsize\n```\n",
    )
    page.run(page.blocks[2])
    with pytest.raises(NameError, match="'size' is not defined"):
        page.run(page.blocks[3])


def test_the_leavings_of_a_page_are_the_files_that_its_blocks_have_created(tmp_path: Path) -> None:
    page = page_of(
        tmp_path,
        '```yaml title="a/b.yaml"\ny: 6\n```\n```python\nimport pathlib\npathlib.Path("new").touch()\n```\n',
    )
    page.run(page.blocks[0])
    assert page.leavings() == []
    page.run(page.blocks[1])
    assert page.leavings() == ["new"]


def test_tests_in_a_block_without_a_title_are_refused(tmp_path: Path) -> None:
    page = page_of(tmp_path, "```python\ndef test_nothing():\n    assert False\n```\n")
    with pytest.raises(AssertionError, match=r'page\.md:2: give it title="test_'):
        page.run(page.blocks[0])
