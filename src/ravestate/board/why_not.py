"""Explanations of why a rule did not fire for the cause of a spike (law L25). They need the trace and the policy.

A user asks about one spike and one rule. The answer is about the spike's causal group: all spikes with the same cause.
An *attempt* is an activation of the rule with spikes of this group (``history.py``). The answer names the furthest step
that an attempt reached, and the reason why the attempt stopped there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any

from ravestate.board.answer import Missing, Moment, Raiser, WhyNot
from ravestate.board.description import ClauseView, Description, RuleView
from ravestate.board.history import Attempt, History, Rivals
from ravestate.engine.explain import join, latest, seconds, why_given_up, without, words_of
from ravestate.engine.reasons import DropReason, LossReason, Outcome, PassReason, Verdict
from ravestate.engine.trace import GaveUp, Passed, Record, Settled, Waits

DEEPEST = 3  # the maximum length of a chain of causes in an answer

MOST = 200
"""The maximum number of moments in an answer. If there are more, the middle is left out."""

Opens = Callable[[str, int, int, Any], bool | None]
"""A function that returns whether a slot predicate accepts a value, or None if it cannot tell. Its arguments are the
name of the rule, the index of the clause, the index of the predicate in the clause, and the value."""


def why_not(
    records: Iterable[Record],
    description: Description,
    rule: str,
    spike: int,
    opens: Opens | None = None,
    whole: bool = True,
) -> WhyNot:
    """Return why a rule did not fire for the cause of a spike; if it did fire, return a report of its run.

    Args:
        records: The records of the trace, oldest first.
        description: The policy.
        rule: The name of the rule.
        spike: The number of the spike.
        opens: A function that evaluates slot predicates; None if the policy is not live.
        whole: Whether the trace has all records. If not, the answer may be incomplete.

    Raises:
        LookupError: The policy does not have this rule, or the trace does not have this spike.
    """
    view = description.rule(rule)
    if view is None:
        raise LookupError(f"there is no rule {rule!r}")
    history = History(records, spike)
    return _Inquiry(history, description, opens).answer(view, whole or history.first < history.spike.time)


Reached = tuple[Verdict, str, float | None]
"""The furthest step that an attempt reached, the reason as text, and the time at which this was decided (seconds).

