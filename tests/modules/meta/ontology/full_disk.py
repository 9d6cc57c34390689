"""Write to a memory until its file cannot grow, and continue. Print one line of JSON: ``python full_disk.py FILE``."""

import json
import os
import resource
import sys
from pathlib import Path

from ravestate.errors import PlatformError
from ravestate.modules import ontology
from ravestate.modules.meta.ontology.opening import open_memory


def allow(size: int) -> None:
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))


def main(path: Path, ending: str) -> None:
    memory = open_memory(ontology.Settings(path=path))
    memory.create("Person", name="first").result()
    allow(os.path.getsize(f"{path}.wal") + 20_000)
    acknowledged, errors = ["first"], []
    for number in range(100):
        try:
            acknowledged.append(memory.create("Person", name=f"person {number}").result(20)["name"])
        except PlatformError as error:
            errors.append(str(error))
            if len(errors) == 3:
                break
    read_meanwhile = len(memory.find("Person").result(20))
    if ending == "room":
        allow(resource.RLIM_INFINITY)
        acknowledged.append(memory.create("Person", name="later").result(20)["name"])
        read_meanwhile += 1
    memory.close().result(20)
    print(json.dumps({"acknowledged": acknowledged, "errors": errors, "read": read_meanwhile}), flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
