"""The tagger: labels for the words of a text."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.errors import PlatformError
from ravestate.language.encoder import BUNDLED
from ravestate.language.model import LAYERS, model_in
from ravestate.language.tagger import Tag, Tagger
from ravestate.modules.skill.persqa.tags import tagger

FILE = Path(__file__).parents[2] / "src" / "ravestate" / "modules" / "skill" / "persqa" / "facts.onnx"


@pytest.fixture(scope="module")
def loaded() -> Tagger:
    found = tagger()
    found.load()
    return found


def found_in(tags: tuple[Tag, ...]) -> set[tuple[str, str, bool]]:
    return {(tag.label, tag.text, tag.negated) for tag in tags}


def test_a_tagger_finds_nothing_before_it_is_loaded() -> None:
    assert Tagger(FILE).tags("I live in Leeds.") == ()


def test_several_values_of_a_text_have_their_labels(loaded: Tagger) -> None:
    found = found_in(loaded.tags("My name is Ada, I live in Leeds and I work as a nurse."))
    assert found == {("name", "Ada", False), ("home", "Leeds", False), ("occupation", "nurse", False)}


def test_a_denied_value_is_negated(loaded: Tagger) -> None:
    assert found_in(loaded.tags("I live in Bremen, not in Hannover.")) == {
        ("home", "Bremen", False),
        ("home", "Hannover", True),
    }


def test_the_context_decides_what_a_fragment_means(loaded: Tagger) -> None:
    assert found_in(loaded.tags("Hannover.", "home")) == {("home", "Hannover", False)}
    assert found_in(loaded.tags("Hannover.", "origin")) == {("origin", "Hannover", False)}


def test_an_unknown_context_counts_as_none(loaded: Tagger) -> None:
    assert loaded.tags("I live in Leeds.", "weather") == loaded.tags("I live in Leeds.")


@given(st.text(max_size=200))
def test_tags_lie_in_the_text_one_after_the_other(text: str) -> None:
    last = 0
    tagger().load()
    for tag in tagger().tags(text):
        assert last <= tag.start < tag.end <= len(text)
        assert text[tag.start : tag.end] == tag.text
        assert 0 <= tag.score <= 1.001
        last = tag.end


def test_a_broken_file_says_so(tmp_path: Path) -> None:
    broken = tmp_path / "facts.onnx"
    broken.write_bytes(b"nothing")
    with pytest.raises(PlatformError, match="is broken"):
        Tagger(broken).load()


def test_the_bundled_model_also_returns_inner_layers() -> None:
    spans, vectors = model_in(None, BUNDLED).token_vectors("Hello there")
    assert [("Hello there"[start:end]) for start, end in spans] == ["", "Hello", "there", ""]
    assert vectors.shape == (4, len(LAYERS[BUNDLED]) * 384)
