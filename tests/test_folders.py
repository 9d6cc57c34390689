"""The folder for a user's files on each operating system, and files that are replaced as a whole."""

import errno
import io
import os
import stat
import sys
from pathlib import Path
from typing import Literal

import pytest

from ravestate.folders import replace_file, user_folder


@pytest.mark.parametrize(
    ("kind", "platform", "variables", "expected"),
    [
        ("data", "linux", {"XDG_DATA_HOME": "/d", "XDG_STATE_HOME": "/s"}, "/d/ravestate"),
        ("state", "linux", {"XDG_DATA_HOME": "/d", "XDG_STATE_HOME": "/s"}, "/s/ravestate"),
        ("data", "linux", {"XDG_DATA_HOME": ""}, "/ada/.local/share/ravestate"),
        ("data", "linux", {"XDG_DATA_HOME": "not/absolute"}, "/ada/.local/share/ravestate"),
        ("state", "linux", {"XDG_STATE_HOME": "not/absolute"}, "/ada/.local/state/ravestate"),
        ("data", "darwin", {"XDG_DATA_HOME": "/d"}, "/ada/Library/Application Support/ravestate"),
        ("state", "darwin", {"XDG_STATE_HOME": "/s"}, "/ada/Library/Application Support/ravestate"),
        ("data", "win32", {"LOCALAPPDATA": "/local"}, "/local/ravestate"),
        ("state", "win32", {"LOCALAPPDATA": ""}, "/ada/AppData/Local/ravestate"),
    ],
)
def test_the_folder_follows_the_conventions_of_the_operating_system(
    monkeypatch: pytest.MonkeyPatch,
    kind: Literal["data", "state"],
    platform: str,
    variables: dict[str, str],
    expected: str,
) -> None:
    monkeypatch.setattr(sys, "platform", platform)
    monkeypatch.setenv("HOME", "/ada")
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    assert user_folder(kind) == Path(expected)


def test_a_file_is_replaced_as_a_whole_and_has_the_new_rights(tmp_path: Path) -> None:
    file, left = tmp_path / "file", tmp_path / "file.new"
    file.write_bytes(b"old")
    left.write_bytes(b"of a process that died")
    replace_file(file, b"new", mode=0o600)
    assert file.read_bytes() == b"new"
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    assert not left.exists()


def test_a_file_that_cannot_be_written_stays_as_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Full(io.FileIO):
        def write(self, _: object) -> int:
            raise OSError(errno.ENOSPC, "No space left on device")

    file = tmp_path / "file"
    file.write_bytes(b"old")
    monkeypatch.setattr(os, "fdopen", Full)
    with pytest.raises(OSError, match="No space"):
        replace_file(file, b"new")
    assert file.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [file]
