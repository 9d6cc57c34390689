"""Downloaded models are found by their names. A failed download keeps its parts, and leaves no empty folder."""

from pathlib import Path

import faster_whisper
import pytest

from ravestate.errors import PlatformError
from ravestate.modules.platform.voiceio import models


def test_a_failed_download_leaves_a_folder_only_if_it_has_fetched_something(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(models, "folders", lambda: (tmp_path,))
    fetched: list[bytes] = []

    def fail(name: str, output_dir: str) -> None:
        for content in fetched:
            (Path(output_dir) / "model.bin").write_bytes(content)
        raise OSError("offline")

    monkeypatch.setattr(faster_whisper, "download_model", fail)
    for _ in range(2):
        with pytest.raises(PlatformError, match=r"cannot fetch 'tiny\.en': offline"):
            models.fetch_whisper("tiny.en", str)
        assert [one.name for one in tmp_path.iterdir()] == (["tiny.en.part"] if fetched else [])
        fetched.append(b"half" * 1000)


@pytest.mark.parametrize("name", ["tiny.en", "Systran/faster-distil-whisper-small.en"])
def test_a_fetched_model_is_found_by_the_name_with_which_it_was_fetched(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A repository's name has a slash, which a folder's name cannot have."""
    monkeypatch.setattr(models, "folders", lambda: (tmp_path,))

    def fetch(_: str, output_dir: str) -> None:
        (Path(output_dir) / "model.bin").write_bytes(b"model")

    monkeypatch.setattr(faster_whisper, "download_model", fetch)
    with pytest.raises(PlatformError, match=f"ravestate voice get {name}"):
        models.whisper_model(name)
    assert models.whisper_model(models.fetch_whisper(name, str).name) == models.whisper_model(name)
    assert models.whisper_model(name).parent == tmp_path


def test_an_unfinished_download_is_no_model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The file ``model.bin`` may be complete although other files are missing."""
    monkeypatch.setattr(models, "folders", lambda: (tmp_path,))
    for name in ("base.part", "tiny.en"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "model.bin").write_bytes(b"model")
    assert dict(models.whisper_models()) == {"tiny.en": tmp_path / "tiny.en"}
    assert models.whisper_model("").name == "tiny.en"
    with pytest.raises(PlatformError, match=r"no model 'base'; there are: tiny\.en"):
        models.whisper_model("base")
