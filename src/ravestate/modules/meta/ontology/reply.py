"""What an operation on memory returns at once: its result to come, for async rules and for plain ones."""

from __future__ import annotations

import asyncio
import functools
import logging
from collections.abc import Callable, Generator
from concurrent.futures import Executor, Future
from typing import Any, Generic, TypeVar

__all__ = ["Reply"]

log = logging.getLogger("ravestate.ontology")

T = TypeVar("T")


class Reply(Generic[T]):
    """A result to come. The operation is under way already, whether anybody waits for it or not.

    An error that nobody asks for is logged.

    Example:
        ::

            ada = await memory.create("Person", name="Ada")       # in an async rule
            ada = memory.create("Person", name="Ada").result()    # in a plain function, which runs in a thread
    """

    __slots__ = ("_future", "_looked", "_what")

    def __init__(self, future: Future[T], what: str) -> None:
        self._future = future
        self._what = what
        self._looked = False

    def result(self, timeout: float | None = None) -> T:
        """Wait for the result; not on the event loop, which would stand still.

        Args:
            timeout: Seconds to wait; by default until it is there.

        Raises:
            TimeoutError: It was not there in time. The operation goes on.
            RuleError: See the operation.
            PlatformError: Memory failed; what is wrong, and what to do.
        """
        self._looked = True
        return self._future.result(timeout)

    def __await__(self) -> Generator[Any, None, T]:
        # By way of an executor, because a loop in virtual time waits for what it has lent to one. The operation
        # goes on when who waits for it is cancelled: what was begun is done.
        self._looked = True
        loop = asyncio.get_running_loop()
        waiting: asyncio.Future[Any] = loop.run_in_executor(_Lent(self._future), _named(self._what))
        return asyncio.shield(waiting).__await__()

    def __del__(self) -> None:
        if not self._looked:
            self._future.add_done_callback(functools.partial(_tell, self._what))

    def __repr__(self) -> str:
        return f"<reply of {self._what}: {'there' if self._future.done() else 'to come'}>"


def _tell(what: str, future: Future[Any]) -> None:
    error = None if future.cancelled() else future.exception()
    if error is not None:
        log.error("%s failed, and nobody has waited for it: %s", what, error)


class _Lent(Executor):
    """Stands for whoever works at a future already."""

    def __init__(self, future: Future[Any]) -> None:
        self._future = future

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        return self._future


def _named(what: str) -> Callable[[], None]:
    """A function with a name, for messages that say who is waited for."""

    def function() -> None: ...

    function.__qualname__ = what
    return function
