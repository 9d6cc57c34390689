"""Measure how genqa answers follow-up questions in conversations about a few small documents.

    python tests/quality/followups.py [FILE] [--misses]

A file has `documents`, each with a `title` and a `text` (or a list `sentences`), and `cases`. A case asks the questions
of `talk`, and then `follow`. The reply to `follow` must contain one word of each group in `answer`, and no word of
`not`. If `answer` is empty, the right reply is silence.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from pathlib import Path
from typing import Any

from quality.measure import HERE, Result, read_yaml, table
from ravestate.modules import genqa, nlp, rawio, verbaliser
from ravestate.modules.skill.genqa import places
from ravestate.modules.skill.genqa.document import Document
from ravestate.modules.skill.genqa.index import Index, IndexedFile
from ravestate.modules.skill.genqa.passages import passages_of
from ravestate.testing import simulate

ROWS = HERE / "thread_rows.yaml"
SHIP = HERE / "thread_ship_rows.yaml"
FILES = (ROWS, SHIP, HERE / "thread_station_rows.yaml", HERE / "thread_town_rows.yaml")


def measure_followups(file: Path = ROWS, every: int = 1) -> Result:
    """Run every `every`-th conversation of a file, each in its own context."""
    content = read_yaml(file)
    outcomes = ("right", "answered right", "rightly silent", "wrongly silent", "wrong")
    counts: dict[str, int] = dict.fromkeys(outcomes, 0)
    misses: list[str] = []
    with tempfile.TemporaryDirectory(prefix="ravestate-followups-") as folder:
        path = Path(folder) / "index.sqlite"
        _write(path, content["documents"])
        settings: dict[str, Any] = {"genqa": {"index": str(path), "collection": False}}
        for case in (cases := content["cases"][::every]):
            reply = _reply(settings, case)
            outcome = _outcome(reply, case)
            counts[outcome] += 1
            counts["right"] += outcome in ("answered right", "rightly silent")
            if outcome in ("wrongly silent", "wrong"):
                misses.append(f"{' / '.join((*case['talk'], case['follow']))}: {outcome}: {reply!r}")
        places.answerer_of(genqa.Settings(**settings["genqa"])).close()
    return Result(file.stem, len(cases), {what: count / len(cases) for what, count in counts.items()}, misses)


def results() -> list[Result]:
    """Measure the conversations for development. `measure.py` prints the results."""
    return [measure_followups(file) for file in FILES]


def _write(path: Path, documents: list[dict[str, Any]]) -> None:
    with Index(path) as index:
        for number, document in enumerate(documents):
            said = document.get("text") or document.get("sentences") or ""
            text = said if isinstance(said, str) else "\n\n".join(map(str, said))
            passages = list(passages_of(text))
            index.put(IndexedFile(f"/{number}.txt", 1, 1, "0"), [Document(document["title"], "notes", passages)])


def _reply(settings: dict[str, Any], case: dict[str, Any]) -> str:
    with simulate(genqa, nlp, rawio, verbaliser, settings=settings, trace=False) as sim:
        for question in case["talk"]:
            sim.say(question)
            sim.advance(3.0)
        before = len(sim.said)
        sim.say(case["follow"])
        return " ".join(sim.said[before:])


def _outcome(reply: str, case: dict[str, Any]) -> str:
    wanted = [[group] if isinstance(group, str | int | float) else group for group in case.get("answer", [])]
    if not reply:
        return "wrongly silent" if wanted else "rightly silent"
    if not wanted:
        return "wrong"
    right = all(any(_holds(reply, str(word)) for word in group) for group in wanted)
    return "answered right" if right and not any(_holds(reply, str(word)) for word in case.get("not", [])) else "wrong"


def _holds(reply: str, word: str) -> bool:
    return re.search(rf"(?<!\w){re.escape(word)}(?!\w)", reply, re.IGNORECASE) is not None


def main() -> int:
    """Measure the file on the command line."""
    parser = argparse.ArgumentParser(description="Measure follow-up questions.")
    parser.add_argument("file", nargs="?", type=Path, default=ROWS)
    parser.add_argument("--misses", action="store_true", help="also print each talk with a wrong reply")
    arguments = parser.parse_args()
    result = measure_followups(arguments.file)
    print(table([result]))
    if arguments.misses:
        print(*result.misses, sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
