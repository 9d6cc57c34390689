"""Find and run the code blocks of a Markdown file, so that the documentation works.

The rules for authors of documentation:

- The tests run each ```` ```python ```` block. The blocks of one page share a namespace, so later blocks may use names
  of earlier blocks. `await` and `async with` are allowed at the top level.
- The tests also run each ```` ```pycon ```` block, and compare the output with the block.
- A block of any language with `title="hello.py"` is also saved under that name, in the folder in which all blocks of the
  page run. A later block can read, import or run the file. The block has its own namespace: later blocks import its
  names. `title="hello.py, continued"` adds to the file.
- If a block's title begins with `test_`, pytest runs the block too, as a reader would. A block with functions `test_*`
  must have such a title, because otherwise no code would call them.
- A block right under `<!-- in: pipecat -->` runs in the environment `.venvs/pipecat`, in a separate process. If a
  test on the page imports the block, that test runs it.
- The tests skip a block right under `<!-- not run: the reason -->`, and show the reason. Use this rarely.
- The tests do not run blocks of other languages (`bash`, `console`, `yaml`, `text`, ...).
"""

from __future__ import annotations

import ast
import asyncio
import contextlib
import doctest
import inspect
import os
import re
import subprocess
import sys
import textwrap
import types
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

FENCE = re.compile(r"(?P<indent>[ \t]*)(?P<fence>`{3,}|~{3,})[ \t]*(?P<info>[^`]*)")
NOT_RUN = re.compile(r"\s*<!--\s*not run:\s*(?P<reason>.*?)\s*-->\s*")
APART = re.compile(r"\s*<!--\s*in:\s*(?P<environment>\w+)\s*-->\s*")
ENVIRONMENTS = Path(__file__).parents[2] / ".venvs"
TITLE = re.compile(r"""title=(?P<quote>["'])(?P<title>.*?)(?P=quote)""")
LANGUAGES = {"python": "python", "py": "python", "python3": "python", "pycon": "pycon"}


@dataclass(frozen=True, slots=True)
class Block:
    """A fenced block; `line` is the number of its first line of code, counted from 1."""

    file: Path
    line: int
    language: str
    code: str
    title: str | None
    not_run: str | None
    environment: str | None = None

    @property
    def runs(self) -> bool:
        """Whether the tests run blocks of this language. The page can still give a reason to skip this block."""
        return self.language in LANGUAGES

    @property
    def has_tests(self) -> bool:
        """Whether the block has functions that only pytest calls."""
        return re.search(r"^(?:async )?def test_", self.code, re.MULTILINE) is not None

    def __str__(self) -> str:
        return f"{self.file.name}:{self.line}"


def blocks_in(file: Path) -> list[Block]:
    """Return the fenced blocks of `file` in order. Raise a ValueError if a fence is never closed."""
    found: list[Block] = []
    lines = iter(enumerate(file.read_text(encoding="utf-8").splitlines(), start=1))
    reason: str | None = None
    environment: str | None = None
    for number, line in lines:
        if opening := FENCE.fullmatch(line):
            fence, info = opening["fence"], opening["info"]
            closing = re.compile(rf"[ \t]*{re.escape(fence[0])}{{{len(fence)},}}[ \t]*")
            code: list[str] = []
            for _, inner in lines:
                if closing.fullmatch(inner):
                    break
                code.append(inner)
            else:
                raise ValueError(f"{file}:{number}: this code block is never closed")
            title = TITLE.search(info)
            language = re.match(r"[{.\s]*([\w+-]*)", info)
            found.append(
                Block(
                    file=file,
                    line=number + 1,
                    language=(language[1] if language else "").lower(),
                    code=textwrap.dedent("\n".join(code)) + "\n",
                    title=title["title"] if title else None,
                    not_run=reason,
                    environment=environment,
                )
            )
            reason = environment = None
        elif apart := APART.fullmatch(line):
            environment = apart["environment"]
        elif comment := NOT_RUN.fullmatch(line):
            reason = comment["reason"] or "no reason given"
        elif line.strip():
            reason = environment = None
    return found


