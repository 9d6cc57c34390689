"""The spare task of a loop, in which the next async rule starts. All contexts on the loop share this task in turn.

If the rule suspends, the spare task *adopts* the rule's coroutine, and is no longer spare (``eager_task.py``).
"""

from __future__ import annotations

import asyncio
import contextvars
from weakref import WeakKeyDictionary

from ravestate.runtime.blocking import StepTimer
from ravestate.runtime.eager_task import EagerTask, are_equal


class Spares:
    """Lends the spare task of one loop to contexts. When the last context leaves, the spare task ends."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self.timer = StepTimer()
        self._loop = loop
        self._spare: EagerTask | None = None
        self._users = 0
        self._variables = contextvars.copy_context()

    @staticmethod
    def join(loop: asyncio.AbstractEventLoop) -> Spares:
        """Record that a context has started on a loop, and return the loop's spares."""
        spares = ALL.get(loop)
        if spares is None:
            spares = ALL[loop] = Spares(loop)
        spares._users += 1
        return spares

    def leave(self) -> None:
        """Record that a context has ended."""
        self._users -= 1
        if not self._users:
            ALL.pop(self._loop, None)
            if self._spare is not None:
                self._spare.close()
                self._spare = None

    def variables(self) -> contextvars.Context:
        """Return a copy of the present context variables: the last call's copy, if they have not changed."""
        variables = contextvars.copy_context()
        if not are_equal(variables, self._variables):
            self._variables = variables
        return self._variables

    def take(self, variables: contextvars.Context) -> EagerTask:
        """Return a spare task with these context variables. If it adopts no coroutine, `give` it back."""
        spare, self._spare = self._spare, None
        if spare is not None:
            if spare.suits(variables) and not spare.task.done():
                return spare
            spare.close()
        return EagerTask(self._loop, self.timer, variables)

    def give(self, spare: EagerTask) -> None:
        """Take back a spare task that has adopted no coroutine."""
        if self._spare is None and self._users and not spare.spoilt:
            self._spare = spare
        else:
            spare.close()


ALL: WeakKeyDictionary[asyncio.AbstractEventLoop, Spares] = WeakKeyDictionary()
"""Loop → its spares."""
