"""How fast is the complete text agent, and how much memory does it hold?

- Decided: the time from the input until a rule writes an answer, or the rule of small talk begins. The figure does not
  include the time of small talk. All modules of ``ravestate chat`` are loaded, with everything that they load on first use.
- Prompt: the time from the start of the process to the console's prompt on a terminal.
- Held: the resident memory of the agent, without the language model, which runs in a process of its own.
"""

from __future__ import annotations

import os
import pty
import select
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path

from benchmarks.bench import Bench
from benchmarks.figures import Figure, measured
from benchmarks.peers.wire import serve
from ravestate.cli.complete import COMPLETE

DECIDE, PROMPT, HOLD = 0.015, 1.5, 500e6
"""The limits: seconds from input to decision, seconds to the first prompt, and bytes of memory."""

PATIENCE = 60.0
"""Seconds after which an agent without a decision has failed."""

UTTERANCES = (
    "hello {name}", "how are you, {name}", "what is your name? i am {name}", "i live in a small house near {town}",
    "do you like {thing}?", "where do you live, near {town}?", "what is the capital of {country}",
    "that is very nice of you, {name}", "will it rain in {town} today", "tell me something about {thing}",
    "my sister {name} plays the piano", "how old are you, {name}?", "why is {thing} so popular", "no, not really, {name}",
    "i work as a baker in {town}", "what can you do with {thing}", "who wrote about {town}?",
    "i am a bit tired of {thing}", "yes, of course, {name}", "what are you up to in {town} today",
    "how many people live in {country}?", "thank you, {name}!", "do you have any friends in {town}",
    "i would like to go to {country} tomorrow evening",
)  # fmt: skip
"""Utterances of a talk. Each round uses other people and things, because the agent keeps vectors of known texts."""

WORDS = (
    ("Ada", "Bremen", "tea", "Peru"), ("Ben", "Delft", "chess", "France"), ("Cleo", "Turin", "cheese", "Chile"),
    ("Dora", "Graz", "jazz", "Kenya"), ("Emil", "Porto", "football", "Japan"), ("Fritz", "Ghent", "opera", "Norway"),
    ("Greta", "Malmo", "bread", "India"), ("Hugo", "Lyon", "sailing", "Egypt"), ("Ines", "Basel", "snow", "Cuba"),
)  # fmt: skip
"""A person, a town, a thing and a country for each round."""


def decide(rounds: int) -> dict[str, list[float]]:
    """Return the seconds from input to decision, for each utterance in each round, and the bytes held at the end."""
    import asyncio

    import ravestate as rs
    from ravestate import modules
    from ravestate.engine.trace import Born, Record, Started
    from ravestate.modules import rawio

    held: list[float] = []

    async def measure() -> list[float]:
        decided: asyncio.Future[float]

        def watch(record: Record) -> None:
            answered = isinstance(record, Born) and record.signal == "rawio:output:changed"
            asked = isinstance(record, Started) and record.rule == "wildtalk:chat"
            if (answered or asked) and not decided.done():
                decided.set_result(time.perf_counter())

        times: list[float] = []
        assert rounds < len(WORDS)
        parts = [getattr(modules, name) for name in COMPLETE]
        with tempfile.TemporaryDirectory() as folder:
            os.environ["XDG_DATA_HOME"] = folder
            settings = {"idle": {"bored_after": 3600.0}, "emotion": {"emoji": False}, "wildtalk": {"backend": "listen"}}
            async with rs.Context(*parts, settings=settings, seed=1) as context:
                context.observe(watch)
                for number in range(rounds + 1):  # the first round loads everything, and is not measured
                    name, town, thing, country = WORDS[number]
                    for template in UTTERANCES:
                        text = template.format(name=name, town=town, thing=thing, country=country)
                        decided = asyncio.get_running_loop().create_future()
                        begin = time.perf_counter()
                        context.put(rawio.input, text)
                        took = await asyncio.wait_for(decided, PATIENCE) - begin
                        if number:
                            times.append(took)
                        context.put(rawio.input, "")  # interrupts the answer
                        await context.quiet()
                pages = int(Path("/proc/self/statm").read_text().split()[1])  # noqa: ASYNC240  # /proc is not on a disk
                held.append(float(pages * os.sysconf("SC_PAGE_SIZE")))
        return times

    times = asyncio.run(measure())
    return {"decided": times, "held": held}


def ask(bench: Bench) -> Iterable[Figure]:
    """Measure decisions, the prompt and memory, against the claims."""
    found = bench.ours(__name__).ask("decide", rounds=bench.several(8, 2))
    decided = found["decided"]
    yield measured("text_agent", "the answering rule is chosen", decided, target="< 15 ms", reach=lambda s: s < DECIDE)
    slow = [statistics.quantiles(decided, n=20)[-1]]
    yield measured("text_agent", "... in 19 of 20 cases", slow)
    prompts = [_prompt() for _ in bench.rounds(9, 3)]
    yield measured("text_agent", "from start to prompt", prompts, target="< 1.5 s", reach=lambda s: s < PROMPT)
    yield measured("text_agent", "held", found["held"], unit="B", target="< 500 MB", reach=lambda b: b < HOLD)


def _prompt() -> float:
    """Return the seconds until ``ravestate chat`` shows its prompt on a terminal."""
    ours, theirs = pty.openpty()
    with tempfile.TemporaryDirectory() as folder:
        command = [str(Path(sys.executable).with_name("ravestate")), "chat"]
        environment = {**os.environ, "XDG_DATA_HOME": folder, "TERM": "xterm", "COLUMNS": "80", "LINES": "24"}
        begin = time.perf_counter()
        child = subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=theirs, env=environment)
        os.close(theirs)
        seen = b""
        try:
            while b">" not in seen:
                if not select.select([ours], [], [], 30)[0]:
                    raise TimeoutError(f"no prompt within 30 s, but: {seen!r}")
                seen += os.read(ours, 4096)
            return time.perf_counter() - begin
        finally:
            child.terminate()
            child.wait()
            os.close(ours)


if __name__ == "__main__":
    # The environment for development has PyTorch, and spaCy would load it. An agent's environment does not have
    # PyTorch.
    sys.modules["torch"] = None  # type: ignore[assignment]
    serve(decide)
