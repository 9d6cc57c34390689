"""How many pictures a second does the agent look at, and what do its eyes cost the conversation?

The camera is a video of 30 pictures a second: a person who sways. The agent looks at the video while users ask
questions. Agents with and without a camera take turns. The time of an answer ends when the agent has understood the
words, because this work is the same with and without a camera.
"""

from __future__ import annotations

import asyncio
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path

import ravestate as rs
from benchmarks.bench import Bench
from benchmarks.figures import Figure, measured
from ravestate.modules import hibye, nlp, persqa, rawio, visionio
from ravestate.modules.modality.visionio.eye import Eye
from ravestate.modules.modality.visionio.places import eyes_python

PHOTO = Path(sys.prefix) / "share" / "ravestate" / "eyes" / "photos" / "obama.jpg"
TEXTS = (
    "where do I live?",
    "do you like music?",
    "my sister plays the violin",
    "I live in Hannover",
    "what is my name?",
)
SLOWER = 0.020
RATE = 10.0
VIDEO = """
import sys, cv2, numpy as np
person = cv2.imread(sys.argv[1])
person = cv2.resize(person, None, fx=440 / person.shape[0], fy=440 / person.shape[0], interpolation=cv2.INTER_AREA)
out = cv2.VideoWriter(sys.argv[2], cv2.VideoWriter_fourcc(*"mp4v"), 30, (640, 480))
for number in range(300):
    room = np.full((480, 640, 3), 150, np.uint8)
    x = 140 + int(20 * np.sin(number / 15))
    room[40:, x:x + person.shape[1]] = person[:440]
    out.write(room)
out.release()
"""


def ask(bench: Bench) -> Iterable[Figure]:
    """Measure the rate of pictures, and the delay of the conversation."""
    with tempfile.TemporaryDirectory() as place:
        video = Path(place) / "camera.mp4"
        subprocess.run([eyes_python(), "-c", VIDEO, str(PHOTO), str(video)], check=True)
        eye = Eye()  # keeps the vision worker alive between two agents
        try:
            eye.process.start()
            slower: list[float] = []
            rates: list[float] = []
            for turn in range(bench.several(7, 2)):
                bench.progress(f"turn {turn + 1}")
                blind, _ = asyncio.run(_talk("", Path(place) / "blind.lbug"))
                seeing, rate = asyncio.run(_talk(str(video), Path(place) / "seeing.lbug"))
                slower.append(seeing - blind)
                rates.append(rate)
        finally:
            eye.close()
    yield measured("eyes", "chat slower with a camera", slower, target="<= 20 ms", reach=lambda x: x <= SLOWER)
    yield measured(
        "eyes", "pictures a second while chatting", rates, unit="", target=">= 9.9", reach=lambda x: x >= 9.9
    )


async def _talk(source: str, memory: Path) -> tuple[float, float]:
    """Return the median time (seconds) until the agent has understood an input, and the pictures a second."""
    counter = rs.Module("counter", requires=[visionio])
    looks: list[float] = []

    @counter.rule(when=visionio.looked.max_age(None).detached(), background=True)
    async def count(_: rs.RuleContext) -> None:
        looks.append(time.perf_counter())

    settings = {
        "visionio": {"source": source, "loop": True, "fps": RATE},
        "ontology": {"path": str(memory)},
        "idle": {"bored_after": 1e6},
    }
    waits: list[float] = []
    async with rs.Context(hibye, persqa, visionio, counter, settings=settings) as context:
        for text in TEXTS:  # the first input loads the models
            context.put(rawio.input, text)
            await context.next(nlp.analysis.changed, timeout=60)
        await asyncio.sleep(2.0)
        looks.clear()
        for number in range(20):
            start = time.perf_counter()
            context.put(rawio.input, TEXTS[number % len(TEXTS)])
            await context.next(nlp.analysis.changed, timeout=60)
            waits.append(time.perf_counter() - start)
            await asyncio.sleep(0.3)
    # Measure from the first look to the last, because the chat may begin and end in the middle of the time between two
    # looks.
    rate = (len(looks) - 1) / (looks[-1] - looks[0]) if looks else 0.0
    return statistics.median(waits), rate
