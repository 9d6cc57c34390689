"""The interface of graph databases: Cypher statements, transactions, and tables for the types."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any, Protocol

from ravestate.errors import PlatformError

from .types import Types

FORMAT = 1
"""The version of the format of nodes and relations on a server and in a document; a new format has a greater number."""


@dataclass(frozen=True, slots=True)
class Raw:
    """A node or a relation as a database returns it: its label, and its properties, including a node's ``id``."""

    label: str
    values: Mapping[str, Any]


class Store(Protocol):
    """A graph database; only one thread uses it.

    Statements are Cypher that Neo4j 5, ladybug and ArcadeDB all read. These databases have different functions for
    labels and types, so statements return whole nodes and relations. `labels` and `relation` say how a database tells
    the types of nodes and relations apart. Values are always parameters. Names of types,
    properties and relations need no quotes, because they have only letters, digits and ``_``.
    """

    def prepare(self, types: Types) -> None:
        """Create the missing tables, columns or indexes for the types, properties and relations."""
        ...

    def labels(self, types: Sequence[str]) -> str:
        """Return the labels that stand in a pattern for nodes of these types. Nodes of other types may have these labels, too."""
        ...

    def relation(self, name: str) -> str:
        """Return the label and properties that stand in a pattern for a relation of this name."""
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

    def note_bytes(self) -> None:
        """Note, in the transaction that deletes nodes, that their bytes stay; `rest` or `close` removes these bytes.

        If the process ends earlier, `rest` removes the bytes after the next opening.
        """
        ...

    def purge(self) -> None:
        """Remove the bytes that deleted nodes have left behind, as far as this process can.

        In a transaction, the bytes are removed after the commit. Without such bytes, do nothing.
        """
        ...

    def rest(self) -> None:
        """Do the postponed work: purge the database. The worker thread calls this method in pauses between jobs."""
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


def check_format(place: str, found: object, newest: int) -> int:
    """Return the format of a memory; refuse a format newer than `newest`, the newest known format.

    Raises:
        PlatformError: The format is newer than `newest`, or is no number.
    """
    if not isinstance(found, int) or found > newest:
        raise PlatformError(
            f"memory {place} is of format {found!r}, and this version of ravestate knows up to {newest}: install a newer "
            "ravestate, or name another memory with --set ontology.path=FILE. Nothing was changed"
        )
    return found
