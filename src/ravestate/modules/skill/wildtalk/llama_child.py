"""The process of a model: llama.cpp's server on the loopback interface.

`llama_process` runs this file as a program, so the file imports nothing from Ravestate. The program reads its
configuration as one line of JSON, and writes the server's address as one line. When its parent ends, standard input
ends, and so does the program.
"""

from __future__ import annotations

import importlib
import json
import os
import signal
import sys
import time
import traceback
from typing import Any


def _main() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent, which then closes this process
    config: dict[str, Any] = json.loads(sys.stdin.readline())
    out = os.dup(1)
    os.dup2(2, 1)  # llama.cpp's own output must not mix with the address
    try:
        server = _load(config)
    except BaseException as error:
        for _ in range(100 if isinstance(error, RuntimeError) else 0):  # let llama.cpp's logging thread finish
            before = os.fstat(2).st_size
            time.sleep(0.02)
            if before and os.fstat(2).st_size == before:
                break
        traceback.print_exc()
        os._exit(1)
    os.write(out, f"{server.listening_address}\n".encode())
    while os.read(0, 4096):  # the parent writes nothing more; this waits for the end of the input
        pass
    os._exit(0)


def _load(config: dict[str, Any]) -> Any:
    llama: Any = importlib.import_module("xllamacpp")  # the package has no type hints
    parameters = llama.CommonParams()
    parameters.model.path = config["path"]
    parameters.n_ctx = config["context_tokens"]
    parameters.n_parallel = config["parallel"]
    parameters.kv_unified = True
    parameters.cpuparams.n_threads = config["threads"]
    parameters.cache_ram_mib = 0  # otherwise, llama.cpp keeps up to 8 GB of old prompts
    parameters.warmup = True  # the model loads more slowly, but says its first word sooner
    parameters.verbosity = 1  # errors
    parameters.port = 0
    parameters.api_keys = [config["key"]]
    parameters.ui = False
    parameters.endpoint_slots = False
    return llama.Server(parameters)


if __name__ == "__main__":
    _main()
