"""The interface of graph databases: Cypher statements, transactions, and tables for the types."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any, Protocol

from ravestate.errors import PlatformError

from .types import Types

FORMAT = 1
"""The version of the format in which nodes and relations are stored; a new format has a greater number."""


@dataclass(frozen=True, slots=True)
class Raw:
    """A node or a relation as a database returns it: its label, and its properties, including a node's ``id``."""

    label: str
    values: Mapping[str, Any]


class Store(Protocol):
    """A graph database; only one thread uses it.

    Statements are Cypher that Neo4j 5, ladybug and ArcadeDB all read. These databases have different functions for
    labels and types, so statements return whole nodes and relations. Values are always parameters. Names of types,
    properties and relations need no quotes, because they have only letters, digits and ``_``.
    """

    def prepare(self, types: Types) -> None:
        """Create the missing tables, columns or indexes for the types, properties and relations."""
        ...

    def read(self, statement: str, parameters: Mapping[str, Any]) -> list[Sequence[Any]]:
        """Run a statement that writes nothing, and return its rows of `Raw` and plain values."""
        ...

    def write(self, statement: str, parameters: Mapping[str, Any]) -> list[Sequence[Any]]:
        """Run a statement that writes, and return its rows. Outside a transaction, this also commits the write."""
        ...

    def transaction(self) -> AbstractContextManager[None]:
        """Run the ``with`` block as one transaction: commit all of its statements, or none.

        An inner transaction is part of the outer transaction.
        """
        ...

    def purge(self) -> None:
        """Remove the bytes that deleted nodes have left behind, as far as this process can."""
        ...

    def tidy(self) -> None:
        """Move the log of writes into the database, and free the main memory that the log takes up."""
        ...

    def undeclared(self, types: Types) -> list[str]:
        """Return the names of the types that have nodes in the database but are not in `types`."""
        ...

    def close(self) -> None:
        """Close the database."""
        ...


def check_format(place: str, found: object) -> None:
    """Refuse a memory of a newer format than this version of ravestate knows.

    Raises:
        PlatformError: The format is newer.
    """
    if not isinstance(found, int) or found > FORMAT:
        raise PlatformError(
            f"memory {place} is of format {found!r}, and this version of ravestate knows up to {FORMAT}: install a newer "
            "ravestate, or name another memory with --set ontology.path=FILE. Nothing was changed"
        )