@dataclass
class Page:
    """The blocks of a file, and the state that they share: a namespace and a folder."""

    file: Path
    folder: Path
    blocks: list[Block] = field(default_factory=list)
    module: types.ModuleType = field(init=False)
    files: dict[str, types.ModuleType] = field(default_factory=dict)
    done: int = 0

    def __post_init__(self) -> None:
        self.blocks = self.blocks or blocks_in(self.file)
        self.module = self._namespace("")

    def run(self, block: Block) -> None:
        """Run the earlier blocks that have not run yet, and then `block`. Raise the exception that a block raises."""
        while self.done <= self.blocks.index(block):
            current = self.blocks[self.done]
            self.done += 1
            with self._at_home():  # import each file again, because a later block can have added to it
                self._run_next(current)

    def _run_next(self, block: Block) -> None:
        file = save(block, self.folder)
        if not block.runs or block.not_run is not None:
            return
        if block.environment is not None:
            if not self._is_imported(file):
                run_apart(block, self.folder)
            return
        module = self.files.setdefault(file, self._namespace(file)) if file else self.module
        with self._known(module):
            (run_pycon if LANGUAGES[block.language] == "pycon" else run_python)(block, module)
        if block.has_tests:
            run_tests(block, self.folder)

    def _is_imported(self, file: str) -> bool:
        """Return whether a test in another environment imports a file."""
        line = rf"^(?:from|import) {re.escape(file.removesuffix('.py'))}\b"
        tests = [block for block in self.blocks if block.environment is not None and block.has_tests]
        return bool(file) and any(re.search(line, test.code, re.MULTILINE) for test in tests)

    def leavings(self) -> list[str]:
        """Return the files that the blocks have created, except the files on the page."""
        made = [path.relative_to(self.folder) for path in self.folder.rglob("*") if path.is_file()]
        shown = {(block.title or "").removesuffix(", continued") for block in self.blocks}
        return sorted(str(path) for path in made if str(path) not in shown and "__pycache__" not in path.parts)

    def _namespace(self, file: str) -> types.ModuleType:
        module = types.ModuleType("snippets_of_" + re.sub(r"\W", "_", f"{self.file.stem}_{file}".rstrip("_")))
        module.__file__ = str(self.file)
        return module

    @contextlib.contextmanager
    def _known(self, module: types.ModuleType) -> Iterator[None]:
        """Make the module available by its name, as pickle and pydantic require."""
        sys.modules[module.__name__] = module
        try:
            yield
        finally:
            del sys.modules[module.__name__]

    @contextlib.contextmanager
    def _at_home(self) -> Iterator[None]:
        """Work in the page's folder, and import from it."""
        for file in self.folder.glob("*.py"):  # another test can have imported a different file with this name
            sys.modules.pop(file.stem, None)
        before, path, known = Path.cwd(), list(sys.path), set(sys.modules)
        os.chdir(self.folder)
        sys.path.insert(0, str(self.folder))
        try:
            yield
        finally:
            os.chdir(before)
            sys.path[:] = path
            for name in set(sys.modules) - known:
                origin = getattr(sys.modules[name], "__file__", None) or ""
                if origin.startswith(str(self.folder)):
                    del sys.modules[name]


def save(block: Block, folder: Path) -> str:
    """Write a block to the file in its title, or add the block to it. Return the file's name; empty if there is no
    title."""
    name = re.fullmatch(r"(?P<file>[\w.-]+(?:/[\w.-]+)*)(?P<more>, continued)?", block.title or "")
    if name is None:
        return ""
    target = folder / name["file"]
    target.parent.mkdir(parents=True, exist_ok=True)
    before = target.read_text(encoding="utf-8") + "\n\n" if name["more"] else ""
    target.write_text(before + block.code, encoding="utf-8")
    return name["file"]


def run_python(block: Block, module: types.ModuleType) -> None:
    """Run a `python` block. Tracebacks, and `inspect.getsource`, show the Markdown file's own lines."""
    tree = ast.parse("\n" * (block.line - 1) + block.code, str(block.file))
    code = compile(tree, str(block.file), "exec", flags=ast.PyCF_ALLOW_TOP_LEVEL_AWAIT, dont_inherit=True)
    if code.co_flags & inspect.CO_COROUTINE:
        asyncio.run(eval(code, module.__dict__))  # noqa: S307
    else:
        exec(code, module.__dict__)


def run_pycon(block: Block, module: types.ModuleType) -> None:
    """Run a `pycon` block, and compare its output. Raise an AssertionError with the difference."""
    options = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    test = doctest.DocTestParser().get_doctest(block.code, module.__dict__, str(block), str(block.file), block.line - 1)
    test.globs = module.__dict__  # the parser has made a copy, which would lose the definitions of the block
    report: list[str] = []
    doctest.DocTestRunner(optionflags=options, verbose=False).run(test, out=report.append, clear_globs=False)
    assert not report, "".join(report)


def run_tests(block: Block, folder: Path) -> None:
    """Run a block's file with pytest, in a separate process. If a test fails, raise an AssertionError with the
    output."""
    name = Path(block.title or "").name
    assert name.startswith("test_") and name.endswith(".py"), (
        f'{block}: give it title="test_....py", or remove its tests'
    )
    run_process(block, folder, sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(block.title))


def run_apart(block: Block, folder: Path) -> None:
    """Run a block in the environment that it names. If it fails, raise an AssertionError with the output."""
    python = ENVIRONMENTS / str(block.environment) / "bin" / "python"
    assert python.exists(), f"there is no environment {block.environment}: `make test` creates it"
    if block.has_tests:
        run_process(block, folder, python, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(block.title))
    else:
        run_process(block, folder, python, "-c", block.code)


def run_process(block: Block, folder: Path, *command: str | Path) -> None:
    environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST")}
    environment["PYTHONPATH"] = os.pathsep.join([str(ENVIRONMENTS.parent / "src"), environment.get("PYTHONPATH", "")])
    run = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=120, check=False)
    assert run.returncode == 0, f"{block}:\n{run.stdout}{run.stderr}"
