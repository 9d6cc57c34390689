"""The header of whole and broken GGUF files."""

from pathlib import Path

import pytest

from modules.skill.wildtalk.stand_ins import write_gguf
from ravestate.modules.skill.wildtalk import gguf_header
from ravestate.modules.skill.wildtalk.gguf_header import GgufHeader, read_header


def test_a_header_has_the_architecture_and_the_number_of_parameters(tmp_path: Path) -> None:
    file = write_gguf(tmp_path / "a.gguf", 1_543_714_304)
    assert read_header(file) == GgufHeader("qwen2", 1_543_714_304, chats=True)


@pytest.mark.parametrize("options", [{"chats": False}, {"pools": True}, {"kind": "adapter"}, {"kind": "mmproj"}])
def test_a_model_without_a_chat_template_or_with_pooling_is_not_a_chat_model(
    tmp_path: Path, options: dict[str, bool]
) -> None:
    assert not read_header(write_gguf(tmp_path / "a.gguf", **options)).chats  # type: ignore[arg-type]


def test_a_changed_file_is_read_again(tmp_path: Path) -> None:
    assert read_header(write_gguf(tmp_path / "a.gguf", 10_000)).parameters == 10_000
    assert read_header(write_gguf(tmp_path / "a.gguf", 20_000, words=60)).parameters == 20_000


@pytest.mark.parametrize("length", [0, 3, 7, 24, 60, 500, 900])
def test_a_file_that_is_cut_short_is_refused(tmp_path: Path, length: int) -> None:
    file = write_gguf(tmp_path / "a.gguf", words=100)
    file.write_bytes(file.read_bytes()[:length])
    with pytest.raises(ValueError, match=r"GGUF file|cut short"):
        read_header(file)


def test_a_file_without_its_weights_is_refused(tmp_path: Path) -> None:
    file = write_gguf(tmp_path / "a.gguf", words=0)
    file.write_bytes(file.read_bytes()[:-80].rstrip(b"\0"))
    with pytest.raises(ValueError, match=r"GGUF file|cut short"):
        read_header(file)


def test_other_files_nested_arrays_and_endless_headers_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "a.gguf"
    file.write_bytes(b"GGML" + bytes(100))
    whole = write_gguf(tmp_path / "b.gguf").read_bytes()
    nested = tmp_path / "c.gguf"
    nested.write_bytes(whole.replace(b"token_type" + b"\x09\0\0\0\x05", b"token_type" + b"\x09\0\0\0\x09"))
    for refused in (file, nested):
        with pytest.raises(ValueError, match="not a complete GGUF file"):
            read_header(refused)
    monkeypatch.setattr(gguf_header, "LARGEST", 100)
    with pytest.raises(ValueError, match="not a complete GGUF file"):
        read_header(tmp_path / "b.gguf")


@pytest.mark.model
def test_the_header_of_a_real_model_is_read() -> None:
    from ravestate.modules.skill.wildtalk.llama import bundled_model

    assert read_header(bundled_model()) == GgufHeader("llama", 134_515_008, chats=True)
