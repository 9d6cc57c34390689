"""A graph database on a server that speaks Bolt and Cypher, such as Neo4j."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import Coroutine, Generator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar

from ravestate.errors import PlatformError
from ravestate.language.loading import LOADING

from .store import FORMAT, Raw, check_format
from .types import Types

if TYPE_CHECKING:
    from neo4j import AsyncResult, AsyncSession, AsyncTransaction

T = TypeVar("T")

META = "_ravestate"
"""The label of the node that stores the format version."""

LIVELY = 5.0
"""If a connection was idle for this many seconds, the driver tests it before use: the server may have restarted."""


class BoltStore:
    """A database on a server, accessed through Neo4j's official driver.

    The store has its own thread. Even so, it uses the asynchronous driver, because a wait for that driver can be
    cancelled. So a server that stalls delays the thread for at most `timeout` seconds.
    """

    def __init__(self, url: str, user: str, password: str, database: str | None, timeout: float) -> None:
        """Connect to the server.

        Args:
            url: The server's address: ``bolt://localhost:7687``, or ``neo4j+s://...`` with encryption.
            user: The user name on the server.
            password: The password on the server; empty for a server without passwords.
            database: The database's name on the server; None for the server's default database.
            timeout: The seconds to wait for each answer.

        Raises:
            PlatformError: The package is missing, or the server is absent, stalls or refuses the connection.
        """
        try:
            with LOADING:
                import neo4j
        except ImportError as error:
            raise PlatformError(f"ontology needs neo4j for the server {url}: pip install 'ravestate[neo4j]'") from error
        # The driver warns of a query for a property that no node has yet, but such a query is not a fault.
        logging.getLogger("neo4j.notifications").setLevel(logging.ERROR)
        self._neo4j: Any = neo4j  # the driver is only partly typed
        self._place = url
        self._user = user
        self._database = database
        self._timeout = timeout
        self._transaction: AsyncTransaction | None = None
        self._loop = asyncio.new_event_loop()
        self._driver: Any = None
        try:
            if not url.startswith(("bolt", "neo4j")):
                raise ValueError("it begins with neither bolt: nor neo4j:")
            self._driver = self._neo4j.AsyncGraphDatabase.driver(
                url,
                auth=(user, password) if password else None,
                connection_timeout=self._timeout,
                connection_acquisition_timeout=self._timeout,
                liveness_check_timeout=LIVELY,
            )
            self._wait(self._driver.verify_connectivity())
        except (ValueError, self._neo4j.exceptions.ConfigurationError) as error:
            self.close()
            raise PlatformError(
                f"ontology.url = {url!r} is not a server's address ({error}): write for example bolt://localhost:7687"
            ) from error
        except BaseException:
            self.close()
            raise

    # ------------------------------------------------------------------------------------ statements

    def labels(self, types: Sequence[str]) -> str:
        """Return the labels of these types: each type is a label."""
        return "|".join(f"`{name}`" for name in types)

    def relation(self, name: str) -> str:
        """Return the label of a relation."""
        return f"`{name}`"

    def read(self, statement: str, parameters: Mapping[str, Any]) -> list[Sequence[Any]]:
        """Run a statement that may also write, and return its rows."""
        return self._wait(self._run(statement, parameters))

    write = read

    @contextmanager
    def transaction(self) -> Generator[None]:
        """Run the ``with`` block as one transaction: commit all of its statements, or none."""
        if self._transaction is not None:
            yield
            return
        session = self._session()
        try:
            self._transaction = transaction = self._wait(session.begin_transaction())
            try:
                yield
                self._wait(transaction.commit())
            except BaseException:
                self._wait(transaction.close())  # this rolls the transaction back
                raise
        finally:
            self._transaction = None
            self._wait(session.close())

    def _session(self) -> AsyncSession:
        return self._driver.session(database=self._database)

    async def _run(self, statement: str, parameters: Mapping[str, Any]) -> list[Sequence[Any]]:
        if self._transaction is not None:
            return await _rows(await self._transaction.run(statement, dict(parameters)))  # type: ignore[arg-type]
        async with self._session() as session:
            return await _rows(await session.run(statement, dict(parameters)))  # type: ignore[arg-type]

    def _wait(self, work: Coroutine[Any, Any, T]) -> T:
        errors = self._neo4j.exceptions
        try:
            return self._loop.run_until_complete(asyncio.wait_for(work, self._timeout))
        except TimeoutError as error:
            raise PlatformError(
                f"memory {self._place} did not answer within {self._timeout:g} s: check the server, or wait longer with "
                "--set ontology.timeout=SECONDS"
            ) from error
        except errors.AuthError as error:
            raise PlatformError(
                f"memory {self._place} refuses the user {self._user!r}: set RAVESTATE_ONTOLOGY_PASSWORD, or choose another user "
                "with --set ontology.user=NAME"
            ) from error
        except errors.Neo4jError as error:
            if any(problem in (error.code or "") for problem in ("DatabaseNotFound", "DatabaseUnavailable")):
                named = f"has no database {self._database!r}" if self._database else "has no default database"
                raise PlatformError(
                    f"memory {self._place} {named}: create it, or choose another with --set ontology.database=NAME"
                ) from error
            raise PlatformError(f"memory {self._place} failed: {error.message or error}") from error
        except (errors.DriverError, OSError, ValueError) as error:  # ValueError: an invalid port
            raise PlatformError(
                f"memory {self._place} cannot be reached ({_first_line(error)}): start the server, or choose another with "
                "--set ontology.url=bolt://HOST:PORT"
            ) from error

    # ------------------------------------------------------------------------------------ types

    def prepare(self, types: Types) -> None:
        """Check or note the format, and create an index of ids for each type. A server needs no tables."""
        rows = self.read(f"MATCH (m:`{META}` {{`key`: 'format'}}) RETURN m.`value`", {})
        if rows:
            check_format(self._place, rows[0][0], FORMAT)
        else:
            self.write(f"MERGE (m:`{META}` {{`key`: 'format'}}) SET m.`value` = {FORMAT}", {})
        for name in types:
            self.write(f"CREATE CONSTRAINT IF NOT EXISTS FOR (n:`{name}`) REQUIRE n.`id` IS UNIQUE", {})

    def note_bytes(self) -> None:
        """Do nothing: the server manages its files."""

    def purge(self) -> None:
        """Do nothing: the server manages its files."""

    def rest(self) -> None:
        """Do nothing: the server works by itself."""

    def tidy(self) -> None:
        """Do nothing: the server manages its log."""

    def undeclared(self, types: Types) -> list[str]:
        """Return the labels of the server's nodes, except the labels that are in `types`."""
        rows = self.read("MATCH (n) UNWIND labels(n) AS name RETURN DISTINCT name", {})
        return sorted({str(name) for [name] in rows} - {META, *types})

    def close(self) -> None:
        """Close the connections to the server."""
        try:
            if self._driver is not None:
                with contextlib.suppress(PlatformError):  # the server might no longer answer
                    self._wait(self._driver.close())
        finally:
            self._loop.run_until_complete(self._loop.shutdown_asyncgens())
            self._loop.close()


async def _rows(result: AsyncResult) -> list[Sequence[Any]]:
    rows: list[Sequence[Any]] = [[_decoded(value) for value in record.values()] async for record in result]
    await result.consume()
    return rows


def _decoded(value: Any) -> Any:
    from neo4j.graph import Node, Relationship

    if isinstance(value, Node):
        values = dict(value.items())
        label = str(values.get("id", "")).partition(":")[0]  # a node may have further labels
        return Raw(label if label in value.labels else min(value.labels, default=""), values)
    if isinstance(value, Relationship):
        return Raw(value.type, dict(value.items()))
    return value


def _first_line(error: BaseException) -> str:
    return next(iter(str(error).splitlines()), "").rstrip(": ") or type(error).__name__
