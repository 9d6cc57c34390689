"""Functions that observe a context, and tasks that wait for the spikes of a signal."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from ravestate.engine.effects import Ended, Spiked


class Waiter:
    """A task that waits for the next spike of a signal; `future` wakes the task when the spike comes."""

    __slots__ = ("done", "error", "future", "payload")

    def __init__(self) -> None:
        self.done = False
        self.error: BaseException | None = None
        self.payload: Any = None
        self.future: asyncio.Future[None] | None = None


class Listeners:
    """The listeners of one context. Each is a function or a waiting task, and listens to one signal.

    This class fills `watched`, the table of the signals whose spikes the engine reports.
    """

    __slots__ = ("_functions", "_waiters", "_watched")

    def __init__(
        self,
        watched: dict[str, int],
        functions: Mapping[str, Callable[[Any], None]],
    ) -> None:
        self._watched = watched
        self._functions = functions
        self._waiters: dict[str, list[Waiter]] = {}
        watched.update(dict.fromkeys(functions, 1))

    async def next(self, signal: str, settle: Callable[[], None] = lambda: None) -> Any:
        """Wait for a signal's next spike, and return its payload. First call `settle`, which may raise the signal."""
        waiter = Waiter()
        self._waiters.setdefault(signal, []).append(waiter)
        self._watched[signal] = 1
        try:
            settle()
            if waiter.error is not None:
                raise waiter.error
            if not waiter.done:
                waiter.future = asyncio.get_running_loop().create_future()
                await waiter.future
            return waiter.payload
        finally:
            if not waiter.done:
                waiting = self._waiters.get(signal, [])
                if waiter in waiting:
                    waiting.remove(waiter)
                    if not waiting:
                        del self._waiters[signal]
                        if signal not in self._functions:
                            self._watched.pop(signal, None)

    def tell(self, spiked: Spiked) -> None:
        """Call the function of a spike's signal, and wake the tasks that wait for the signal."""
        signal = spiked.signal
        if signal in self._functions:
            self._functions[signal](spiked.payload)
        elif signal in self._watched:
            del self._watched[signal]
        if signal not in self._waiters:
            return
        waiters = self._waiters[signal]
        del self._waiters[signal]
        for waiter in waiters:
            waiter.done = True
            waiter.payload = spiked.payload
            if waiter.future is not None and not waiter.future.done():
                waiter.future.set_result(None)

    def fail(self, error: Callable[[str], BaseException]) -> None:
        """Raise an exception in all waiting tasks. `error` makes the exception from the name of a task's signal."""
        for signal, waiters in self._waiters.items():
            for waiter in waiters:
                waiter.error = error(signal)
                if waiter.future is not None and not waiter.future.done():
                    waiter.future.set_exception(waiter.error)
        self._waiters.clear()


@dataclass(frozen=True, slots=True, kw_only=True)
class Hooks:
    """Functions that a context calls on its loop; `Context.start` takes them.

    Attributes:
        on_ended: Called with the outcome of each run that has ended.
        on_failed: Called with the name of each rule that fails, or whose predicate fails, and with the exception.
        on_endless: Called with the name of the last rule that ran, if an instant of virtual time does not end. If this
            hook is set, the context's time is virtual (as in a simulation). Plain functions then run one by one, so
            that threads do not race.
        listeners: Name of a signal → a function to call with the payload of every spike of the signal.
    """

    on_ended: Callable[[Ended], None] | None = None
    on_failed: Callable[[str, BaseException], None] | None = None
    on_endless: Callable[[str], None] | None = None
    listeners: Mapping[str, Callable[[Any], None]] = field(default_factory=dict[str, Callable[[Any], None]])


NO_HOOKS: Final = Hooks()
"""Hooks without functions, shared by all contexts that nothing observes."""
