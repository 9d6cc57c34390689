"""Why a rule did not fire for an input, derived from the trace (L25).

The question is asked of a causal group: of the spike that a user points at, and all that has the same cause. The answer
is how far the rule came, at best, and what it failed for there.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from ravestate.board.answer import FURTHEST, Missing, Moment, Raiser, Verdict, WhyNot
from ravestate.board.description import ClauseView, Description, RuleView
from ravestate.board.history import Attempt, History
from ravestate.engine.explain import PASSED, how_ended, why_given_up
from ravestate.engine.trace import GaveUp, Passed, Record, Settled, Waits

__all__ = ["Opens", "why_not"]

DEEPEST = 3
"""Causes of causes that are told."""

MOST = 200
"""Moments that are told; of more, the first and the last."""

Opens = Callable[[str, int, int, Any], bool | None]
"""Whether a gate is open for a value of its slot: the rule, its clause and the gate by their numbers, the value; None
where it cannot be told."""


def why_not(
    records: Iterable[Record],
    description: Description,
    rule: str,
    spike: int,
    opens: Opens | None = None,
    whole: bool = True,
) -> WhyNot:
    """Why a rule did not fire for the cause of a spike (or that it did).

    Args:
        records: The trace.
        description: The policy.
        rule: The rule's name.
        spike: The number of a spike in the trace, such as one of an input.
        opens: Tells of a live policy whether a gate is open for a value of its slot.
        whole: Whether the trace has all that happened since the context began.

    Raises:
        LookupError: There is no such rule, or no such spike in the trace.

    Example:
        >>> import ravestate as rs
        >>> from ravestate.board.description import describe
        >>> from ravestate.testing import simulate
        >>> door = rs.Module("door")
        >>> bell, key = door.signal("bell"), door.signal("key")
        >>> @door.rule(when=bell & key)
        ... async def unlock(ctx): ...
        >>> with simulate(door) as sim:
        ...     sim.emit(bell)
        ...     sim.advance(6)
        ...     spike = next(record.spike for record in sim.trace if getattr(record, "signal", "") == "door:bell")
        ...     why_not(sim.trace, describe(sim.context.policy), "door:unlock", spike).verdict
        'lacked'
    """
    view = description.rule(rule)
    if view is None:
        raise LookupError(f"there is no rule {rule!r}")
    history = History(records, spike)
    return _Inquiry(history, description, opens).answer(view, whole or history.first < history.spike.time)


Judgement = tuple[Verdict, str, float | None, Attempt | None]
"""How far a rule came, in words too, when that was decided, and with which attempt."""


class _Inquiry:
    def __init__(self, history: History, description: Description, opens: Opens | None) -> None:
        self.history = history
        self.description = description
        self.opens = opens
        self.asked: list[str] = []  # rules that are being explained: causes may be circular
        self._judged: dict[str, Judgement] = {}
        self._first: dict[str, Attempt | None] = {}  # by the rule whose slots were taken

    def answer(self, rule: RuleView, whole: bool) -> WhyNot:
        born = self.history.spike
        verdict, words, at, attempt = self.judge(rule)
        missing: tuple[Missing, ...] = ()
        if verdict in ("lacked", "eliminated", "untouched"):
            missing = self.missing(rule, attempt)
        moments = _abridged(sorted(self.moments(rule), key=lambda moment: moment.time))
        clause = None if attempt is None else attempt.clause
        return WhyNot(
            rule.name,
            born.spike,
            born.signal,
            born.time,
            verdict,
            words,
            at,
            clause,
            missing,
            moments,
            whole,
        )

    # ------------------------------------------------------------------------------------ the verdict

    def judge(self, rule: RuleView) -> Judgement:
        """How far a rule came in this group, and why no further."""
        if rule.name not in self._judged:
            self._judged[rule.name] = self._furthest(rule)
        return self._judged[rule.name]

    def _furthest(self, rule: RuleView) -> Judgement:
        best: Judgement | None = None
        for attempt in self.history.of(rule.name):
            verdict, words, at = self._judge(rule, attempt)
            if best is None or FURTHEST[verdict] < FURTHEST[best[0]]:
                best = (verdict, words, at, attempt)
        if best is not None:
            return best
        retired = self.history.retired.get(rule.name)
        if retired is not None and retired <= self.history.spike.time:
            return "retired", f"it had retired at {_s(retired)}, before that", retired, None
        passed = [p for p in self.history.passed.get(rule.name, ()) if p.spike in self.history.group]
        if passed:
            first = passed[0]
            reason = PASSED.get(first.reason, first.reason)
            if first.reason == "consumed":
                reason = f"{self._path(*self._answerer(rule, first))} had answered this cause already"
            elif first.reason == "caused":
                reason += ", and no rule is its own cause"
            return "passed", f"it did not take {first.signal}: {reason}", first.time, None
        if retired is not None:
            return (
                "retired",
                f"it retired at {_s(retired)}, before it took anything of this cause",
                retired,
                None,
            )
        return "untouched", "none of the signals that it hears occurred for this cause", None, None

    def _judge(self, rule: RuleView, attempt: Attempt) -> tuple[Verdict, str, float | None]:
        settled = attempt.settled
        if settled is not None:  # a gap may have swallowed its beginning
            began = settled.time if attempt.started is None else attempt.started.time
            return self._ran(rule, attempt, began, settled)
        if attempt.started is not None:
            return "running", f"it runs since {_s(attempt.started.time)}", attempt.started.time
        clause = rule.clauses[attempt.clause]
        ripe = self._ripe(clause, attempt)
        if not attempt.over:
            return self._pending(clause, attempt, ripe)
        end = attempt.end or 0.0
        last = attempt.gave_up[-1]
        if last.reason == "withdrawn":
            dropped = self.history.dropped.get(last.spike)
            why = f": {DROPPED.get(dropped.reason, dropped.reason)}" if dropped is not None else ""
            return "withdrawn", f"{last.signal} was withdrawn at {_s(end)}{why}", end
        if last.reason == "retired":
            return "retired", f"it retired at {_s(end)}, while it held {_names(self._held(attempt))}", end
        lost = self._lost(rule, last, clause)
        if attempt.lacks:
            lacked = f"it took {_names(self._held(attempt))}, but lacked {_names(attempt.lacks)}"
            if last.reason == "eliminated":
                return "eliminated", f"{lacked}; {self._pressure(rule, end)}", end
            return "lacked", f"{lacked}{lost}", end
        waited = self._waited(rule, attempt)
        if ripe is not None and end < ripe:
            return "young", f"{waited and f'{waited}; '}{self._young(clause, ripe)}{lost}", end
        if self._was_gated(rule, attempt, ripe, last):
            return "gated", f"{self._gated(clause, waited)}{lost}", end
        if last.reason != "consumed":
            return "lacked", f"{waited or f'it took {_names(self._held(attempt))}'}{lost}", end
        by, run = self._answerer(rule, last)
        if waited:
            return "outrun", f"{waited}; {self._path(by, run)} answered at {_s(end)}", end
        first = f"{self._path(by, run)}{self._ahead(by, rule, attempt, end)} was asked first"
        return "outrun", f"it was ready, but {first}, and answered at {_s(end)}", end

    def _ran(
        self, rule: RuleView, attempt: Attempt, began: float, settled: Settled
    ) -> tuple[Verdict, str, float | None]:
        reason = f": {settled.reason}" if settled.reason else ""
        if settled.outcome == "failed":
            after = " after it had written" if settled.fired else ""
            return (
                (
                    "fired",
                    f"it did fire, at {_s(began)}, and failed{after} at {_s(settled.time)}{reason}",
                    settled.time,
                )
                if settled.fired
                else ("failed", f"it ran at {_s(began)} and failed{reason}", settled.time)
            )
        if not settled.fired:
            return (
                "resigned",
                f"it ran at {_s(began)} and resigned{reason or ' without a reason'}",
                settled.time,
            )
        how = {
            "interrupted": ", and was interrupted",
            "wiped": ", and was ended as its spike was wiped",
            "retired": ", and retired",
        }
        what = [write.slot for write in self.history.writes.get(attempt.id, ())]
        wrote = f"; it wrote {_names(dict.fromkeys(what))}" if what else ""
        return "fired", f"it did fire, at {_s(began)}{how.get(settled.outcome, '')}{wrote}", settled.time

    def _pending(
        self, clause: ClauseView, attempt: Attempt, ripe: float | None
    ) -> tuple[Verdict, str, float | None]:
        """It still holds something."""
        rule = self.description.rule(attempt.rule)
        assert rule is not None  # it is asked about
        if attempt.lacks or attempt.complete is None:
            lacks = _names(attempt.lacks)
            return "lacked", f"it has {_names(self._held(attempt))}, and still lacks {lacks}", None
        if ripe is not None and ripe > self.history.last:
            return "young", self._young(clause, ripe), None
        wait = attempt.waits[-1] if attempt.waits else None
        if clause.gates and (wait is None or self._stands_still(rule, attempt, wait)):
            return "gated", self._gated(clause, self._waited(rule, attempt)), None
        if wait is None:
            return "waiting", f"it is ready since {_s(attempt.complete)}, and will be asked next", None
        whom = f"{self._rivals(rule, attempt, wait)}{_until(wait)}"
        return "waiting", f"it is ready since {_s(wait.time)}, and waits for {whom}", None

    def _stands_still(self, rule: RuleView, attempt: Attempt, wait: Waits) -> bool:
        """Whether one that waited waits no longer, and is not ready either: a gate was shut meanwhile."""
        last = self.history.last
        shut = self._shut(rule, attempt, last)
        return shut is True or (shut is None and wait.until is not None and wait.until < last)

    def _ripe(self, clause: ClauseView, attempt: Attempt) -> float | None:
        """When all its spikes are old enough (seconds); None if it never had all."""
        if attempt.complete is None:
            return None
        ripe = attempt.complete
        for constraint in clause.constraints:
            held = [h.spike for h in attempt.held if h.signal == constraint.signal]
            if held and held[-1] in self.history.born:
                ripe = max(ripe, self.history.born[held[-1]].time + constraint.min_age)
        return ripe

    def _young(self, clause: ClauseView, ripe: float) -> str:
        slow = max(clause.constraints, key=lambda constraint: constraint.min_age)
        return f"{slow.signal} has to be {slow.min_age:g} s old, which it would have been at {_s(ripe)}"

    def _shut(self, rule: RuleView, attempt: Attempt, time: float) -> bool | None:
        """Whether a gate was shut at a time, as far as can be told."""
        if self.opens is None:
            return None
        known = True
        for number, gate in enumerate(rule.clauses[attempt.clause].gates):
            written = self.history.value(gate.slot, time)
            told = None if written is None else self.opens(rule.name, attempt.clause, number, written.value)
            if told is False:
                return True
            known = known and told is not None
        return False if known else None

    def _was_gated(self, rule: RuleView, attempt: Attempt, ripe: float | None, last: GaveUp) -> bool:
        """Whether a gate was shut when an attempt lost what it had: as far as its slot tells, or else by its not having
        been asked."""
        if not rule.clauses[attempt.clause].gates:
            return False
        shut = self._shut(rule, attempt, last.time)
        if shut is not None:
            return shut
        return last.reason != "consumed" or (ripe is not None and ripe < last.time and not attempt.waits)

    def _gated(self, clause: ClauseView, waited: str) -> str:
        shut = f"{' and '.join(gate.text for gate in clause.gates)} was false"
        return f"{waited}; then {shut}" if waited else f"it had all spikes, but {shut}"

    # ------------------------------------------------------------------------------------ the others

    def _waited(self, rule: RuleView, attempt: Attempt) -> str:
        """That it was ready, and for whom it waited; empty if it did not wait."""
        if not attempt.waits:
            return ""
        return f"it was ready, and waited for {self._rivals(rule, attempt, attempt.waits[-1])}"

    def _rivals(self, rule: RuleView, attempt: Attempt, wait: Waits) -> str:
        """For whom an attempt waited, and why."""
        parts: list[str] = []
        for name in wait.for_:
            if name == rule.name:
                parts.append("another run of its own on the same spike")
            elif self.history.ran(name, wait.time):
                other = self.description.rule(name)
                common = [] if other is None else [slot for slot in rule.writes if slot in other.writes]
                parts.append(f"{name}, which ran and had taken {_names(common) or 'the spike'}")
            else:
                parts.append(f"{name}{self._ahead(name, rule, attempt, wait.time)}")
        return _and(parts)

    def _ahead(self, name: str, rule: RuleView, attempt: Attempt, time: float) -> str:
        """By how much another rule is ahead, in words."""
        other = self.description.rule(name)
        if other is None or name == rule.name:
            return ""
        theirs = max((clause.base for clause in other.clauses), default=0.0) * self._recovered(other, time)
        nats = theirs - rule.clauses[attempt.clause].base * self._recovered(rule, time)
        if nats > 1e-8:
            return f" ({nats:.3f} nats ahead)"
        return " (worth as much, and declared before it)" if abs(nats) <= 1e-8 else ""

    def _recovered(self, rule: RuleView, time: float) -> float:
        """The share of its utility that a rule has recovered since it ran last (L9)."""
        fired = self.history.fired.get(rule.name, [])
        times = bisect_right(fired, time)
        return min(1.0, (time - fired[times - 1]) / rule.cooldown) if rule.cooldown and times else 1.0

    def _path(self, by: str, run: int) -> str:
        """Who answered, and on what account: behind the rule that raised what it heard, where there is one."""
        before = self.history.before(run)
        return f"{before} → {by}" if before else by

    def _answerer(self, rule: RuleView, lost: GaveUp | Passed) -> tuple[str, int]:
        """Who answered what an attempt lost, or never took: the rule, and the number of its run (0: not known)."""
        return (lost.by, lost.run) if lost.by else self._answered(rule, lost.time)

    def _answered(self, rule: RuleView, time: float) -> tuple[str, int]:
        """Who had taken one of the rule's slots in this group by a time, if the trace tells."""
        if rule.name not in self._first:
            slots = set(rule.writes)
            self._first[rule.name] = self.history.answered(
                {
                    other.name: [
                        {c.signal for c in clause.constraints if not c.detached} for clause in other.clauses
                    ]
                    for other in self.description.rules
                    if other.name != rule.name and slots & set(other.writes)
                }
            )
        first = self._first[rule.name]
        if first is None or first.end is None or first.end > time:
            return "another rule", 0
        return first.rule, first.id

    def _pressure(self, rule: RuleView, end: float) -> str:
        pressed = self.history.pressed.get(rule.name, [])
        times = bisect_right(pressed, end, key=lambda one: one.until)  # its patience is always the same
        if not times:
            return f"its patience ran out at {_s(end)}"
        last = pressed[times - 1]
        return f"{last.by} waited for it from {_s(last.time)} on, and its patience ran out at {_s(end)}"

    def _lost(self, rule: RuleView, last: GaveUp, clause: ClauseView) -> str:
        """How it ended, as the end of a sentence."""
        if last.reason == "age":
            ages = [
                c.max_age for c in clause.constraints if c.signal == last.signal and c.max_age is not None
            ]
            most = f" of {ages[0]:g} s" if ages else ""
            return f"; {last.signal} reached its greatest age{most} at {_s(last.time)}"
        if last.reason == "consumed":
            return f"; {self._path(*self._answerer(rule, last))} answered this cause at {_s(last.time)}"
        return f"; {why_given_up(last)} at {_s(last.time)}"

    def _held(self, attempt: Attempt) -> list[str]:
        return list(dict.fromkeys(held.signal for held in attempt.held))

    # ------------------------------------------------------------------------------------ what is missing

    def missing(self, rule: RuleView, attempt: Attempt | None) -> tuple[Missing, ...]:
        """The signals that a rule lacked: of the clause that it tried, or else of all of them."""
        if attempt is not None:
            names = list(dict.fromkeys(attempt.lacks))
        else:
            names = list(dict.fromkeys(c.signal for clause in rule.clauses for c in clause.constraints))
        self.asked.append(rule.name)
        found = tuple(self._missing(name, rule, attempt) for name in names)
        self.asked.pop()
        return found

    def _missing(self, name: str, rule: RuleView, attempt: Attempt | None) -> Missing:
        signal = next((s for s in self.description.signals if s.name == name), None)
        raisers = () if signal is None else tuple(self._raiser(raiser, name) for raiser in signal.raisers)
        outside = signal is not None and signal.input
        return Missing(name, f"{name} {self._absence(name, rule, attempt, outside, bool(raisers))}", raisers)

    def _absence(
        self, name: str, rule: RuleView, attempt: Attempt | None, outside: bool, raisers: bool
    ) -> str:
        here = sorted(self.history.raised(name), key=lambda born: born.time)
        refused = [
            p
            for p in self.history.passed.get(rule.name, ())
            if p.signal == name and p.spike in self.history.group
        ]
        if refused:
            why = PASSED.get(refused[0].reason, refused[0].reason)
            return f"occurred at {_s(refused[0].time)}, but {why}"
        if here:
            late = attempt is not None and attempt.end is not None and here[0].time > attempt.end
            return f"occurred at {_s(here[0].time)}, {'after it had given up' if late else 'but was not held then'}"
        elsewhere = [born for born in self.history.born.values() if born.signal == name]
        if elsewhere:
            near = min(elsewhere, key=lambda born: abs(born.time - self.history.spike.time))
            return f"did not occur for this cause (for another one at {_s(near.time)})"
        if outside and not raisers:
            return "comes from outside, and did not come"
        if outside:
            return "did not come from outside, and no rule raised it"
        return "did not occur" if raisers else "did not occur: no rule raises it"

    def _raiser(self, name: str, signal: str) -> Raiser:
        rule = self.description.rule(name)
        runs = [attempt for attempt in self.history.of(name) if attempt.started is not None]
        if runs:
            last = runs[-1]
            if last.settled is None:
                return Raiser(name, "running", None, f"{name} may still raise it: it runs")
            ended = last.settled
            raised = (last.id, signal) in self.history.raising
            what = "raised it" if raised else f"{how_ended(last.settled)} without raising it"
            why = f": {ended.reason}" if ended.reason else ""
            return Raiser(name, ended.outcome, ended.time, f"{name} {what}, at {_s(ended.time)}{why}")
        if rule is None or name in self.asked or len(self.asked) > DEEPEST:
            return Raiser(name, "not run", None, f"{name} did not run")
        self.asked.append(name)
        verdict, words, at, attempt = self.judge(rule)
        if verdict in ("lacked", "untouched"):  # one step further back
            lacks = attempt.lacks if attempt is not None else ()
            for lack in dict.fromkeys(lacks):
                for raiser in next((s.raisers for s in self.description.signals if s.name == lack), ()):
                    if raiser not in self.asked:
                        words += f"; {self._raiser(raiser, lack).words}"
        self.asked.pop()
        return Raiser(name, "not run", at, f"{name} did not run: {words}")

    # ------------------------------------------------------------------------------------ the story

    def moments(self, rule: RuleView) -> Iterator[Moment]:
        """What befell the rule in this group."""
        for passed in self.history.passed.get(rule.name, ()):
            if passed.spike in self.history.group:
                why = PASSED.get(passed.reason, passed.reason)
                yield Moment(passed.time, f"did not take {passed.signal}: {why}")
        for attempt in self.history.of(rule.name):
            for held in attempt.held:
                lacking = f", still lacking {_names(held.lacks)}" if held.lacks else ": it has all it needs"
                yield Moment(held.time, f"took {held.signal}{lacking}")
            last = ""
            for wait in attempt.waits:
                words = f"was ready, and waited for {self._rivals(rule, attempt, wait)}{_until(wait)}"
                if words != last:  # it may be asked again, and still wait for the same
                    yield Moment(wait.time, words, wait.for_)
                last = words
            if attempt.started is not None:
                yield Moment(attempt.started.time, "ran")
            if attempt.told is not None:
                yield Moment(attempt.told.time, f"was told to end: {attempt.told.reason}")
            if attempt.settled is not None:
                reason = f": {attempt.settled.reason}" if attempt.settled.reason else ""
                yield Moment(attempt.settled.time, f"{how_ended(attempt.settled)}{reason}")
            for lost in attempt.gave_up:
                why = why_given_up(lost, self.history.before(lost.run))
                yield Moment(lost.time, f"gave {lost.signal} up: {why}", (lost.by,) if lost.by else ())
        for pressed in self.history.pressed.get(rule.name, ()):
            if any(a.id for a in self.history.of(pressed.by)):
                lacks = _names(pressed.lacks)
                yield Moment(
                    pressed.time,
                    f"{pressed.by} waits for it; lacking {lacks}, it has patience until {_s(pressed.until)}",
                    (pressed.by,),
                )


DROPPED = {
    "overflow": "there were too many of it",
    "superseded": "a later one took its place",
    "wiped": "it was wiped",
}


def _abridged(moments: list[Moment]) -> tuple[Moment, ...]:
    if len(moments) <= MOST:
        return tuple(moments)
    half = MOST // 2
    left = moments[half : 1 - half]
    told = Moment(
        left[0].time, f"and {len(left)} moments more, until {_s(left[-1].time)}, that are left out here"
    )
    return (*moments[:half], told, *moments[1 - half :])


def _until(wait: Waits) -> str:
    return "" if wait.until is None else f", until {_s(wait.until)} at the latest"


def _s(time: float) -> str:
    return f"{time:.3f} s"


def _names(names: Iterable[str]) -> str:
    return _and(list(names))


def _and(parts: list[str]) -> str:
    return parts[0] if len(parts) == 1 else ", ".join(parts[:-1]) + (" and " + parts[-1] if parts else "")
