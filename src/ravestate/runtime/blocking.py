"""Warnings about rules that block the event loop."""

from __future__ import annotations

import logging
from time import perf_counter, process_time, thread_time
from typing import Any, Final

from ravestate.declare.rule import Rule

resource: Any
try:
    import resource
except ImportError:  # Windows
    resource = None

BLOCKING: Final = 0.1
"""If one step of an async rule (see `StepTimer`) computes or sleeps for longer than this (seconds), a warning names the
rule. During a step, nothing else on the loop runs."""

FRESH: Final = 0.01  # steps that begin within this many seconds share one reading of the thread's CPU time

ASLEEP = 0.05
"""A step counts as sleeping only if its sleeps are longer than this on average (seconds). In shorter sleeps, the thread
waits for the interpreter's lock: it then sleeps again and again, for about 5 ms each time."""

OTHERS = 0.5
"""A step does not count as sleeping if other threads of the process computed for more than this share of the time that
it slept. The step may then have waited for these threads. For instance, a new thread starts only when it gets the
interpreter's lock, and its caller sleeps until then. A library that loads a model holds that lock for 0.2 s at a
time."""

log = logging.getLogger("ravestate")


class StepTimer:
    """Measures the steps of async rules, and warns of steps that block the loop. Use it on the loop's thread only.

    A step is the code that a rule runs without a break: up to the next ``await`` that suspends it, or to its end. A
    step blocks the loop if it computes, or sleeps, for longer than `BLOCKING`. The time for which the thread waits for
    a processor or for other threads does not count, so a busy machine causes no warning. The operating system counts
    how often the thread slept voluntarily, and how often the scheduler preempted it. If the scheduler preempted the
    thread during a step, the timer ignores the sleeps of this step. Windows and macOS have no such counts for a thread;
    there, the timer ignores all sleeps.

    Reading the CPU time costs as much as a short rule. One reading serves all steps that begin within `FRESH` seconds,
    so a reported time may be too long by that much.
    """

    __slots__ = ("_cpu", "_cpu_of_all", "_fresh_until", "_sleeps")

    def __init__(self) -> None:
        self._fresh_until = 0.0
        self._cpu = 0.0  # the CPU time of this thread
        self._cpu_of_all = 0.0  # the CPU time of all threads of the process
        self._sleeps = 0, 0

    def begin(self) -> float:
        """Record that a step begins. Return the time that `end` needs (seconds of `perf_counter`)."""
        now = perf_counter()
        if now > self._fresh_until:
            self._fresh_until = now + FRESH
            self._cpu = thread_time()
            self._cpu_of_all = process_time()
            self._sleeps = _sleeps()
        return now

    def end(self, rule: Rule[Any, Any], began: float) -> None:
        """Warn if the step of `rule` that began at `began` has blocked the loop."""
        took = perf_counter() - began
        if took > BLOCKING:
            seconds, manner = self._judge(took)
            if seconds > BLOCKING:
                log.warning(
                    "rule %s (%s) blocked the loop for %.0f ms by %s: make it a plain function (it then runs in a "
                    "thread), or await the slow call",
                    *(rule.name, rule.origin, 1000 * seconds, manner),
                )

    def _judge(self, took: float) -> tuple[float, str]:
        computed = thread_time() - self._cpu
        if computed > BLOCKING:
            return min(took, computed), "computing"
        slept = took - computed
        others = process_time() - self._cpu_of_all - computed
        chosen, forced = (now - before for now, before in zip(_sleeps(), self._sleeps, strict=True))
        asleep = chosen and not forced and slept / chosen > ASLEEP and others < OTHERS * slept
        return slept if asleep else 0.0, "sleeping"


def _sleeps() -> tuple[int, int]:
    """Return how often this thread slept voluntarily, and how often the scheduler preempted it."""
    if resource is None or not hasattr(resource, "RUSAGE_THREAD"):
        return 0, 0
    usage = resource.getrusage(resource.RUSAGE_THREAD)
    return usage.ru_nvcsw, usage.ru_nivcsw
