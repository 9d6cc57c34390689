"""A conversation with the complete text agent in virtual time. Each utterance has the name of its module."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

from ravestate import modules
from ravestate.cli.complete import COMPLETE
from ravestate.engine.trace import Born, Set, Started
from ravestate.language.chat import Message, Progress
from ravestate.modules import rawio, wildtalk
from ravestate.testing import simulate

WORDS = "Hm, that is small talk."
"""The model's only answer."""


class Model:
    """A stand-in for a language model. It always gives the same answer."""

    async def load(self, progress: Progress | None = None) -> None:
        """Do nothing: there is nothing to load."""

    async def stream(self, messages: Sequence[Message], **_: Any) -> AsyncGenerator[str, None]:
        for word in WORDS.split():
            yield word + " "

    async def close(self) -> None:
        """Do nothing: there is nothing to release."""


@dataclass(frozen=True)
class Line:
    """An utterance of the agent, and the module whose rule caused it."""

    module: str
    text: str


class Conversation:
    """The agent of ``ravestate chat``, but without a console, and with a stand-in for the language model.

    Args:
        folder: The folder with the agent's memory and documents.
        settings: Settings of modules. Key: a module's name; value: its settings. With the backend ``listen`` of
            wildtalk, the listening skill makes small talk; otherwise the stand-in `Model` does.
        without: The modules to leave out.
    """

    def __init__(
        self,
        folder: Path,
        settings: dict[str, dict[str, Any]] | None = None,
        without: Sequence[str] = (),
        seed: int = 0,
    ) -> None:
        self.parts = [name for name in COMPLETE if name not in without]
        chosen: dict[str, dict[str, Any]] = {
            "idle": {"bored_after": 5.0},
            "ontology": {"path": folder / "memory.lbug"},
            "genqa": {"index": folder / "documents.sqlite"},
            "wildtalk": {"gate": False},  # the gate for generated replies could refuse the only answer of `Model`
        }
        for name, values in (settings or {}).items():
            chosen[name] = {**chosen.get(name, {}), **values}
        self.listens = chosen["wildtalk"].get("backend") == "listen"
        self.sim = simulate(
            *(getattr(modules, name) for name in self.parts),
            settings={name: values for name, values in chosen.items() if name in self.parts},
            seed=seed,
        )

    def __enter__(self) -> Conversation:
        self.sim.__enter__()
        if "wildtalk" in self.parts and not self.listens:
            self.sim.put(wildtalk.model, Model())
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.sim.__exit__(kind, error, traceback)
        if error is None:
            assert self.sim.failures == []

    def say(self, text: str, seconds: float = 2.0) -> list[Line]:
        """Say something; return the utterances of the agent in the next `seconds`."""
        return self._while(lambda: self.sim.say(text), seconds)

    def silence(self, seconds: float = 12.0) -> list[Line]:
        """Say nothing for some seconds; return the utterances of the agent in this time."""
        return self._while(lambda: None, seconds)

    def _while(self, act: Any, seconds: float) -> list[Line]:
        known = len(self.sim.said)
        act()
        self.sim.advance(seconds)
        return self.lines()[known:]

    def lines(self) -> list[Line]:
        """Return all utterances of the agent so far."""
        runs = {record.run: record for record in self.sim.trace if isinstance(record, Started)}
        spikes = {record.spike: record for record in self.sim.trace if isinstance(record, Born)}

        def source_rule(run: int) -> str:
            """Return the rule behind an utterance. For the verbaliser, this is the rule that asked it to speak."""
            started = runs[run]
            if started.rule == "verbaliser:verbalise":
                return source_rule(spikes[started.spikes[0]].source)
            return started.rule

        return [
            Line(source_rule(record.run).split(":")[0], record.value)
            for record in self.sim.trace
            if isinstance(record, Set) and record.slot == rawio.output.name
        ]


def spoken_by(lines: Sequence[Line]) -> list[str]:
    """Return the module of each utterance, in order."""
    return [line.module for line in lines]


__all__ = ["WORDS", "Conversation", "Line", "Model", "spoken_by"]
