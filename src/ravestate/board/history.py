"""An index of a trace for one causal group: the group's spikes, and each rule's attempts to run on them.

The board builds a new index for each question about a spike. The index needs only the records of the trace.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from operator import attrgetter

from ravestate.board.description import Description, RuleView
from ravestate.engine import trace as t
from ravestate.engine.explain import join, seconds
from ravestate.engine.reasons import Outcome
from ravestate.engine.standing import lead
from ravestate.engine.trace import GaveUp, Passed, Waits

BY_TIME = attrgetter("time")


@dataclass(slots=True)
class Attempt:
    """One activation of a rule, as far as the trace shows it.

    `lacks` has the signals for which the attempt has no spike. If the attempt loses its last spikes in one instant,
    `lacks` stays as it was before that instant: it then names the signals that were missing before the loss. `complete`
    is the time at which the attempt took its last missing spike (seconds); None while a spike is missing. `started` is
    None until the run starts. `settled` is None until the run ends.
    """

    id: int
    rule: str
    clause: int
    records: list[t.Record] = field(default_factory=list[t.Record])
    held: list[t.Held] = field(default_factory=list[t.Held])  # all spikes that it took, including those that it lost
    lacks: tuple[str, ...] = ()
    complete: float | None = None
    waits: list[t.Waits] = field(default_factory=list[t.Waits])
    gave_up: list[t.GaveUp] = field(default_factory=list[t.GaveUp])  # the latest losses, all of one instant
    started: t.Started | None = None
    settled: t.Settled | None = None
    _missing: tuple[str, ...] = ()  # the signals for which it has no spike now
    _before: tuple[str, ...] = ()  # the value of `_missing` before the latest losses
    _holds: set[int] = field(default_factory=set[int])  # the numbers of the spikes that it holds now

    @property
    def over(self) -> bool:
        """Whether the attempt has ended."""
        return self.settled is not None or (self.started is None and not self._holds)

    @property
    def end(self) -> float | None:
        """The time at which the attempt ended (seconds); None if it has not ended."""
        if self.settled is not None:
            return self.settled.time
        return self.gave_up[-1].time if self.over and self.gave_up else None

    @property
    def kept(self) -> Iterable[str]:
        """The signals whose spikes the attempt holds."""
        return dict.fromkeys(held.signal for held in self.held if held.spike in self._holds)

    @property
    def spikes(self) -> Iterable[int]:
        """The numbers of the spikes with which the attempt's run began; without a run, of all spikes that it took."""
        return [held.spike for held in self.held] if self.started is None else self.started.spikes

    def take(self, record: t.Held) -> None:
        """Record a spike that the activation took."""
        self.held.append(record)
        self._holds.add(record.spike)
        self.lacks = self._missing = record.lacks
        self.complete = None if record.lacks else record.time
        self.gave_up.clear()

    def lose(self, record: t.GaveUp) -> None:
        """Record a spike that the activation gave up."""
        if not self.gave_up or self.gave_up[-1].time != record.time:
            self._before = self._missing
            self.gave_up.clear()
        self._missing = (*self._missing, record.signal)
        self.gave_up.append(record)
        self._holds.discard(record.spike)
        self.lacks = self._missing if self._holds else self._before
        if self._holds:
            self.complete = None


