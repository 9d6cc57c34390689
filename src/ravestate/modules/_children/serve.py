"""The main program of a model's process: it answers requests from standard input, one after another.

``process.py`` runs this file. The argument is a backend's program: ``python -P serve.py .../whisper.py``. The program
is a file, or a folder with ``__init__.py`` and the files that it imports (``from . import ...``).

Each request and each answer is a line of JSON, followed by as many bytes as the line's ``size`` says. The first request
is the backend's configuration, and its answer is ``{"ready": true}``. If a request fails, its answer has the reason in
``error``; if the first request fails, the process ends. The process also ends when standard input ends, for instance
when its parent ends.
"""

from __future__ import annotations

import importlib.util
import json
import os
import signal
import sys
from pathlib import Path
from typing import Any, BinaryIO


def main() -> None:
    """Load the backend, and answer requests until standard input ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent, which then closes this process
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # output of the libraries goes to standard error, so that standard output has only answers
    requests = os.fdopen(os.dup(0), "rb")
    config, _ = _read(requests)
    try:
        handle = _program(Path(sys.argv[1])).load(config)
    except BaseException as error:
        _write(answers, {"error": _reason(error)}, b"")
        os._exit(1)
    _write(answers, {"ready": True}, b"")
    while True:
        try:
            header, data = _read(requests)
        except EOFError:
            os._exit(0)
        try:
            answer, sound = handle(header, data)
        except Exception as error:
            answer, sound = {"error": _reason(error)}, b""
        _write(answers, answer, sound)


def _program(path: Path) -> Any:
    """Import a file or a folder, under a name that no other package has."""
    file, folders = (path / "__init__.py", [str(path)]) if path.is_dir() else (path, None)
    spec = importlib.util.spec_from_file_location("ravestate_backend", file, submodule_search_locations=folders)
    assert spec is not None and spec.loader is not None
    module = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _read(stream: BinaryIO) -> tuple[dict[str, Any], bytes]:
    line = stream.readline()
    if not line:
        raise EOFError
    header: dict[str, Any] = json.loads(line)
    return header, stream.read(header.pop("size", 0))


def _write(stream: BinaryIO, header: dict[str, Any], data: bytes) -> None:
    stream.write(json.dumps({**header, "size": len(data)}).encode() + b"\n" + data)
    stream.flush()


def _reason(error: BaseException) -> str:
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__


if __name__ == "__main__":
    main()
