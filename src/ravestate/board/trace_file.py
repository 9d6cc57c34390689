"""Recorded traces: JSON files with a policy and the records of a trace. The board shows them without the agent."""

from __future__ import annotations

import contextlib
import dataclasses
import io
import json
import os
import pickle
import re
import secrets
import signal
import subprocess
import sys
from collections import OrderedDict
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import pydantic

from ravestate.board.description import Description, describe
from ravestate.board.recorder import Gap
from ravestate.board.rendering import well_formed
from ravestate.board.wire import VERSION, TraceRecord, checked_record, data_of
from ravestate.engine.trace import Record
from ravestate.errors import PlatformError
from ravestate.folders import replace_file
from ravestate.policy.policy import Policy

FORMAT = "ravestate-trace"

MOST_VALUES = 6_000_000
"""The maximum number of commas and opening brackets in a file: a file with more of them would fill the memory. A
recording of 64 MB, the maximum size of an upload, has about four million commas and brackets."""

LONGEST = 120  # the maximum number of seconds that reading a file may take

MOST_MEMORY = 2 * 1024**3
"""The maximum address space of the process that reads an uploaded file, in bytes. A valid recording of 64 MB needs a
third of this memory; a file with millions of faulty values would need several times this memory."""

TOO_MUCH = f"reading it takes more than {MOST_MEMORY // 1024**3} GB of memory"

CHUNK = 1000
"""The number of records in a message between processes. The number is small, because unpacking a message stops all
other threads."""

SURROGATE = re.compile(r"\\u[dD][89a-fA-F]")  # a pattern for one half of a surrogate pair, as JSON writes it


@dataclass(frozen=True, slots=True)
class Recording:
    """A recorded trace, its policy, and the agent's name (`title`).

    The recording is `whole` if the trace begins with the start of the context.
    """

    title: str
    description: Description
    records: tuple[Record | Gap, ...]
    whole: bool


KEPT = 4  # the maximum number of uploaded recordings that a server keeps; the server drops the oldest first


class Recordings:
    """The recordings of a server: `first`, which has no name, and uploaded recordings, whose names nobody can guess."""

    def __init__(self, first: Recording | None = None) -> None:
        self._first = first
        self._uploaded: OrderedDict[str, Recording] = OrderedDict()

    def get(self, name: str | None) -> Recording | None:
        """Return the recording with this name; without a name, `first`. Return None if it does not exist."""
        return self._first if name is None else self._uploaded.get(name)

    def put(self, recording: Recording) -> str:
        """Keep an uploaded recording, and return its new name."""
        name = secrets.token_urlsafe(12)
        self._uploaded[name] = recording
        while len(self._uploaded) > KEPT:
            self._uploaded.popitem(last=False)
        return name


class _File(pydantic.BaseModel):
    format: Literal["ravestate-trace"]
    v: Literal[1]
    records: Annotated[list[TraceRecord], pydantic.FailFast()]
    policy: Description
    title: str = "Ravestate"
    whole: bool = False


def save_trace(
    path: Path, policy: Policy, records: Iterable[Record | Gap], *, title: str = "Ravestate", whole: bool = True
) -> None:
    """Write a trace, e.g. the ``trace`` of a context with ``trace=True``, to a file for the board.

    For `title` and `whole`, see `Recording`. If writing fails with an OSError, an earlier trace in this file stays.
    """
    data = {
        "format": FORMAT,
        "v": VERSION,
        "title": title,
        "whole": whole,
        "policy": dataclasses.asdict(describe(policy)),
        "records": [data_of(record) for record in records],
    }
    replace_file(path, well_formed(json.dumps(data, ensure_ascii=False)).encode())


def open_trace(path: Path) -> Recording:
    """Return the trace in a file, or raise a `PlatformError`."""
    try:
        return read_trace(path.read_bytes())
    except OSError as error:
        raise PlatformError(f"cannot read {path}: {error.strerror}") from None
    except ValueError as error:
        raise PlatformError(f"{path} is not a trace: {error}") from None


def read_trace(text: str | bytes) -> Recording:
    """Return the trace that the text of a file describes. Question marks replace lone surrogates in the text.

    Raises:
        ValueError: The text is not a trace; the message names the place of the fault.
    """
    data = text if isinstance(text, bytes) else text.encode("utf-8", "surrogatepass")
    if sum(map(data.count, (b",", b"[", b"{"))) > MOST_VALUES:
        raise ValueError(f"it has more than {MOST_VALUES:,} values")
    try:
        found = _parsed(data.decode("utf-8-sig", "surrogatepass"))
    except (ValueError, RecursionError):
        raise ValueError("it is not JSON") from None
    try:
        file = _File.model_validate(found)
    except pydantic.ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        raise ValueError(f"{'.'.join(map(str, first['loc']))}: {first['msg']}") from None
    records = tuple(map(checked_record, file.records))
    return Recording(file.title[:80], file.policy, records, file.whole)


def read_apart(data: bytes) -> Recording:
    """Read a trace in another process, so that the threads of this process keep running.

    The other process has a time limit. For the result and the errors, see `read_trace`.
    """
    command = [sys.executable, "-m", __name__]
    paths = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    try:
        done = subprocess.run(command, input=data, capture_output=True, env=paths, timeout=LONGEST, check=False)
    except subprocess.TimeoutExpired:
        raise ValueError(f"reading it takes more than {LONGEST} s") from None
    if done.returncode in (-signal.SIGABRT, -signal.SIGKILL):  # pydantic's core aborts if it gets no memory
        raise ValueError(TOO_MUCH)
    if done.returncode < 0:
        raise ValueError(f"reading it was stopped by signal {-done.returncode}")
    if done.returncode:
        raise ValueError(done.stderr.decode("utf-8", "replace").strip() or "reading it fails")
    chunks = io.BytesIO(done.stdout)
    title, description, whole = pickle.load(chunks)
    records: list[Record | Gap] = []
    while chunk := pickle.load(chunks):
        records += chunk
    return Recording(title, description, tuple(records), whole)


def _parsed(text: str) -> Any:
    text = well_formed(text)
    found = json.loads(text)
    if SURROGATE.search(text) is None:
        return found
    return json.loads(well_formed(json.dumps(found, ensure_ascii=False)))


def _limit_memory() -> None:
    """Limit the memory of this process, if the operating system supports that."""
    # The causes of the errors, in this order: Windows; a lower limit is set already; macOS.
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))


def _main() -> int:
    """Read a trace from the standard input, and write it to the standard output for `read_apart`."""
    # With -m, the name of this module is `__main__`, but the pickles need its real name. So import it by that name.
    from ravestate.board import trace_file

    _limit_memory()
    try:
        read = trace_file.read_trace(sys.stdin.buffer.read())
        pickle.dump((read.title, read.description, read.whole), sys.stdout.buffer)
        for start in range(0, len(read.records), CHUNK):
            pickle.dump(read.records[start : start + CHUNK], sys.stdout.buffer)
        pickle.dump((), sys.stdout.buffer)
    except ValueError as error:
        sys.stderr.write(str(error))
        return 1
    except MemoryError:
        sys.stderr.write(TOO_MUCH)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(_main())
