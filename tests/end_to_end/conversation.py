"""A conversation with the complete text agent in virtual time, and which module said what."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

from ravestate import modules
from ravestate.cli.complete import COMPLETE
from ravestate.engine.trace import Born, Set, Started
from ravestate.modules import rawio, wildtalk
from ravestate.modules.skill.wildtalk.backend import Message, Progress
from ravestate.testing import simulate

WORDS = "Hm, that is small talk."
"""The model's answer to everything."""


class Model:
    """A language model that always says the same; the language model itself has tests of its own."""

    async def load(self, progress: Progress | None = None) -> None:
        """Nothing is to be loaded."""

    async def stream(self, messages: Sequence[Message], **_: Any) -> AsyncGenerator[str, None]:
        for word in WORDS.split():
            yield word + " "

    async def close(self) -> None:
        """Nothing is to be let go of."""


@dataclass(frozen=True)
class Line:
    """One utterance of the agent, and the module whose rule meant it."""

    module: str
    text: str


class Conversation:
    """The agent of ``ravestate chat`` without its console and its model.

    Args:
        folder: Where its memory and its documents are.
        settings: For a module's name the values of its settings. With wildtalk's backend ``listen``, the listening skill
            makes small talk; otherwise a model that always says the same.
        without: Modules that do not take part.
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
            "wildtalk": {"gate": False},  # its model always says the same
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
        """Say something; what is said in the seconds after it."""
        return self._while(lambda: self.sim.say(text), seconds)

    def silence(self, seconds: float = 12.0) -> list[Line]:
        """Say nothing for a while; what is said meanwhile."""
        return self._while(lambda: None, seconds)

    def _while(self, act: Any, seconds: float) -> list[Line]:
        known = len(self.sim.said)
        act()
        self.sim.advance(seconds)
        return self.lines()[known:]

    def lines(self) -> list[Line]:
        """All that was said."""
        runs = {record.run: record for record in self.sim.trace if isinstance(record, Started)}
        spikes = {record.spike: record for record in self.sim.trace if isinstance(record, Born)}

        def meant(run: int) -> str:
            """The rule that meant it, where the verbaliser only worded it."""
            started = runs[run]
            if started.rule == "verbaliser:verbalise":
                return meant(spikes[started.spikes[0]].source)
            return started.rule

        return [
            Line(meant(record.run).split(":")[0], record.value)
            for record in self.sim.trace
            if isinstance(record, Set) and record.slot == rawio.output.name
        ]


def spoken_by(lines: Sequence[Line]) -> list[str]:
    """The modules that spoke, in order."""
    return [line.module for line in lines]


__all__ = ["WORDS", "Conversation", "Line", "Model", "spoken_by"]
