"""The module ontology: its settings and its slot."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from pydantic import Field, SecretStr, field_validator
from pydantic_core import PydanticCustomError

import ravestate as rs
from ravestate.errors import RavestateError

from .memory import Memory


class Settings(rs.Settings):
    """The settings of ontology: the place of memory, and the types of its nodes."""

    types: tuple[Path, ...] = ()
    """Your own files of types; they extend the built-in file."""
    path: Path | None = None
    """The file of memory. Default: ``ravestate/<agent>/memory.lbug`` in the user's data folder."""
    agent: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._ -]*$")] = "default"
    """The agent's name: each agent has its own file, unless `path` is given."""
    url: str | None = None
    """The address of a server that speaks Bolt and Cypher, in place of a file: ``bolt://localhost:7687``."""
    user: str = "neo4j"
    """The user name on the server."""
    password: SecretStr | None = None
    """The password on the server. Set it in the environment: ``RAVESTATE_ONTOLOGY_PASSWORD``."""
    database: str | None = None
    """The name of a database on the server, for memory alone. Default: the server's default database."""
    timeout: Annotated[float, Field(gt=0)] = 10.0
    """The seconds to wait for each answer of the server."""

    @field_validator("types")
    @classmethod
    def _can_be_read(cls, types: tuple[Path, ...]) -> tuple[Path, ...]:
        """Check the files of types, so that mistakes in them are reported before anything runs."""
        from .type_files import types_in

        try:
            types_in(types)
        except RavestateError as error:
            raise PydanticCustomError("types", "{why}", {"why": str(error)}) from None
        return types


module = rs.Module("ontology", settings=Settings)

memory: rs.Slot[Memory | None] = module.slot("memory", None, input=True)
"""The agent's memory. The slot is None before ``rs.startup``, and if memory cannot be opened."""
