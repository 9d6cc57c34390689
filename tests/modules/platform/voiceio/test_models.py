"""A failed download of a model keeps the parts that it has fetched, and leaves no empty folder."""

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
