"""What memory needs of a graph database: statements in Cypher, transactions, and room for the types."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any, Protocol

from ravestate.errors import PlatformError

from .types import Types

__all__ = ["FORMAT", "RawNode", "RawRelation", "Store", "check_format"]

FORMAT = 1
"""How nodes and relations are laid out; it grows when that changes."""


@dataclass(frozen=True, slots=True)
class RawNode:
    """A node as a database has it: its one label, and its properties, ``id`` among them."""

    label: str
    values: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class RawRelation:
    """A relation as a database has it: its type, and its properties."""

    name: str
    values: Mapping[str, Any]


class Store(Protocol):
    """A graph database. It is touched by one thread.

    Statements are Cypher that Neo4j 5, ladybug and ArcadeDB read alike: no functions of labels or types, which
    differ, so whole nodes and relations are returned. Values are always parameters; names come from the types, which
    let only letters, digits and ``_`` pass.
    """

    def prepare(self, types: Types) -> None:
        """Make room for all types, properties and relations that are not there yet.

        Raises:
            PlatformError: The database holds something else by these names, or is of a newer version.
        """
        ...

    def read(self, statement: str, parameters: Mapping[str, Any]) -> list[Sequence[Any]]:
        """Run a statement that writes nothing; each row has `RawNode`, `RawRelation` and plain values.

        Raises:
            PlatformError: The database failed.
        """
        ...

    def write(self, statement: str, parameters: Mapping[str, Any]) -> list[Sequence[Any]]:
        """Run a statement that writes; outside of a transaction it is done when this returns.

        Raises:
            PlatformError: The database failed.
        """
        ...

    def transaction(self) -> AbstractContextManager[None]:
        """All statements within are done together when it ends, or none of them; one within another is a part of it.

        Raises:
            PlatformError: The database failed.
        """
        ...

    def purge(self) -> None:
        """Leave no trace of what was deleted, where that is in this process's power."""
        ...

    def tidy(self) -> None:
        """Work the log of writes into the database, and give back the room that they took."""
        ...

    def undeclared(self, types: Types) -> list[str]:
        """The names of types in the database that `types` do not have."""
        ...

    def close(self) -> None:
        """Let go of it."""
        ...


def check_format(place: str, found: object) -> None:
    """Refuse what a newer version has written.

    Raises:
        PlatformError: It is newer.
    """
    if not isinstance(found, int) or found > FORMAT:
        raise PlatformError(
            f"memory {place} is of format {found!r}, and this version of ravestate knows up to {FORMAT}: install a newer "
            "ravestate, or name another memory with --set ontology.path=FILE. Nothing was changed"
        )