For a run that is in progress, the time is the start of the run. The time is None while an attempt holds spikes but does
not run, or if none of the rule's signals occurred for the cause.
"""

Judgement = tuple[Verdict, str, float | None, Attempt | None]
"""The values of a `Reached`, and the attempt that reached the step. The attempt is None if there was none."""

ORDER = {verdict: place for place, verdict in enumerate(Verdict)}


class _Inquiry:
    def __init__(self, history: History, description: Description, opens: Opens | None) -> None:
        self.history = history
        self.description = description
        self.opens = opens
        self.rivals = Rivals(history, description)
        # The rules that are being explained. None of them is explained again inside, so a circle of causes ends.
        self.asked: list[str] = []
        self._judged: dict[str, Judgement] = {}

    def answer(self, rule: RuleView, whole: bool) -> WhyNot:
        born = self.history.spike
        verdict, words, at, attempt = self.judge(rule)
        lacked = verdict in (Verdict.LACKED, Verdict.ELIMINATED, Verdict.UNTOUCHED)
        missing = self.missing(rule, attempt) if lacked else ()
        moments = _abridged(sorted(self.moments(rule), key=lambda moment: moment.time))
        clause = None if attempt is None else attempt.clause
        return WhyNot(
            rule.name, born.spike, born.signal, born.time, verdict, words, at, clause, missing, moments, whole
        )

    # ------------------------------------------------------------------------------------ the verdict

    def judge(self, rule: RuleView) -> Judgement:
        """Return the furthest step that the rule's attempts in this group reached, and the attempt that reached it."""
        if rule.name not in self._judged:
            tried = [(*self._judge(rule, attempt), attempt) for attempt in self.history.of(rule.name)]
            self._judged[rule.name] = (
                min(tried, key=lambda one: ORDER[one[0]]) if tried else (*self._never_tried(rule), None)
            )
        return self._judged[rule.name]

    def _never_tried(self, rule: RuleView) -> Reached:
        retired = self.history.retired.get(rule.name)
        if retired is not None and retired <= self.history.spike.time:
            return Verdict.RETIRED, f"it had already retired, at {seconds(retired)}", retired
        passed = self._passed(rule)
        if passed:
            first = passed[0]
            reason = PassReason.say(first.reason)
            if first.reason == PassReason.CONSUMED:
                reason = f"{self.rivals.answerer(rule, first)[1]} had already answered this cause"
            elif first.reason == PassReason.CAUSED:
                reason += ", and a rule never causes itself"
            return Verdict.PASSED, f"it did not take {first.signal}: {reason}", first.time
        if retired is not None:
            return Verdict.RETIRED, f"it retired at {seconds(retired)} without a spike of this cause", retired
        return Verdict.UNTOUCHED, "none of the signals that it hears occurred for this cause", None

    def _judge(self, rule: RuleView, attempt: Attempt) -> Reached:
        settled = attempt.settled
        if settled is not None:  # the start of the run may be in a gap of the trace
            began = settled.time if attempt.started is None else attempt.started.time
            return self._ran(attempt, began, settled)
        if attempt.started is not None:
            began = attempt.started.time
            return Verdict.RUNNING, f"it has been running since {seconds(began)}", began
        clause = rule.clauses[attempt.clause]
        ripe = self._ripe(clause, attempt)
        if not attempt.over:
            return self._pending(rule, clause, attempt, ripe)
        end = attempt.end or 0.0
        last = attempt.gave_up[-1]
        held = join(dict.fromkeys(held.signal for held in attempt.held))
        if last.reason == LossReason.WITHDRAWN:
            dropped = self.history.dropped.get(last.spike)
            why = f": {DropReason.say(dropped.reason)}" if dropped is not None else ""
            return Verdict.WITHDRAWN, f"{last.signal} was withdrawn at {seconds(end)}{why}", end
        if last.reason == LossReason.RETIRED:
            return Verdict.RETIRED, f"it retired at {seconds(end)} while it held {held}", end
        lost = self._lost(rule, last, clause)
        if attempt.lacks:
            lacked = f"it took {held} but lacked {join(attempt.lacks)}"
            if last.reason == LossReason.ELIMINATED:
                return Verdict.ELIMINATED, f"{lacked}; {self.rivals.pressure(rule, end)}", end
            return Verdict.LACKED, f"{lacked}; {lost}", end
        waited = self.rivals.waited(rule, attempt)
        if ripe is not None and end < ripe:
            return Verdict.YOUNG, "; ".join(filter(None, (waited, _young(clause, ripe), lost))), end
        if self._was_gated(rule, attempt, ripe, last):
            return Verdict.GATED, f"{_gated(clause, waited)}; {lost}", end
        if last.reason != LossReason.CONSUMED:
            return Verdict.LACKED, f"{waited or f'it took {held}'}; {lost}", end
        by, path = self.rivals.answerer(rule, last)
        if waited:
            return Verdict.OUTRUN, f"{waited}; {path} answered at {seconds(end)}", end
        ahead = self.rivals.ahead(by, rule, attempt, end)
        words = f"it was ready, but {path}{ahead} came first and answered at {seconds(end)}"
        return Verdict.OUTRUN, words, end

    def _ran(self, attempt: Attempt, began: float, settled: Settled) -> Reached:
        reason = f": {settled.reason}" if settled.reason else ""
        at = settled.time
        if settled.outcome == Outcome.FAILED and settled.fired:
            return (
                Verdict.FIRED,
                f"it fired at {seconds(began)}, and failed after its write at {seconds(at)}{reason}",
                at,
            )
        if settled.outcome == Outcome.FAILED:
            return Verdict.FAILED, f"it ran at {seconds(began)} and failed{reason}", at
        if settled.outcome == Outcome.RESIGNED:
            return Verdict.RESIGNED, f"it ran at {seconds(began)} and resigned{reason or ' without a reason'}", at
        if not settled.fired:  # L20: only a wipe stops a run in this way, even if the stopped run then retires its rule
            ends = map(Outcome.say, dict.fromkeys((Outcome.WIPED, settled.outcome)))
            return Verdict.WITHDRAWN, f"{join((f'it ran at {seconds(began)}', *ends))}{reason}", at
        parts = [f"it fired at {seconds(began)}"]
        slots = dict.fromkeys(write.slot for write in self.history.writes.get(attempt.id, ()))
        if slots:
            parts.append(f"wrote {join(slots)}")
        if settled.outcome != Outcome.DONE:
            parts.append(Outcome.say(settled.outcome))
        return Verdict.FIRED, join(parts), at

    def _pending(self, rule: RuleView, clause: ClauseView, attempt: Attempt, ripe: float | None) -> Reached:
        """Return the furthest step of an attempt that still holds spikes but does not run."""
        if attempt.lacks or attempt.complete is None:
            return Verdict.LACKED, f"it has {join(attempt.kept)} and still lacks {join(attempt.lacks)}", None
        if ripe is not None and ripe > self.history.last:
            return Verdict.YOUNG, _young(clause, ripe), None
        wait = attempt.waits[-1] if attempt.waits else None
        if clause.gates and (wait is None or self._gated_since(rule, attempt, wait)):
            return Verdict.GATED, _gated(clause, self.rivals.waited(rule, attempt)), None
        if wait is None:
            return Verdict.WAITING, f"it has been ready since {seconds(attempt.complete)} and is next", None
        rivals = f"{self.rivals.names(rule, attempt, wait)}{latest(wait.until)}"
        return Verdict.WAITING, f"it has been ready since {seconds(wait.time)} and waits for {rivals}", None

    def _gated_since(self, rule: RuleView, attempt: Attempt, wait: Waits) -> bool:
        """Return whether a slot predicate became false after an attempt began to wait."""
        last = self.history.last
        shut = self._shut(rule, attempt, last)
        return shut is True or (shut is None and wait.until is not None and wait.until < last)

    def _ripe(self, clause: ClauseView, attempt: Attempt) -> float | None:
        """Return when all spikes of an attempt are old enough (seconds); None if the attempt never had all its spikes."""
        if attempt.complete is None:
            return None
        ripe = attempt.complete
        for constraint in clause.constraints:
            held = [h.spike for h in attempt.held if h.signal == constraint.signal]
            if held and held[-1] in self.history.born:
                ripe = max(ripe, self.history.born[held[-1]].time + constraint.min_age)
        return ripe

    def _shut(self, rule: RuleView, attempt: Attempt, time: float) -> bool | None:
        """Return whether a slot predicate of the clause was false at a time (seconds); None if that is unknown."""
        if self.opens is None:
            return None
        known = True
        for number, gate in enumerate(rule.clauses[attempt.clause].gates):
            written = self.history.value(gate.slot, time)
            opens = None if written is None else self.opens(rule.name, attempt.clause, number, written.value)
            if opens is False:
                return True
            known = known and opens is not None
        return False if known else None

    def _was_gated(self, rule: RuleView, attempt: Attempt, ripe: float | None, last: GaveUp) -> bool:
        """Return whether a slot predicate was false when an attempt lost its spikes.

        If the trace does not show the slot's value, the predicate counts as false in two cases: the attempt lost its
        spikes without an answer by another rule, or the attempt did not wait although its spikes were old enough.
        """
        if not rule.clauses[attempt.clause].gates:
            return False
        shut = self._shut(rule, attempt, last.time)
        if shut is not None:
            return shut
        return last.reason != LossReason.CONSUMED or (ripe is not None and ripe < last.time and not attempt.waits)

    def _lost(self, rule: RuleView, last: GaveUp, clause: ClauseView) -> str:
        """Return a phrase that says how an attempt lost its spikes."""
        at = seconds(last.time)
        if last.reason == LossReason.AGE:
            ages = [c.max_age for c in clause.constraints if c.signal == last.signal and c.max_age is not None]
            return f"{last.signal} reached its maximum age{f' of {ages[0]:g} s' if ages else ''} at {at}"
        if last.reason == LossReason.CONSUMED:
            return f"{self.rivals.answerer(rule, last)[1]} answered this cause at {at}"
        return f"{why_given_up(last)} at {at}"

    def _passed(self, rule: RuleView, signal: str = "") -> list[Passed]:
        """Return the records of the group's spikes that a rule did not take. With a `signal`, return only its records."""
        passed = [p for p in self.history.passed.get(rule.name, ()) if p.spike in self.history.group]
        return [p for p in passed if p.signal == signal] if signal else passed

    # ------------------------------------------------------------------------------------ missing signals

    def missing(self, rule: RuleView, attempt: Attempt | None) -> tuple[Missing, ...]:
        """Return the signals that a rule lacked in its furthest attempt, each with the reason why it was missing.

        Without an attempt, return the signals of all clauses of the rule.
        """
        if attempt is not None:
            names = dict.fromkeys(attempt.lacks)
        else:
            names = dict.fromkeys(c.signal for clause in rule.clauses for c in clause.constraints)
        self.asked.append(rule.name)
        found = tuple(self._missing(name, rule, attempt) for name in names)
        self.asked.pop()
        return found

    def _missing(self, name: str, rule: RuleView, attempt: Attempt | None) -> Missing:
        signal = self.description.signal(name)
        raisers = () if signal is None else tuple(self._raiser(raiser, name) for raiser in signal.raisers)
        outside = signal is not None and signal.input
        return Missing(name, f"{name} {self._absence(name, rule, attempt, outside, bool(raisers))}", raisers)

    def _absence(self, name: str, rule: RuleView, attempt: Attempt | None, outside: bool, raisers: bool) -> str:
        refused = self._passed(rule, name)
        if refused:
            return f"occurred at {seconds(refused[0].time)}, but {PassReason.say(refused[0].reason)}"
        here = min((born.time for born in self.history.raised(name)), default=None)
        if here is not None:
            late = attempt is not None and attempt.end is not None and here > attempt.end
            return (
                f"occurred at {seconds(here)}, {'after the rule gave up' if late else 'but the rule did not hold it'}"
            )
        elsewhere = [born.time for born in self.history.born.values() if born.signal == name]
        if elsewhere:
            near = min(elsewhere, key=lambda time: abs(time - self.history.spike.time))
            return f"did not occur for this cause (only for another cause, at {seconds(near)})"
        if outside:
            return "did not arrive as an input, and no rule raised it" if raisers else "is an input and did not arrive"
        return "did not occur" if raisers else "did not occur: no rule raises it"

    def _raiser(self, name: str, signal: str) -> Raiser:
        rule = self.description.rule(name)
        runs = [attempt for attempt in self.history.of(name) if attempt.started is not None]
        if runs:
            raising = self.history.raising
            run = next((run for run in runs if (run.id, signal) in raising), runs[-1])
            ended = run.settled
            if (run.id, signal) in raising:
                words = f"{name} raised it, at {seconds(raising[run.id, signal])}"
            elif ended is None:
                words = f"{name} is running and may still raise it"
            else:
                words = without(name, ended) + (f": {ended.reason}" if ended.reason else "")
            outcome, time = ("running", None) if ended is None else (ended.outcome, ended.time)
            return Raiser(name, outcome, time, words)
        if rule is None or name in self.asked or len(self.asked) > DEEPEST:
            return Raiser(name, "not run", None, f"{name} did not run")
        self.asked.append(name)
        verdict, words, at, attempt = self.judge(rule)
        if verdict in (Verdict.LACKED, Verdict.UNTOUCHED):  # also say why this rule lacked its own signals
            for lack in dict.fromkeys(attempt.lacks if attempt is not None else ()):
                lacked = self.description.signal(lack)
                for raiser in () if lacked is None else lacked.raisers:
                    if raiser not in self.asked:
                        words += f"; {self._raiser(raiser, lack).words}"
        self.asked.pop()
        return Raiser(name, "not run", at, f"{name} did not run: {words}")

    # ------------------------------------------------------------------------------------ the history

    def moments(self, rule: RuleView) -> Iterator[Moment]:
        """Yield the moments at which something happened to a rule in this group."""
        for passed in self._passed(rule):
            yield Moment(passed.time, words_of(passed))
        for attempt in self.history.of(rule.name):
            waited = ""
            for record in attempt.records:
                match record:
                    case Waits():
                        words = words_of(record, others=self.rivals.names(rule, attempt, record))
                        if words != waited:  # the engine may refuse an activation again for the same reason
                            yield Moment(record.time, words, record.for_)
                        waited = words
                    case GaveUp(by=by):
                        words = words_of(record, behind=self.history.before(record.run))
                        yield Moment(record.time, words, (by,) if by else ())
                    case _:
                        yield Moment(record.time, words_of(record))
        for pressed in self.history.pressed.get(rule.name, ()):
            if self.history.of(pressed.by):
                yield Moment(pressed.time, words_of(pressed), (pressed.by,))


def _young(clause: ClauseView, ripe: float) -> str:
    slow = max(clause.constraints, key=lambda constraint: constraint.min_age)
    return f"{slow.signal} must be {slow.min_age:g} s old, so the rule could not run before {seconds(ripe)}"


def _gated(clause: ClauseView, waited: str) -> str:
    shut = f"{join(gate.text for gate in clause.gates)} was false"
    return f"{waited}; then {shut}" if waited else f"it had all its spikes, but {shut}"


def _abridged(moments: list[Moment]) -> tuple[Moment, ...]:
    if len(moments) <= MOST:
        return tuple(moments)
    half = MOST // 2
    left = moments[half : 1 - half]
    words = f"{len(left)} more moments, until {seconds(left[-1].time)}, are left out"
    return (*moments[:half], Moment(left[0].time, words), *moments[1 - half :])
