"""The contestant's end of the pipe: requests and replies on stdin and stdout, one JSON object in each line.

This file imports only the standard library, because each contestant runs in an environment of its own.
"""

import json
import os
import sys
import traceback
from collections.abc import Callable
from typing import Any


def serve(*functions: Callable[..., Any]) -> None:
    """Answer requests until stdin ends.

    A request ``{"call": name, "with": {...}}`` calls the function of that name; the reply is
    ``{"result": ...}`` or ``{"error": traceback}``.
    """
    replies = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # other output must not count as a reply
    by_name = {function.__name__: function for function in functions}
    for line in sys.stdin:
        request = json.loads(line)
        try:
            reply = {"result": by_name[request["call"]](**request["with"])}
        except Exception:
            reply = {"error": traceback.format_exc()}
        print(json.dumps(reply), file=replies, flush=True)
