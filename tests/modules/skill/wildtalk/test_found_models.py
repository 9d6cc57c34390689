"""Chat models in the folders of other programs, and the best of them."""

from pathlib import Path

import pytest

from modules.skill.wildtalk.stand_ins import write_gguf
from ravestate.modules.skill.wildtalk import found_models
from ravestate.modules.skill.wildtalk.found_models import FoundModel, best_model, find_models, folders

B = 1_000_000_000


def model(parameters: float, size: float) -> FoundModel:
    return FoundModel(Path(f"{parameters}.gguf"), int(parameters * B), int(size * B))


def test_chat_models_of_half_a_billion_parameters_are_found_at_any_depth(tmp_path: Path) -> None:
    deep = write_gguf(tmp_path / "models--x" / "snapshots" / "0" / "qwen2.5-0.5b-instruct.GGUF", 494_000_000)
    write_gguf(tmp_path / "smollm2-360m.gguf", 362_000_000)
    write_gguf(tmp_path / "base.gguf", chats=False)
    write_gguf(tmp_path / "bge-m3.gguf", pools=True)
    write_gguf(tmp_path / "nomic-embed-text.gguf")
    write_gguf(tmp_path / "mmproj-model.gguf")
    write_gguf(tmp_path / "big-00001-of-00003.gguf")
    (tmp_path / "notes.gguf").write_text("not a model")
    (tmp_path / "gone.gguf").symlink_to(tmp_path / "nowhere")
    assert [found.path for found in find_models([tmp_path, tmp_path / "none"])] == [deep]


def test_a_file_behind_two_links_is_listed_once(tmp_path: Path) -> None:
    blob = write_gguf(tmp_path / "blobs" / "0123")
    for name in ("a", "b"):
        (tmp_path / f"{name}.gguf").symlink_to(blob)
    (found,) = find_models([tmp_path])
    assert found == FoundModel(tmp_path / "a.gguf", B, blob.stat().st_size)


def test_a_search_stops_at_the_limit_in_an_endless_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for number in range(5):
        write_gguf(tmp_path / str(number) / "m.gguf")
    monkeypatch.setattr(found_models, "MANY", 8)
    assert len(find_models([tmp_path])) < 5


def test_the_best_model_is_the_largest_fluent_model_that_fits_into_memory() -> None:
    models = [model(0.5, 0.4), model(4, 2.5), model(8, 5), model(70, 40)]
    assert best_model(models, 16 * B) == models[1]
    assert best_model(models, 3 * B) == models[0]
    assert best_model(models[2:], 16 * B) == models[2]
    assert best_model(models, B // 2) is None
    assert best_model([]) is None
    assert best_model([model(0.5, 0)]) is not None  # by this machine's memory


def test_environment_variables_name_the_model_folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setenv("HOME", "/ada")
    for name in ("XDG_DATA_HOME", "XDG_CACHE_HOME", "HF_HOME", "HF_HUB_CACHE", "LLAMA_CACHE"):
        monkeypatch.delenv(name, raising=False)
    usual = [str(place) for place in folders()]
    assert usual == [
        "/ada/.local/share/ravestate/models",
        "/ada/.lmstudio/models",
        "/ada/.cache/lm-studio/models",
        "/ada/.cache/huggingface/hub",
        "/ada/.cache/llama.cpp",
        "/ada/.local/share/nomic.ai/GPT4All",
        "/ada/.local/share/Jan/data",
    ]
    monkeypatch.setenv("XDG_DATA_HOME", "/data")
    monkeypatch.setenv("HF_HOME", "/hf")
    monkeypatch.setenv("LLAMA_CACHE", "/llama")
    given = {str(place) for place in folders()}
    assert {"/data/ravestate/models", "/hf/hub", "/llama", "/data/Jan/data"} <= given
    monkeypatch.setenv("HF_HUB_CACHE", "/hub")
    assert Path("/hub") in folders()


def test_a_user_without_a_home_folder_has_no_model_folders(monkeypatch: pytest.MonkeyPatch) -> None:
    def homeless() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setattr(Path, "home", homeless)
    assert folders() == []
