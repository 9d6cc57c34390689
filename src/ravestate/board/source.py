"""The sources of an inspector's data: a running conversation or a recording. An inspector serves one open board."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

from ravestate.board.description import describe
from ravestate.board.manual_input import check_payload, check_value
from ravestate.board.protocol import (
    Alive,
    ClientFrame,
    Clock,
    Emit,
    Explained,
    ExplainedClause,
    Put,
    Say,
    State,
    fields_of,
)
from ravestate.board.recorder import Gap, Recorder
from ravestate.board.rendering import Rendered, render
from ravestate.board.trace_file import Recording
from ravestate.board.why_not import Opens
from ravestate.board.wire import VALUE
from ravestate.engine.trace import Record, Set
from ravestate.errors import RavestateError, UndeclaredError, nearest
from ravestate.modules.platform.webio.fields import ProtocolError, heard_text
from ravestate.policy.policy import Policy

if TYPE_CHECKING:
    from ravestate.modules.platform.webio.session import Session

T = TypeVar("T")


class LiveSource:
    """A running conversation: its policy, and its records, numbered from 1."""

    live = True

    def __init__(self, session: Session, recorder: Recorder) -> None:
        self._session = session
        self._context = session.context
        self._recorder = recorder
        self._describe()

    def _describe(self) -> None:
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
        """Whether the records reach back to the start of the context without a gap."""
        recorder = self._recorder
        return recorder.whole and recorder.first == 1 and not recorder.missed

    def since(self, number: int, most: int) -> list[Record | Gap]:
        """Return the records with numbers greater than `number`, oldest first, at most `most`."""
        return self._recorder.since(number, most)

    def renewed(self) -> bool:
        """If a rule was added since the last call, describe the policy again and return True."""
        if self._context.policy is self._policy:
            return False
        self._describe()
        return True

    def clock(self) -> tuple[float, bool]:
        """Return the time on the context's clock (seconds), and whether the clock is stopped."""
        return round(self._context.now, 6), self._context.paused

    def look(self) -> State:
        """Return the values of the slots and the live activations."""
        slots = self._context.policy.slots
        return State(
            {name: render(self._context.read(slot), VALUE) for name, slot in slots.items()},
            [
                Alive(**fields_of(state), rule=rule)
                for rule in self._policy.rules
                for state in self._context.explain(rule).activations
            ],
            *self.clock(),
        )

    def explain(self, rule: str) -> Explained:
        """Return the current state of a rule: its spikes, its missing signals, and the rules that it waits for."""
        found = self._context.explain(rule)
        clauses = [ExplainedClause(clause.effective, clause.gates) for clause in found.clauses]
        return Explained(rule, found.now, found.retired, clauses, list(found.activations))

    async def act(self, command: ClientFrame) -> None:
        """Carry out a command from the page, or refuse it with a `RavestateError`."""
        context = self._context
        if isinstance(command, Say | Put | Emit) and (self._session.leaving or self._session.ended is not None):
            about = "is ending" if self._session.ended is None else "has ended"
            raise RavestateError(f"this conversation {about}: it takes no more input")
        match command:
            case Clock(type="pause"):
                context.pause()
                self._session.notify()
            case Clock(type="step"):
                if not await outside_of_any_task(context.step):
                    raise RavestateError(
                        "nothing is due: the agent waits for input, or for work that its clock does not control, such as a thread"
                        if context.paused
                        else "the clock is running: pause it first"
                    )
            case Clock(type="resume"):
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
                try:
                    heard = heard_text(command.text)
                except ProtocolError as error:  # refuse this command, but keep the connection
                    raise RavestateError(str(error)) from None
                self._session.hear(f"board-{secrets.token_hex(8)}", heard)
            case _:
                raise RavestateError(f"an agent takes no {command.type!r}")

    def leave(self) -> None:
        """Start the context's clock again if it is stopped. Call this when the last inspector has left."""
        if self._session.ended is None and self._context.paused:
            self._context.resume()
            self._session.notify()

    def _named(self, things: Any, what: str, name: str) -> Any:
        if name not in things:
            raise UndeclaredError(f"this agent has no {what} {name!r}{nearest(name, things)}")
        return things[name]


async def outside_of_any_task(function: Callable[[], T]) -> T:
    """Call a function on the loop, outside this task, and return its result.

    If the function ran in this task, cancelling the task would also cancel the rules that the function started.
    """
    loop = asyncio.get_running_loop()
    called: asyncio.Future[T] = loop.create_future()

    def call() -> None:
        try:
            result = function()
        except Exception as error:
            if not called.done():  # the future is already done if the caller was cancelled
                called.set_exception(error)
        else:
            if not called.done():
                called.set_result(result)

    loop.call_soon(call)
    return await called


def gates_of(policy: Policy) -> Opens:
    """Return a function that says whether a slot predicate of a policy is true for a value (see `Opens`)."""
    guards = {(rule.name, clause.number): clause.guards for rule in policy.rule_plans for clause in rule.clauses}

    def opens(rule: str, clause: int, number: int, value: Any) -> bool | None:
        found = guards.get((rule, clause), ())
        if number >= len(found):
            return None
        try:
            return bool(found[number][1].predicate(value))
        except Exception:  # a user's predicate may raise anything; it then counts as false
            return False

    return opens


class RecordedSource:
    """A recording, as a source: its policy, and its records, numbered from 1."""

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
        """Return the records with numbers greater than `number`, oldest first, at most `most`."""
        return list(self._records[number : number + most])

    def clock(self) -> tuple[float, bool]:
        """Return the time of the recording's end (seconds), and True: its clock is stopped."""
        return self._records[-1].time if self._records else 0.0, True

    def look(self) -> State:
        """Return the last written value of each slot."""
        values = {record.slot: record.value for record in self._records if isinstance(record, Set)}
        slots = {name: value if isinstance(value, Rendered) else render(value, VALUE) for name, value in values.items()}
        return State(slots, [], *self.clock())

    def explain(self, rule: str) -> Explained:
        """Refuse the request: a recording has no live state of a rule."""
        raise RavestateError("this is a recording: there is no agent to ask")

    async def act(self, command: ClientFrame) -> None:
        """Refuse every command: there is no agent."""
        raise RavestateError(f"this is a recording: there is no agent to take {command.type!r}")


Source = LiveSource | RecordedSource
