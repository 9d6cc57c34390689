"""Replace a value in memory, print *replaced*, and wait for the kill before the purge: ``python replacing.py FILE``."""

import sys
from pathlib import Path

from ravestate.modules import ontology
from ravestate.modules.meta.ontology import worker
from ravestate.modules.meta.ontology.opening import open_memory

NEVER = 3600.0
OLD = "Ockham in Surrey"


def replaced(memory: ontology.Memory) -> tuple[ontology.Node, ontology.Node]:
    """Return a person who has moved, and their new town: nobody needs the old town any more."""
    ada = memory.create("Person", name="Ada").result()
    old, new = memory.create("City", name=OLD).result(), memory.create("City", name="London").result()

    def move(graph: ontology.Graph) -> None:
        graph.unrelate(ada, "lives_in", old, forget=True)
        graph.relate(ada, "lives_in", new, {})

    memory.relate(ada, "lives_in", old).result()
    memory.together(move).result()
    return ada, new


def main(path: Path) -> None:
    worker.PAUSE = NEVER
    replaced(open_memory(ontology.Settings(path=path)))
    print("replaced", flush=True)
    sys.stdin.read()


if __name__ == "__main__":
    main(Path(sys.argv[1]))
