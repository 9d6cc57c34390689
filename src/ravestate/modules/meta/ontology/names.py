"""The module ontology: its settings and its slot."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from pydantic import Field, SecretStr, field_validator
from pydantic_core import PydanticCustomError

import ravestate as rs
from ravestate.errors import RavestateError

from .memory import Memory

__all__ = ["Settings", "memory", "module"]


class Settings(rs.Settings):
    """Where memory is, and what there may be in it."""

    types: tuple[Path, ...] = ()
    """Files of types of one's own, read after the built-in one; they add to it."""
    path: Path | None = None
    """The file of memory; by default ``ravestate/<agent>/memory.lbug`` in the user's data folder."""
    agent: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._ -]*$")] = "default"
    """Whose memory it is: each agent has a file of its own, where `path` is not given."""
    url: str | None = None
    """A server that speaks Bolt and Cypher, instead of a file: ``bolt://localhost:7687``."""
    user: str = "neo4j"
    """Who signs in at the server."""
    password: SecretStr | None = None
    """The password there; best from the environment, ``RAVESTATE_ONTOLOGY_PASSWORD``."""
    database: str | None = None
    """The database on the server, which should be memory's own; by default the server's."""
    timeout: Annotated[float, Field(gt=0)] = 10.0
    """Seconds until a server that does not answer counts as absent."""

    @field_validator("types")
    @classmethod
    def _can_be_read(cls, types: tuple[Path, ...]) -> tuple[Path, ...]:
        """A mistake in a file is told before anything runs."""
        from .type_files import types_in

        try:
            types_in(types)
        except RavestateError as error:
            raise PydanticCustomError("types", "{why}", {"why": str(error)}) from None
        return types


module = rs.Module("ontology", settings=Settings)

memory: rs.Slot[Memory | None] = module.slot("memory", None, input=True)
"""What is known. None before ``rs.startup``, and where memory cannot be opened."""
