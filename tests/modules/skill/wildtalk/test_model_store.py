"""Ravestate's own models: the catalogue, the installed files, the default."""

import os
import re
from pathlib import Path

import pytest

from ravestate.errors import UsageError
from ravestate.modules.skill.wildtalk import model_store
from ravestate.modules.skill.wildtalk.model_store import RECOMMENDED, catalogue, default, named, set_default


@pytest.fixture(autouse=True)
def own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(model_store, "folder", lambda: tmp_path)


def test_the_catalogue_has_everything_that_a_download_needs() -> None:
    assert 4 <= len(catalogue()) <= 6
    assert RECOMMENDED in catalogue()
    sizes = [model.parameters for model in catalogue().values()]
    assert sizes == sorted(sizes) and sizes[0] >= 450_000_000
    for model in catalogue().values():
        assert re.fullmatch(r"[0-9a-f]{64}", model.sha256) and re.fullmatch(r"[0-9a-f]{40}", model.revision)
        assert re.fullmatch(r"[\w.-]+/[\w.-]+", model.repository) and re.fullmatch(r"[\w.-]+\.gguf", model.file)
        assert model.licence in ("Apache-2.0", "MIT")
        assert 300_000_000 < model.size < 3_000_000_000


def test_an_unknown_name_gets_a_suggestion() -> None:
    with pytest.raises(
        UsageError, match=r"no model 'qwen2.5-1.6b'; did you mean 'qwen2.5-1.5b'\?; there are: qwen2.5-0.5b"
    ):
        named("qwen2.5-1.6b")
    assert named("Qwen2.5-1.5B") is catalogue()["qwen2.5-1.5b"]


def test_a_default_model_counts_only_while_its_file_exists(tmp_path: Path) -> None:
    model = named(RECOMMENDED)
    assert default() is None
    set_default(model.name)
    assert default() is None
    model.path.touch()
    assert default() is None  # the file was cut off
    os.truncate(model.path, model.size)
    assert default() is model
    set_default(None)
    set_default(None)
    assert default() is None
    (tmp_path / "default").write_bytes(b"\xff\xfe")
    assert default() is None
