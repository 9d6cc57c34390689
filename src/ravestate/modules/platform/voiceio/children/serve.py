"""The process of one model: it answers requests on standard input, one after another.

`model_process` runs this file. The argument names a backend, which is a file in the same folder: ``python -P serve.py
whisper``. The first request is the backend's configuration. Each request and each answer is a line of JSON, followed by
as many bytes as the line's ``size`` says. The process ends when standard input ends, so it also ends when its parent does.
"""

from __future__ import annotations

import json
import os
import runpy
import signal
import sys
from pathlib import Path
from typing import Any, BinaryIO


def main() -> None:
    """Load the backend, and answer requests until standard input ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent, which then closes this process
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # the prints of libraries are no answers
    requests = os.fdopen(os.dup(0), "rb")
    config, _ = _read(requests)
    try:
        backend: Any = runpy.run_path(str(Path(__file__).with_name(f"{sys.argv[1]}.py")))
        handle = backend["load"](config)
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
