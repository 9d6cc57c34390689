"""The reply to an operation on memory. Async rules and plain functions can wait for its result."""

from __future__ import annotations

import asyncio
import functools
import logging
from collections.abc import Callable, Generator
from concurrent.futures import Executor, Future
from typing import Any, Generic, TypeVar

log = logging.getLogger("ravestate.ontology")

T = TypeVar("T")


class Reply(Generic[T]):
    """The future result of an operation. The operation runs even if no code waits for the result.

    If no code asks for the result, an error of the operation goes to the log.

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
        """Wait for the result. This call blocks, so do not use it on the event loop.

        Args:
            timeout: The maximum number of seconds to wait; None for no maximum.

        Raises:
            TimeoutError: The result did not come in time. The operation continues.
            RuleError: The operation is refused; see its description.
            PlatformError: Memory failed; the message says what to do.
        """
        self._looked = True
        return self._future.result(timeout)

    def __await__(self) -> Generator[Any, None, T]:
        # This uses an executor, because a loop in virtual time waits for its executors. If the waiting rule is
        # cancelled, the operation continues.
        self._looked = True
        loop = asyncio.get_running_loop()
        waiting: asyncio.Future[Any] = loop.run_in_executor(_FutureExecutor(self._future), _named(self._what))
        return asyncio.shield(waiting).__await__()

    def __del__(self) -> None:
        if not self._looked:
            self._future.add_done_callback(functools.partial(_tell, self._what))

    def __repr__(self) -> str:
        return f"<reply of {self._what}: {'done' if self._future.done() else 'pending'}>"


def _tell(what: str, future: Future[Any]) -> None:
    error = None if future.cancelled() else future.exception()
    if error is not None:
        log.error("%s failed, and nobody waited for it: %s", what, error)


class _FutureExecutor(Executor):
    """An executor that runs nothing: it returns the future of an operation that is already in progress."""

    def __init__(self, future: Future[Any]) -> None:
        self._future = future

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        return self._future


def _named(what: str) -> Callable[[], None]:
    """Return a function with the name `what`, so that messages show which operation a rule waits for."""

    def function() -> None: ...

    function.__qualname__ = what
    return function
