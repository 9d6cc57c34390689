"""The module genqa: its settings, slot and signal."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

import ravestate as rs
from ravestate.modules import nlp, rawio, verbaliser

from .answering import Answer
from .thread import Turn

Probability = Annotated[float, Field(ge=0, le=1)]


class Settings(rs.Settings):
    """The documents, and the confidence that an answer needs."""

    index: Path | None = None
    """The file that ``ravestate genqa index`` writes; by default ``ravestate/genqa.sqlite`` in the user's data folder."""
    collection: bool = True
    """Whether to also search the collection that comes with Ravestate: countries, people, nature, culture."""
    sure: Probability = 0.7
    """The minimum confidence of an answer that the agent states as certain."""
    unsure: Probability = 0.5
    """The minimum confidence of an answer that the agent states as uncertain. If the confidence is lower, the module is
    silent."""
    wording: Literal["sentence", "model"] = "sentence"
    """``sentence``: the document's own words; ``model``: the words of wildtalk's language model. The prompt has only the
    question and the passages that were found. A result with a name or number from elsewhere is not used."""
    reader: Path | None = None
    """The folder of another cross-encoder (``model.onnx``, ``tokenizer.json``), the model that judges passages. The
    confidence is calibrated for the bundled cross-encoder."""

    rates: Mapping[str, float] = Field(default_factory=dict[str, float])
    """Currency (``dollar``, ``euro``, ``sterling``...) → its value; all values are in the same currency. Only currencies with a
    value are converted."""

    @model_validator(mode="after")
    def _in_order(self) -> Settings:
        if self.unsure > self.sure:
            raise ValueError(f"unsure ({self.unsure}) must not be greater than sure ({self.sure})")
        return self


module = rs.Module("genqa", requires=[rawio, nlp, verbaliser], settings=Settings)

found = module.signal("found", payload=Answer)
"""The documents have an answer that is probable enough to say, or a result was computed."""

thread: rs.Slot[tuple[Turn, ...]] = module.slot("thread", ())
"""The latest questions with their answers, oldest first. A follow-up such as *and its capital?* refers to them."""