class History:
    """A trace, indexed for questions about the causal group of one spike, *the group*.

    Raises:
        LookupError: The trace does not contain the spike, or no longer contains it.
    """

    def __init__(self, records: Iterable[t.Record], spike: int) -> None:
        # "By spike", "by run" and "by activation": the key is a number. "By rule" and "by slot": the key is a name.
        self.born: dict[int, t.Born] = {}  # by spike
        self.attempts: dict[str, list[Attempt]] = {}  # by rule
        self.passed: dict[str, list[t.Passed]] = {}  # by rule
        self.pressed: dict[str, list[t.Pressed]] = {}  # by rule
        self.writes: dict[int, list[t.Set]] = {}  # by run
        self.values: dict[str, list[t.Set]] = {}  # by slot
        self.retired: dict[str, float] = {}  # rule → the time at which it retired
        self.fired: dict[str, list[float]] = {}  # rule → the times at which its runs fired
        self.raising: dict[tuple[int, str], float] = {}  # run, signal → the time at which the run first raised it
        self.dropped: dict[int, t.Dropped] = {}  # by spike
        self.first = self.last = 0.0  # the times of the first and the last record
        self._runs: dict[int, Attempt] = {}  # by activation
        self._into: dict[int, int] = {}  # group → the group that it merged into
        self._answers: list[Attempt] = []  # the attempts that fired, in the order of their ends
        self._of: dict[str, list[Attempt]] = {}  # the results of `of`
        for number, record in enumerate(records):
            self.first = record.time if not number else self.first
            self.last = record.time
            self._read(record)
        if spike not in self.born:
            raise LookupError(f"spike {spike} is not in the history that is kept")
        self.spike = self.born[spike]
        root = self.root(self.spike.group)
        self.group = {id for id, born in self.born.items() if self.root(born.group) == root}

    def root(self, group: int) -> int:
        """Return the group into which a group has finally merged; without a merger, the group itself."""
        root = group
        while root in self._into:
            root = self._into[root]
        while group != root:  # shorten the path for the next call
            self._into[group], group = root, self._into[group]
        return root

    def of(self, rule: str) -> list[Attempt]:
        """Return the attempts of a rule on spikes of the group, in the order of their start."""
        if rule not in self._of:
            self._of[rule] = [a for a in self.attempts.get(rule, []) if self._is_ours(a)]
        return self._of[rule]

    def raised(self, signal: str) -> list[t.Born]:
        """Return the records of the spikes of a signal in the group."""
        return [self.born[id] for id in self.group if self.born[id].signal == signal]

    def ran(self, rule: str, time: float) -> bool:
        """Return whether a rule was running for the group at a time (seconds)."""
        return any(
            attempt.started is not None
            and attempt.started.time <= time
            and (attempt.end is None or attempt.end >= time)
            for attempt in self.of(rule)
        )

    def answered(self, hears: Mapping[str, Sequence[Collection[str]]]) -> Attempt | None:
        """Return the first run of a rule in `hears` that answered the group; None if none did.

        A run answers the group if it counts as done (`fired`) and consumes one of the group's spikes. For each rule,
        `hears` has one collection for each clause: the signals that the clause consumes. A detached constraint consumes
        no spike (law L19).
        """

        def is_taken(attempt: Attempt, signals: Collection[str]) -> bool:
            return any(spike in self.group and self.born[spike].signal in signals for spike in attempt.spikes)

        return next((a for a in self._answers if a.rule in hears and is_taken(a, hears[a.rule][a.clause])), None)

    def before(self, run: int) -> str:
        """Return the name of a rule, other than the run's own, that raised one of the run's spikes.

        Only spikes of the group count. If there is no such rule, or the trace does not show it, the name is empty.
        """
        attempt = self._runs.get(run)
        if attempt is None or attempt.started is None:
            return ""
        for spike in attempt.started.spikes:
            if spike in self.group:
                source = self._runs.get(self.born[spike].source)
                if source is not None and source.rule != attempt.rule:
                    return source.rule
        return ""

    def value(self, slot: str, time: float) -> t.Set | None:
        """Return the record of a slot's last write up to a time (seconds); None if the trace has no such record."""
        written = self.values.get(slot, [])
        number = bisect_right(written, time, key=BY_TIME)
        return written[number - 1] if number else None

    def _is_ours(self, attempt: Attempt) -> bool:
        held = (one.spike for one in attempt.held)
        return any(spike in self.group for spike in (*held, *attempt.spikes))

    def _attempt(self, id: int, record: t.Held | t.Started) -> Attempt:
        attempt = self._runs.get(id)
        if attempt is None:
            attempt = self._runs[id] = Attempt(id, record.rule, record.clause)
            self.attempts.setdefault(record.rule, []).append(attempt)
        attempt.records.append(record)
        return attempt

    def _read(self, record: t.Record) -> None:
        match record:
            case t.Born():
                self.born[record.spike] = record
                self.raising.setdefault((record.source, record.signal), record.time)
            case t.Held():
                self._attempt(record.activation, record).take(record)
            case t.Started():
                self._attempt(record.run, record).started = record
            case t.GaveUp() | t.Waits():
                attempt = self._runs.get(record.activation)
                if attempt is not None:  # None: the attempt began before the first record
                    attempt.records.append(record)
                    if isinstance(record, t.GaveUp):
                        attempt.lose(record)
                    else:
                        attempt.waits.append(record)
            case t.Told() | t.Settled():
                attempt = self._runs.get(record.run)
                if attempt is not None:
                    attempt.records.append(record)
                if isinstance(record, t.Settled):
                    self._settle(record, attempt)
            case t.Passed():
                self.passed.setdefault(record.rule, []).append(record)
            case t.Pressed():
                self.pressed.setdefault(record.rule, []).append(record)
            case t.Set():
                self.writes.setdefault(record.run, []).append(record)
                self.values.setdefault(record.slot, []).append(record)
            case t.Merged():
                if self.root(record.into) != record.group:  # a damaged file may merge groups in a circle
                    self._into[record.group] = record.into
            case t.Dropped():
                self.dropped[record.spike] = record

    def _settle(self, record: t.Settled, attempt: Attempt | None) -> None:
        if attempt is not None:
            attempt.settled = record
            if record.fired:
                self._answers.append(attempt)
        if record.fired:
            self.fired.setdefault(record.rule, []).append(record.time)
        if record.outcome == Outcome.RETIRED:
            self.retired.setdefault(record.rule, record.time)


