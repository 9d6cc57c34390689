"""The network that reads an utterance, below its heads."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravestate.errors import PlatformError
from ravestate.language import Encoder
from ravestate.language.encoder import BUNDLED
from ravestate.language.model import LAYERS, model_in
from ravestate.language.network import Network, network


@pytest.mark.parametrize("content", [None, b"nothing"])
def test_a_missing_or_broken_file_says_so(content: bytes | None, tmp_path: Path) -> None:
    file = tmp_path / "reader.onnx"
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(PlatformError, match="is broken"):
        Network(file).load()


def test_each_token_has_a_vector_of_several_layers() -> None:
    spans, vectors = model_in(None, BUNDLED).token_vectors("Hello there")
    assert [("Hello there"[start:end]) for start, end in spans] == ["", "Hello", "there", ""]
    assert vectors.shape == (4, len(LAYERS[BUNDLED]) * 384)


def test_one_run_gives_the_outputs_of_all_heads_and_they_are_kept() -> None:
    network().load()
    first = network().read("I live in Leeds, and you?")
    assert network().read("I live in Leeds, and you?") is first
    assert {"answers", "kinds", "moves", "facts", "replies"} <= first.keys()
    assert len(first["facts"]) == len(first["spans"])
    assert not any(output.flags.writeable for name, output in first.items() if name != "spans")


def test_the_fact_that_the_agent_has_asked_for_changes_the_tags() -> None:
    network().load()
    asked = network().labels("facts").index("origin") + 1
    assert (network().read("Hannover.", asked=asked)["facts"] != network().read("Hannover.")["facts"]).any()


def test_the_encoder_needs_no_inner_layers(tmp_path: Path) -> None:
    """A model of the user's own may lack the inner layers."""
    bundled = model_in(None, BUNDLED).folder
    for name in ("model.onnx", "tokenizer.json"):
        (tmp_path / name).symlink_to(bundled / name)
    assert Encoder(tmp_path).encode(["hello"]).shape == (1, 384)
    with pytest.raises(PlatformError, match="lacks the layers"):
        model_in(tmp_path, BUNDLED).token_vectors("hello")
