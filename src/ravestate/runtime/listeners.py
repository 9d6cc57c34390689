"""Functions that observe a context, and tasks that wait for the spikes of a signal."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ravestate.engine.effects import Ended, Spiked


class Listeners:
    """The listeners of one context: functions and waiting tasks, each for one signal.

    This class fills `watched`, the engine's table of the signals whose spikes it reports.
    """

    def __init__(self, watched: dict[str, int], functions: Mapping[str, Callable[[Any], None]]) -> None:
        self._watched = watched
        self._functions = functions
        self._futures: dict[str, list[asyncio.Future[Any]]] = {}
        watched.update(dict.fromkeys(functions, 1))

    async def next(self, signal: str) -> Any:
        """Wait for the next spike of a signal, and return its payload."""
        future: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
        self._futures.setdefault(signal, []).append(future)
        self._watched[signal] = 1
        try:
            return await future
        finally:
            waiting = self._futures.get(signal, [])
            if future in waiting:
                waiting.remove(future)
                if not waiting:
                    del self._futures[signal]
                    if signal not in self._functions:
                        self._watched.pop(signal, None)

    def tell(self, spiked: Spiked) -> None:
        """Call the function of a spike's signal, and wake the tasks that wait for the signal."""
        function = self._functions.get(spiked.signal)
        if function is None:
            self._watched.pop(spiked.signal, None)
        else:
            function(spiked.payload)
        for future in self._futures.pop(spiked.signal, ()):
            if not future.done():
                future.set_result(spiked.payload)

    def fail(self, error: Callable[[str], BaseException]) -> None:
        """Wake all waiting tasks with an error; the function `error` makes it from the name of the task's signal."""
        for signal, futures in self._futures.items():
            for future in futures:
                if not future.done():
                    future.set_exception(error(signal))
        self._futures.clear()


@dataclass(frozen=True, slots=True, kw_only=True)
class Hooks:
    """Functions that a context calls on its loop; `Context.start` takes them.

    Attributes:
        on_ended: Called with the outcome of each run that has ended.
        on_failed: Called with the name of each rule that fails, and with its exception.
        on_endless: Called with the rule that ran last, if an instant of virtual time does not end. If this function is
            given, the context's time is virtual. Plain functions then run one by one, so that threads do not race.
        listeners: Signal's name → a function that is called with the payload of every spike of the signal.
    """

    on_ended: Callable[[Ended], None] | None = None
    on_failed: Callable[[str, BaseException], None] | None = None
    on_endless: Callable[[str], None] | None = None
    listeners: Mapping[str, Callable[[Any], None]] = field(default_factory=dict[str, Callable[[Any], None]])