class Rivals:
    """Writes what an explanation says about a rule's rivals (it waits for them), or about the rule that answered first."""

    def __init__(self, history: History, description: Description) -> None:
        self._history = history
        self._description = description
        self._first: dict[str, Attempt | None] = {}  # rule → the run of another rule that answered first

    def waited(self, rule: RuleView, attempt: Attempt) -> str:
        """Return a phrase with the rules that the attempt last waited for; an empty text if it did not wait."""
        if not attempt.waits:
            return ""
        return f"it was ready and waited for {self.names(rule, attempt, attempt.waits[-1])}"

    def names(self, rule: RuleView, attempt: Attempt, wait: Waits) -> str:
        """Return the names of the rules that the attempt waited for, each with the reason why it went first."""
        parts: list[str] = []
        for name in wait.for_:
            if name == rule.name:
                parts.append("another run of its own on the same spike")
            elif self._history.ran(name, wait.time):
                other = self._description.rule(name)
                common = [] if other is None else [slot for slot in rule.writes if slot in other.writes]
                parts.append(f"{name}, which was running and had taken {join(common) or 'the spike'}")
            else:
                parts.append(f"{name}{self.ahead(name, rule, attempt, wait.time)}")
        return join(parts)

    def ahead(self, name: str, rule: RuleView, attempt: Attempt, time: float) -> str:
        """Return a text in brackets: by how much effective utility (nats) the rule `name` is ahead of `rule`.

        If both utilities are equal, the text says what decides instead (L15). If `rule` is ahead, the text is empty.
        """
        other = self._description.rule(name)
        if other is None or name == rule.name:
            return ""
        theirs, mine = other.weight * self._recovered(other, time), rule.weight * self._recovered(rule, time)
        worth = max((clause.utility for clause in other.clauses), default=0.0) * theirs
        nats = lead(worth, rule.clauses[attempt.clause].utility * mine)
        if nats:
            return f" ({nats:.3f} nats ahead)" if nats > 0 else ""
        heavier = 0.0 if worth else lead(theirs, mine)
        if heavier:
            return " (both utilities are 0, greater weight × recovery)" if heavier > 0 else ""
        return " (equal utility, declared earlier)" if self._is_earlier(other, rule) else ""

    def answerer(self, rule: RuleView, lost: GaveUp | Passed) -> tuple[str, str]:
        """Return the name of the rule that answered a lost spike, and a text with this name.

        If another rule raised a spike on which the answering rule ran, the text is ``raiser → name``. Otherwise, the
        text is the name.
        """
        by, run = (lost.by, lost.run) if lost.by else self._answered(rule, lost.time)
        before = self._history.before(run)
        return by, f"{before} → {by}" if before else by

    def pressure(self, rule: RuleView, end: float) -> str:
        """Return a phrase: which rule waited for `rule`, from when on, and when the patience of `rule` ran out.

        If rules waited for `rule` several times, the phrase is about the last wait that was over by `end` (seconds).
        """
        pressed = self._history.pressed.get(rule.name, [])
        # `pressed` is sorted by `until`, because a rule's patience never changes.
        over = bisect_right(pressed, end, key=lambda wait: wait.until)
        ended = f"this rule's patience ran out at {seconds(end)}"
        if not over:
            return ended
        last = pressed[over - 1]
        return f"{last.by} waited for it from {seconds(last.time)} on, and {ended}"

    def _is_earlier(self, one: RuleView, other: RuleView) -> bool:
        """Return whether `one` is declared before `other`."""
        return next(rule for rule in self._description.rules if rule.name in (one.name, other.name)) == one

    def _recovered(self, rule: RuleView, time: float) -> float:
        """Return how far a rule has recovered since its last run, from 0 to 1 (L9)."""
        fired = self._history.fired.get(rule.name, [])
        runs = bisect_right(fired, time)
        return min(1.0, (time - fired[runs - 1]) / rule.cooldown) if rule.cooldown and runs else 1.0

    def _answered(self, rule: RuleView, time: float) -> tuple[str, int]:
        """Return the rule, other than `rule`, that first answered the group, and the number of its activation.

        Only rules that write a slot of `rule` count, and only answers up to `time` (seconds). If the trace shows no
        such answer, return ``("another rule", 0)``.
        """
        if rule.name not in self._first:
            slots = set(rule.writes)
            self._first[rule.name] = self._history.answered(
                {
                    other.name: [{c.signal for c in clause.constraints if not c.detached} for clause in other.clauses]
                    for other in self._description.rules
                    if other.name != rule.name and slots & set(other.writes)
                }
            )
        first = self._first[rule.name]
        if first is None or first.end is None or first.end > time:
            return "another rule", 0
        return first.rule, first.id
