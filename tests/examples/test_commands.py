"""The commands in the documentation print the output that the documentation shows.

In a `console` block, a line that begins with `$ ` is a command. The lines after it are its output, in which `...`
matches any text. The tests run the commands in a folder with the files that the page has shown so far. A block with
the title `hello.py` creates this file, and a block with the title `hello.py, continued` appends to it.
"""

import doctest
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from repo.snippets import Block, blocks_in, save

ROOT = Path(__file__).parents[2]
LOADED = re.compile(r"^WARNING ravestate: rule .* blocked the loop .*\n", re.MULTILINE)
"""A warning that the tests ignore, because only a busy machine causes it."""
PAGES = [
    file
    for file in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    if any(block.language == "console" for block in blocks_in(file))
    and file.name != "connect-a-robot.md"  # end_to_end/test_connect_a_robot.py runs the commands of this page
]
COMMAND = re.compile(r"(?:printf '[^']*' \| )?(?:\w+=\S+ )*(?:ravestate|python) .*")


def shown(block: Block) -> list[tuple[str, str]]:
    """Return each command of a block together with the output below it."""
    found: list[tuple[str, str]] = []
    for line in block.code.splitlines():
        if line.startswith("$ "):
            found.append((line[2:], ""))
        elif found:
            found[-1] = (found[-1][0], found[-1][1] + line + "\n")
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_each_command_on_a_page_prints_the_output_below_it(page: Path, tmp_path: Path) -> None:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = {
        **os.environ,
        "PATH": path,
        "XDG_STATE_HOME": str(tmp_path),
        "PYTEST_ADDOPTS": "-p no:cacheprovider",
    }
    same = doctest.OutputChecker().check_output
    for block in blocks_in(page):
        save(block, tmp_path)
        if block.language != "console" or block.not_run:
            continue
        for command, expected in shown(block):
            assert COMMAND.fullmatch(command), f"{block}: show other commands in a `bash` block: {command}"
            run = subprocess.run(
                command, shell=True, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=60
            )
            got = LOADED.sub("", run.stdout + run.stderr)
            flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
            assert same(expected, got, flags), f"{block}: {command}\nexpected:\n{expected}\ngot:\n{got}"
