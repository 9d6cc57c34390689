"""The vision worker finds a Python that has the packages it needs."""

import sys
from pathlib import Path

import pytest

from ravestate.errors import PlatformError
from ravestate.modules.modality.visionio import places


def test_the_python_in_the_settings_is_used_first(tmp_path: Path) -> None:
    assert places.eyes_python(Path(sys.executable)) == sys.executable
    with pytest.raises(PlatformError, match=r"there is no such file.*make eyes"):
        places.eyes_python(tmp_path / "python")


def test_without_a_setting_the_python_of_make_eyes_comes_before_the_running_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(places.sys, "prefix", str(tmp_path / ".venv"))
    monkeypatch.setattr(places, "user_folder", lambda _: tmp_path / "data")
    monkeypatch.setattr(places, "find_spec", lambda name: None if name == "dlib" else object())
    with pytest.raises(PlatformError, match=r"dlib missing.*make eyes.*ravestate\[eyes\]"):
        places.eyes_python()
    monkeypatch.setattr(places, "find_spec", lambda _: object())
    assert places.eyes_python() == sys.executable
    python = tmp_path / ".venvs" / "eyes" / "bin" / "python"
    python.parent.mkdir(parents=True)
    python.write_text("")
    assert places.eyes_python() == str(python)
