"""What an inspector looks at: a conversation that goes on, or a trace that was recorded."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from ravestate.board.by_hand import check_payload, check_value
from ravestate.board.commands import Command, Emit, Pause, Put, Resume, Say, Step
from ravestate.board.description import Description, describe
from ravestate.board.gates import gates_of
from ravestate.board.recorder import Gap, Recorder
from ravestate.board.shown import Shown, show
from ravestate.board.trace_file import Recording
from ravestate.board.why_not import Opens
from ravestate.board.wire import VALUE, shown_data, whole_data
from ravestate.engine.trace import Record, Set
from ravestate.errors import RavestateError, UndeclaredError, nearest
from ravestate.modules.platform.webio.protocol import ProtocolError, heard_text

if TYPE_CHECKING:
    from ravestate.modules.platform.webio.session import Session

__all__ = ["Live", "Recorded", "Subject"]

T = TypeVar("T")


class Subject(Protocol):
    """A policy, and records that are numbered from 1 on."""

    description: Description
    live: bool

    @property
    def first(self) -> int:
        """The number of the oldest record that is kept."""
        ...

    @property
    def last(self) -> int:
        """The number of the newest record."""
        ...

    @property
    def whole(self) -> bool:
        """Whether the records reach back to the beginning."""
        ...

    @property
    def opens(self) -> Opens | None:
        """What tells whether gates are open for a value."""
        ...

    def since(self, number: int, most: int) -> list[Record | Gap]:
        """Records after a number, at most so many."""
        ...

    def clock(self) -> dict[str, Any]:
        """``now`` (seconds) and ``paused``."""
        ...

    def look(self) -> dict[str, Any]:
        """The values of slots, and what is alive."""
        ...

    def explain(self, rule: str) -> dict[str, Any]:
        """What a rule holds, lacks and waits for."""
        ...

    async def act(self, command: Command) -> None:
        """Do something.

        Raises:
            RavestateError: It cannot be done.
        """
        ...


class Live:
    """A conversation that goes on.

    Args:
        session: The conversation.
        recorder: That of its context.
    """

    live = True

    def __init__(self, session: Session, recorder: Recorder) -> None:
        self._session = session
        self._context = session.context
        self._recorder = recorder
        self._policy = self._context.policy
        self.description = describe(self._policy)
        self.opens = gates_of(self._policy)

    @property
    def first(self) -> int:
        """The number of the oldest record that is kept."""
        return self._recorder.first

    @property
    def last(self) -> int:
        """The number of the newest record."""
        return self._recorder.last

    @property
    def whole(self) -> bool:
        """Whether the records reach back to the beginning, without a gap."""
        recorder = self._recorder
        return recorder.whole and recorder.first == 1 and not recorder.missed

    def since(self, number: int, most: int) -> list[Record | Gap]:
        """Records after a number, at most so many."""
        return self._recorder.since(number, most)

    def renewed(self) -> bool:
        """Whether the policy has changed since it was described: rules may be added. If so, it is described again."""
        if self._context.policy is self._policy:
            return False
        self._policy = self._context.policy
        self.description = describe(self._policy)
        self.opens = gates_of(self._policy)
        return True

    def clock(self) -> dict[str, Any]:
        """``now`` (seconds) and ``paused``."""
        return {"now": round(self._context.now, 6), "paused": self._context.paused}

    def look(self) -> dict[str, Any]:
        """The values of slots, and what is alive."""
        slots = self._context.policy.slots
        return {
            "slots": {
                name: shown_data(show(self._context.read(slot), VALUE)) for name, slot in slots.items()
            },
            "activations": [
                {"rule": rule, **whole_data(state)}
                for rule in self._policy.rules
                for state in self._context.explain(rule).activations
            ],
        }

    def explain(self, rule: str) -> dict[str, Any]:
        """What a rule holds, lacks and waits for; effective utilities (nats); in data and in words.

        Raises:
            DeclarationError: There is no such rule.
        """
        found = self._context.explain(rule)
        return {
            "now": found.now,
            "retired": found.retired,
            "clauses": [
                {"effective": clause.effective, "gates": [list(gate) for gate in clause.gates]}
                for clause in found.clauses
            ],
            "activations": [whole_data(state) for state in found.activations],
        }

    async def act(self, command: Command) -> None:
        """Do something.

        Raises:
            RavestateError: It cannot be done.
        """
        context = self._context
        if isinstance(command, Say | Put | Emit) and (
            self._session.leaving or self._session.ended is not None
        ):
            about = "is ending" if self._session.ended is None else "has ended"
            raise RavestateError(f"this conversation {about}: nothing more is said, written or raised in it")
        match command:
            case Pause():
                context.pause()
                self._session.notify()
            case Step():
                if not await _outside_of_any_task(context.step):
                    raise RavestateError(
                        "nothing is due: the agent waits for something to come, or for what takes its own time"
                        if context.paused
                        else "the clock is not halted: pause it first"
                    )
            case Resume():
                context.resume()
                self._session.notify()
            case Put():
                slot = self._named(context.policy.slots, "slot", command.slot)
                check_value(slot, command.value, context.read(slot))
                context.put(slot, command.value)
            case Emit():
                signal = self._named(context.policy.signals, "signal", command.signal)
                number = context.policy.signal_of[signal.name].slot
                slot = None if number is None else context.policy.slot_plans[number].slot
                check_payload(signal, command, slot, None if slot is None else context.read(slot))
                context.emit(signal, command.payload)
            case Say():
                self._say(command.text)
            case _:
                raise RavestateError(f"{command.type} is not for an agent")

    def leave(self) -> None:
        """Nobody looks any more: an agent whose clock was halted goes on."""
        if self._session.ended is None and self._context.paused:
            self._context.resume()
            self._session.notify()

    def _say(self, text: str) -> None:
        try:
            heard = heard_text(text)
        except (
            ProtocolError
        ) as error:  # of the visitor's protocol; here it is what was asked for that cannot be done
            raise RavestateError(str(error)) from None
        self._session.hear(f"board-{secrets.token_hex(8)}", heard)

    def _named(self, things: Any, what: str, name: str) -> Any:
        if name not in things:
            raise UndeclaredError(f"this agent has no {what} {name!r}{nearest(name, things)}")
        return things[name]


async def _outside_of_any_task(function: Callable[[], T]) -> T:
    """Call a function on the loop, but not within this task: what starts rules must not."""
    loop = asyncio.get_running_loop()
    called: asyncio.Future[T] = loop.create_future()

    def call() -> None:
        try:
            result = function()
        except Exception as error:
            if not called.done():  # else who asked is gone
                called.set_exception(error)
        else:
            if not called.done():
                called.set_result(result)

    loop.call_soon(call)
    return await called


class Recorded:
    """A trace that was recorded."""

    live = False
    opens = None
    first = 1

    def __init__(self, recording: Recording) -> None:
        self.description = recording.description
        self.whole = recording.whole
        self.title = recording.title
        self._records = recording.records
        self.last = len(recording.records)

    def since(self, number: int, most: int) -> list[Record | Gap]:
        """Records after a number, at most so many."""
        return list(self._records[number : number + most])

    def clock(self) -> dict[str, Any]:
        """When it ends (seconds)."""
        return {"now": self._records[-1].time if self._records else 0.0, "paused": True}

    def look(self) -> dict[str, Any]:
        """The values that slots had at the end, as far as they were written."""
        values = {record.slot: record.value for record in self._records if isinstance(record, Set)}
        return {
            "slots": {
                name: shown_data(value if isinstance(value, Shown) else show(value, VALUE))
                for name, value in values.items()
            },
            "activations": [],
        }

    def explain(self, rule: str) -> dict[str, Any]:
        """Nothing is known of a moment that nobody asked about."""
        raise RavestateError("this is a recording: there is no agent that could be asked")

    async def act(self, command: Command) -> None:
        """Nothing can be done."""
        raise RavestateError(f"this is a recording: there is no agent that could take {command.type!r}")
