"""The code blocks of a Markdown file, found and run: what stands in the documentation works.

The rules, for who writes documentation:

- A ```` ```python ```` block is run. The blocks of one file share one namespace, so a story may run through
  the file; `await` and `async with` may stand at the top level.
- A ```` ```pycon ```` block is run too, and what it shows must come out.
- A block of any language with `title="hello.py"` is also saved under that name, in a folder of the file's own
  in which all its blocks run: so a later block can read, import or run it.
- A block right under `<!-- not run: the reason -->` is skipped, and the reason is shown. Rarely needed.
- Blocks of other languages (`bash`, `console`, `yaml`, `text`, ...) are not run.
"""

from __future__ import annotations

import ast
import asyncio
import contextlib
import doctest
import inspect
import os
import re
import sys
import textwrap
import types
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

FENCE = re.compile(r"(?P<indent>[ \t]*)(?P<fence>`{3,}|~{3,})[ \t]*(?P<info>[^`]*)")
NOT_RUN = re.compile(r"\s*<!--\s*not run:\s*(?P<reason>.*?)\s*-->\s*")
TITLE = re.compile(r"""title=(?P<quote>["'])(?P<title>.*?)(?P=quote)""")
LANGUAGES = {"python": "python", "py": "python", "python3": "python", "pycon": "pycon"}


@dataclass(frozen=True, slots=True)
class Block:
    """One fenced block; `line` is that of its first line of code, counted from 1."""

    file: Path
    line: int
    language: str
    code: str
    title: str | None
    not_run: str | None

    @property
    def runs(self) -> bool:
        """Whether the tests run it (or would, but for the reason given)."""
        return self.language in LANGUAGES

    def __str__(self) -> str:
        return f"{self.file.name}:{self.line}"


def blocks_in(file: Path) -> list[Block]:
    """Every fenced block of `file`, in order. Raises ValueError for a fence that is never closed."""
    found: list[Block] = []
    lines = iter(enumerate(file.read_text(encoding="utf-8").splitlines(), start=1))
    reason: str | None = None
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
                )
            )
            reason = None
        elif comment := NOT_RUN.fullmatch(line):
            reason = comment["reason"] or "no reason given"
        elif line.strip():
            reason = None
    return found


@dataclass
class Page:
    """One file's blocks and the state that they share: a namespace and a folder."""

    file: Path
    folder: Path
    blocks: list[Block] = field(default_factory=list)
    module: types.ModuleType = field(init=False)
    done: int = 0

    def __post_init__(self) -> None:
        self.blocks = self.blocks or blocks_in(self.file)
        self.module = types.ModuleType("snippets_of_" + re.sub(r"\W", "_", self.file.stem))
        self.module.__file__ = str(self.file)

    def run(self, block: Block) -> None:
        """Run `block`, after those before it that have not been run yet. Raises what the block raises."""
        with self._at_home():
            while self.done <= self.blocks.index(block):
                current = self.blocks[self.done]
                self.done += 1
                self._save(current)
                if current.runs and current.not_run is None:
                    (run_pycon if LANGUAGES[current.language] == "pycon" else run_python)(
                        current, self.module
                    )

    def _save(self, block: Block) -> None:
        if block.title and re.fullmatch(r"[\w.-]+(/[\w.-]+)*", block.title):
            target = self.folder / block.title
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(block.code, encoding="utf-8")

    @contextlib.contextmanager
    def _at_home(self) -> Iterator[None]:
        """In the page's folder, importable from it, and with its module known (as pickling and pydantic ask)."""
        before, path, known = Path.cwd(), list(sys.path), set(sys.modules)
        sys.modules[self.module.__name__] = self.module
        os.chdir(self.folder)
        sys.path.insert(0, str(self.folder))
        try:
            yield
        finally:
            os.chdir(before)
            sys.path[:] = path
            for name in set(sys.modules) - known:
                origin = getattr(sys.modules[name], "__file__", None) or ""
                if name == self.module.__name__ or origin.startswith(str(self.folder)):
                    del sys.modules[name]


def run_python(block: Block, module: types.ModuleType) -> None:
    """Run a `python` block. Tracebacks, and `inspect.getsource`, show the Markdown file's own lines."""
    tree = ast.parse("\n" * (block.line - 1) + block.code, str(block.file))
    code = compile(tree, str(block.file), "exec", flags=ast.PyCF_ALLOW_TOP_LEVEL_AWAIT, dont_inherit=True)
    if code.co_flags & inspect.CO_COROUTINE:
        asyncio.run(eval(code, module.__dict__))  # noqa: S307
    else:
        exec(code, module.__dict__)


def run_pycon(block: Block, module: types.ModuleType) -> None:
    """Run a `pycon` block and compare what it prints. Raises AssertionError with the difference."""
    options = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    test = doctest.DocTestParser().get_doctest(
        block.code, module.__dict__, str(block), str(block.file), block.line - 1
    )
    test.globs = module.__dict__  # the parser made a copy, which would lose what the block defines
    report: list[str] = []
    doctest.DocTestRunner(optionflags=options, verbose=False).run(test, out=report.append, clear_globs=False)
    assert not report, "".join(report)
