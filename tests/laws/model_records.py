"""The records of the interpreter of the laws: groups, spikes, activations."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from math import inf
from typing import Any

GATHERS, READY, RUNS, CANCELLED, ENDED = range(5)


@dataclass(eq=False)
class Group:
    id: int
    into: Group | None = None
    taken: dict[int, list[Act] | None] = field(default_factory=dict)  # slot → its runs; None once consumed
    pressed: dict[int, float] = field(default_factory=dict)  # clause in stand-by → end of its patience

    def root(self) -> Group:
        group = self
        while group.into is not None:
            group = group.into
        return group

    def consumed(self, slots: Iterable[int]) -> bool:
        return any(self.taken.get(slot, ()) is None for slot in slots)


@dataclass(eq=False)
class Spike:
    id: int
    signal: Any
    payload: Any
    born: float
    group: Group
    parents: tuple[Spike, ...]
    rule: int  # the rule that raised it; -1 for code outside and detached rules
    newest: int  # the number of the newest activation at the spike's birth
    refused: set[int] = field(default_factory=set)  # the rules that have given it up
    withdrawn: bool = False

    def ancestry(self) -> Iterator[Spike]:
        yield self
        for parent in self.parents:
            yield from parent.ancestry()


@dataclass(eq=False)
class Act:
    id: int
    clause: Any
    held: dict[int, Spike] = field(default_factory=dict)  # place of a need → spike
    state: int = GATHERS
    gated: bool = False  # whether it lacks nothing, but a predicate on a slot was false
    pressed: dict[Group, float] = field(default_factory=dict)  # group → end of its patience there
    parents: tuple[Spike, ...] = ()
    took: list[Group] = field(default_factory=list)
    wrote: bool = False
    told: str = ""
    number: int = 0  # the number of its run; 0 before the run
    due: float = inf
    watch: dict[int, dict[int, Spike]] = field(default_factory=dict)  # until clause → need → spike

    @property
    def rule(self) -> Any:
        return self.clause.rule

    def lacks(self) -> list[Any]:
        return [need for need in self.clause.needs if need.index not in self.held]

    def firm(self) -> tuple[Spike, ...]:
        return tuple([self.held[n.index] for n in self.clause.needs if not n.detached and n.index in self.held])

    def groups(self) -> list[Group]:
        return list(dict.fromkeys([spike.group.root() for spike in self.firm()]))
