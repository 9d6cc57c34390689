"""The folder for a user's files on each operating system."""

import sys
from pathlib import Path
from typing import Literal

import pytest

from ravestate.folders import user_folder


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
