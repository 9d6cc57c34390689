"""Compare nlp with a language model (the setting `nlp.model`) and nlp without one.

    python -m quality.model MODEL [--base-url URL] [--most N]

Each set is a development set: sentences that nlp knows. So the comparison favours nlp without the model.
"""

from __future__ import annotations

import argparse
import asyncio
import random
import statistics
import sys
import time
from collections.abc import Callable

from quality import modules
from quality.language import triples_of, typed
from quality.measure import labelled
from ravestate.language.network import network
from ravestate.modules.meta.nlp import Settings
from ravestate.modules.meta.nlp.analysis import Analysis, analyse
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.meta.nlp.reading import ModelReader, model_reader

Labels = Callable[[Analysis], object]


def _triples(seen: Analysis) -> object:
    texts = ((modules.text_of(one.subject), one.predicate, modules.text_of(one.object)) for one in seen.triples)
    return frozenset(tuple(part.lower() for part in one) for one in texts)


def _sets() -> dict[str, tuple[list[tuple[str, object]], Labels]]:
    rows = [
        (text, frozenset(tuple(part.lower() for part in one) for one in triples_of(given))) for text, given in typed()
    ]
    return {
        "triples, typed": ([*rows], _triples),
        "kinds": ([*labelled("kinds_rows")], lambda seen: seen.question.name if seen.question else "-"),
        "yes and no": ([*labelled("answers_rows")], lambda seen: modules.yesno_label(seen.yesno)),
    }


async def _compare(reader: ModelReader, most: int) -> None:
    network().load()
    print(f"{'set':<16}{'rows':>6}{'without':>10}{'with':>8}{'unused':>8}{'median s':>10}")
    for name, (rows, label) in _sets().items():
        chosen = random.Random(0).sample(rows, min(most, len(rows)))
        without = aided = unused = 0
        times: list[float] = []
        for number, (text, wanted) in enumerate(chosen, 1):
            if sys.stderr.isatty():
                print(f"\r{name}: {number} of {len(chosen)} ", end="", file=sys.stderr)
            begun = time.perf_counter()
            reading = await reader.read(text)
            times.append(time.perf_counter() - begun)
            unused += reading is None or reading.normal(text) is None
            without += label(analyse(text, pipeline(""), Settings().agent_names)) == wanted
            aided += label(analyse(text, pipeline(""), Settings().agent_names, reading=reading)) == wanted
        shares = (
            f"{without / len(chosen):>10.1%}{aided / len(chosen):>8.1%}{unused:>8}{statistics.median(times):>10.2f}"
        )
        print(f"{name:<16}{len(chosen):>6}{shares}", flush=True)
    await reader.close()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Compare nlp with and without a language model.")
    parser.add_argument("model", help="the model's name on the server")
    parser.add_argument("--base-url", default=Settings().base_url, help="the address of the server")
    parser.add_argument("--most", type=int, default=100, help="the maximum number of sentences of each set")
    given = parser.parse_args()
    asyncio.run(_compare(model_reader(given.model, given.base_url, None, 120.0), given.most))
