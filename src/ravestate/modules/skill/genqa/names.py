"""Questions about the world, answered from documents: with their source, or not at all."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

import ravestate as rs
from ravestate.modules import nlp, rawio, verbaliser

from .answering import Answer
from .referring import Before

Probability = Annotated[float, Field(ge=0, le=1)]


class Settings(rs.Settings):
    """Which documents are asked, and how sure an answer must be."""

    index: Path | None = None
    """The file that ``ravestate genqa index`` writes; by default ``ravestate/genqa.sqlite`` in the user's data folder."""
    collection: bool = True
    """Whether the collection that comes with Ravestate is asked as well: countries, nature, the calendar."""
    sure: Probability = 0.7
    """From this confidence on an answer is given as sure."""
    unsure: Probability = 0.4
    """From this confidence on an answer is given with a doubt; below, nothing is said."""
    wording: Literal["sentence", "model"] = "sentence"
    """``sentence``: the document's own; ``model``: that of wildtalk's language model, which is told nothing but the
    sentences that were found, and is only heard if it adds no name and no number."""
    reader: Path | None = None
    """The folder of another cross-encoder (``model.onnx``, ``tokenizer.json``); the confidence is calibrated for the
    bundled one."""

    @model_validator(mode="after")
    def _in_order(self) -> Settings:
        if self.unsure > self.sure:
            raise ValueError(f"unsure ({self.unsure}) must not be greater than sure ({self.sure})")
        return self


module = rs.Module("genqa", requires=[rawio, nlp, verbaliser], settings=Settings)

found = module.signal("found", payload=Answer)
"""The documents have an answer to what the user asks, probable enough to be told."""

before: rs.Slot[Before | None] = module.slot("before", None, type=Before)
"""The question that was answered last: *and its capital?* refers to it."""
