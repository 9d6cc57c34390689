"""The complete text agent computes nothing twice for one utterance."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from spacy.language import Language

from ravestate import modules
from ravestate.cli.complete import COMPLETE
from ravestate.language.model import SentenceModel
from ravestate.testing import simulate


@pytest.fixture
def work(monkeypatch: pytest.MonkeyPatch) -> dict[str, list[Any]]:
    """The texts that the sentence models (encoder and cross-encoder) and the parser have processed."""
    done: dict[str, list[Any]] = {"run": [], "parsed": []}
    run, parse = SentenceModel.run, Language.__call__

    def note_run(model: SentenceModel, texts: Any) -> Any:
        done["run"].append(list(texts))
        return run(model, texts)

    def note_parsed(language: Language, text: str, *more: Any, **options: Any) -> Any:
        done["parsed"].append(text)
        return parse(language, text, *more, **options)

    monkeypatch.setattr(SentenceModel, "run", note_run)
    monkeypatch.setattr(Language, "__call__", note_parsed)
    return done


def test_an_utterance_is_encoded_once_and_parsed_once(tmp_path: Path, work: dict[str, list[Any]]) -> None:
    settings = {
        "ontology": {"path": tmp_path / "memory.lbug"},
        "genqa": {"index": tmp_path / "index.sqlite"},
        "wildtalk": {"backend": "listen"},
        "emotion": {"emoji": False},
    }
    parts = [getattr(modules, name) for name in COMPLETE]
    with simulate(*parts, settings=settings, seed=1) as agent:
        agent.say("what do you think of jazz?")  # this first utterance loads the models
        for done in work.values():
            done.clear()
        said = len(agent.said)
        agent.say("do you like chess?")
        assert len(agent.said) > said
    # All matchers share one run of the encoder. The cross-encoder does not run: a question about the agent needs no document.
    assert work["run"] == [["do you like chess"]]
    assert len(work["parsed"]) == 1
