"""The encoder encodes each sentence only once, even if several threads ask for it."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

from ravestate.language.encoder import Encoder
from ravestate.language.model import SentenceModel


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """The sentences that each run of the model gets."""
    noted: list[list[str]] = []
    run = SentenceModel.run

    def noting(self: SentenceModel, texts: Sequence[str], *rest: Any) -> Iterator[Any]:
        noted.append(list(texts))
        return run(self, texts, *rest)

    monkeypatch.setattr(SentenceModel, "run", noting)
    return noted


def test_a_known_sentence_is_not_encoded_again(runs: list[list[str]]) -> None:
    encoder = Encoder()
    first = encoder.encode(["the kettle sings", "the kettle hums"])
    again = encoder.encode(["the kettle hums", "the kettle sings"])
    assert np.array_equal(first[::-1], again)
    assert runs == [["the kettle sings"], ["the kettle hums"]]


def test_a_vector_does_not_depend_on_the_other_sentences() -> None:
    alone, among = Encoder().encode(["the kettle sings"]), Encoder().encode(["a raven", "the kettle sings", "x" * 200])
    assert np.array_equal(alone[0], among[1])


def test_threads_that_ask_for_the_same_sentence_share_a_run(runs: list[list[str]]) -> None:
    encoder = Encoder()
    encoder.load()
    threads, entered = 4, threading.Barrier(4, timeout=10)

    def ask() -> Any:
        entered.wait()
        return encoder.encode(["a raven on the roof"])

    with ThreadPoolExecutor(threads) as pool:
        found = [one.result(timeout=30) for one in [pool.submit(ask) for _ in range(threads)]]
    assert all(np.array_equal(found[0], other) for other in found)
    assert sum("a raven on the roof" in texts for texts in runs) == 1


def test_after_an_error_the_next_call_encodes_the_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    encoder = Encoder()
    encoder.load()
    run = SentenceModel.run

    def broken(*_: Any) -> Iterator[Any]:
        raise OSError("the model's file went away")

    monkeypatch.setattr(SentenceModel, "run", broken)
    with pytest.raises(OSError, match="went away"):
        encoder.encode(["the roof is wet"])
    monkeypatch.setattr(SentenceModel, "run", run)
    assert encoder.encode(["the roof is wet"]).shape[0] == 1
