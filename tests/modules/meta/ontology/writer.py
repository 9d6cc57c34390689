"""Write people to memory without end, and print each acknowledged number: ``python writer.py FILE [forget]``.

With ``forget``, forget the previous person before each number.
"""

import sys
from pathlib import Path

from ravestate.modules import ontology
from ravestate.modules.meta.ontology.opening import open_memory


def main(path: Path, *, forget: bool) -> None:
    memory = open_memory(ontology.Settings(path=path))
    place = memory.ensure("City", name="here").result()
    number, before = 0, None
    while True:
        person = memory.create("Person", name=f"person {number}", nickname="x" * 2000).result()
        memory.relate(person, "lives_in", place).result()
        if forget and before is not None:
            memory.forget(before).result()
        before = person
        print(number, flush=True)
        number += 1


if __name__ == "__main__":
    main(Path(sys.argv[1]), forget="forget" in sys.argv[2:])
