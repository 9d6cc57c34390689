"""Open damaged copies of a memory, one after the other: ``python damaged.py MEMORY SEED CASES``.

The program prints a line for each copy: ``read``, ``broken``, or the exception. If a copy ends the process, its line is
missing.
"""

import random
import shutil
import sys
from pathlib import Path

from ravestate.errors import PlatformError
from ravestate.modules import ontology
from ravestate.modules.meta.ontology.opening import open_memory

PAGE = 4096


def damage(content: bytes, rng: random.Random) -> bytes:
    """Cut a file, flip some of its bits, or fill one of its pages with zeros or noise."""
    kind = rng.choice(("cut", "flip", "zero", "zero", "noise", "noise"))
    start = rng.randrange(max(1, len(content) // PAGE)) * PAGE
    if kind == "cut":
        return content[: rng.randrange(len(content))]
    changed = bytearray(content)
    if kind == "flip":
        for _ in range(20):
            changed[rng.randrange(len(changed))] ^= 1 << rng.randrange(8)
    else:
        size = len(changed[start : start + PAGE])
        changed[start : start + size] = bytes(size) if kind == "zero" else rng.randbytes(size)
    return bytes(changed)


def attempt(path: Path) -> str:
    """Open a memory and read, write and forget something in it."""
    memory = open_memory(ontology.Settings(path=path))
    try:
        memory.opened().result(60)
        memory.export().result(60)
        memory.forget(memory.create("Person", name="new").result(60)).result(60)
    except PlatformError as error:
        return "broken" if "is damaged, or is not a memory file" in str(error) else f"PlatformError {error}"
    except BaseException as error:
        return f"{type(error).__name__} {error}"
    return "read"


def main(original: Path, seed: int, cases: int) -> None:
    rng = random.Random(seed)
    for case in range(cases):
        path = original.with_name(f"case-{case}.lbug")
        shutil.copy(original, path)
        shutil.copy(f"{original}.sum", f"{path}.sum")
        path.write_bytes(damage(original.read_bytes(), rng))
        print(attempt(path).replace("\n", " "), flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]))
