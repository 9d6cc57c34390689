"""Why a rule did not fire for an input, derived from the trace (L25).

The question is asked of a causal group: of the spike that a user points at, and all that has the same cause. The answer
is how far the rule came, at best, and what it failed for there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Literal

from ravestate.board.description import ClauseView, Description, RuleView
from ravestate.board.history import Attempt, History
from ravestate.engine.explain import how_ended
from ravestate.engine.trace import Record, Settled

__all__ = ["Missing", "Moment", "Raiser", "Verdict", "WhyNot", "why_not"]

Verdict = Literal[
    "fired",  # it did
    "running",  # it does
    "waiting",  # it is ready, and kept waiting
    "outrun",  # it was ready, and another one answered
    "resigned",
    "failed",
    "gated",  # a predicate on a slot was false
    "young",  # its spikes were not old enough yet
    "eliminated",  # others waited for it until its patience ran out
    "withdrawn",  # the spike was wiped, superseded, or dropped
    "lacked",  # a signal was missing
    "passed",  # it hears the signal, but did not take the spike
    "untouched",  # nothing of what it hears occurred
    "retired",
]
"""How far a rule came."""

FURTHEST: dict[str, int] = {
    verdict: rank
    for rank, verdict in enumerate(
        (
            "fired", "running", "waiting", "outrun", "failed", "resigned", "gated", "young", "eliminated", "withdrawn",
            "lacked", "passed", "untouched", "retired",
        )
    )
}  # fmt: skip

DEEPEST = 3
"""Causes of causes that are told."""

Opens = Callable[[str, int, int, Any], bool | None]
"""Whether a gate is open for a value of its slot: the rule, its clause and the gate by their numbers, the value; None
where it cannot be told."""


@dataclass(frozen=True, slots=True)
class Raiser:
    """A rule that might have raised a missing signal, and how that ended in this causal group.

    Attributes:
        outcome: Of its run; ``running``; or ``not run``.
        words: The same in words.
    """

    rule: str
    outcome: str
    time: float | None
    words: str


@dataclass(frozen=True, slots=True)
class Missing:
    """A signal that the rule lacked, and who might have raised it."""

    signal: str
    words: str
    raisers: tuple[Raiser, ...]


@dataclass(frozen=True, slots=True)
class Moment:
    """Something that befell the rule, for this cause; `rules` are the others that it is about."""

    time: float
    words: str
    rules: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class WhyNot:
    """The answer.

    Attributes:
        rule, spike, signal, time: What was asked; the time is when the spike was born (seconds).
        verdict: How far the rule came, at best.
        words: The reason, in a sentence or two.
        at: When that was decided (seconds), if it is.
        clause: By which clause (its number), if it took a spike.
        missing: What it lacked, and who might have raised it.
        moments: What befell it, in order.
        whole: Whether the trace reaches back to before the spike; otherwise something may have gone unseen.
    """

    rule: str
    spike: int
    signal: str
    time: float
    verdict: Verdict
    words: str
    at: float | None
    clause: int | None
    missing: tuple[Missing, ...]
    moments: tuple[Moment, ...]
    whole: bool

    def __str__(self) -> str:
        lines = [f"{self.rule}, for {self.signal} at {self.time:.3f} s: {self.words}"]
        for missing in self.missing:
            lines.append(f"  {missing.words}")
            lines += [f"    {raiser.words}" for raiser in missing.raisers]
        lines += [f"  {moment.time:.3f} s: {moment.words}" for moment in self.moments]
        return "\n".join(lines)


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


class _Inquiry:
    def __init__(self, history: History, description: Description, opens: Opens | None) -> None:
        self.history = history
        self.description = description
        self.opens = opens
        self.asked: list[str] = []  # rules that are being explained: causes may be circular

    def answer(self, rule: RuleView, whole: bool) -> WhyNot:
        born = self.history.spike
        verdict, words, at, attempt = self.judge(rule)
        missing: tuple[Missing, ...] = ()
        if verdict in ("lacked", "eliminated", "untouched"):
            missing = self.missing(rule, attempt)
        moments = tuple(sorted(self.moments(rule), key=lambda moment: moment.time))
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

    def judge(self, rule: RuleView) -> tuple[Verdict, str, float | None, Attempt | None]:
        """How far a rule came in this group, and why no further."""
        best: tuple[Verdict, str, float | None, Attempt | None] | None = None
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
            reasons = {
                "payload": f"it did not take {first.signal}: its payload did not fit the predicate",
                "consumed": f"it did not take {first.signal}: {self._path(self._answered(rule, first.time), first.time)} had answered this cause already",
                "caused": f"it did not take {first.signal}: the rule itself was among its causes, and no rule is its own cause",
            }
            return "passed", reasons.get(first.reason, f"it did not take {first.signal}"), first.time, None
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
        if settled is not None and attempt.started is not None:
            return self._ran(rule, attempt, attempt.started.time, settled)
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
        by = last.by or self._answered(rule, end)
        if attempt.waits and not attempt.lacks:
            wait = attempt.waits[-1]
            return (
                "outrun",
                f"it was ready, and waited for {self._rivals(rule, attempt, wait.time)}; "
                f"{self._path(by, end)} answered at {_s(end)}",
                end,
            )
        if attempt.lacks:
            lacked = f"it took {_names(self._held(attempt))}, but lacked {_names(attempt.lacks)}"
            if last.reason == "eliminated":
                return "eliminated", f"{lacked}; {self._pressure(rule, end)}", end
            return "lacked", f"{lacked}{self._lost(attempt, clause, by)}", end
        if ripe is not None and end < ripe:
            return "young", f"{self._young(clause, attempt, ripe)}{self._lost(attempt, clause, by)}", end
        if (
            clause.gates
            and self._shut(rule, attempt, end) is not False
            and (
                last.reason != "consumed"
                or self._shut(rule, attempt, end)
                or (ripe is not None and ripe < end)
            )
        ):
            return "gated", f"{self._gated(clause, end)}{self._lost(attempt, clause, by)}", end
        if last.reason == "consumed":
            ahead = self._ahead(by, rule, attempt, end)
            return (
                "outrun",
                f"it was ready, but {self._path(by, end)}{ahead} was asked first, and answered at {_s(end)}",
                end,
            )
        return "lacked", f"it took {_names(self._held(attempt))}{self._lost(attempt, clause, by)}", end

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
        if attempt.waits:
            wait = attempt.waits[-1]
            until = "" if wait.until is None else f", until {_s(wait.until)} at the latest"
            return (
                "waiting",
                f"it is ready since {_s(wait.time)}, and waits for {self._rivals(rule, attempt, wait.time)}{until}",
                None,
            )
        if ripe is not None and ripe > self.history.last:
            return "young", self._young(clause, attempt, ripe), None
        if clause.gates:
            return "gated", self._gated(clause, self.history.last), None
        return "waiting", f"it is ready since {_s(attempt.complete)}, and will be asked next", None

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

    def _young(self, clause: ClauseView, attempt: Attempt, ripe: float) -> str:
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

    def _gated(self, clause: ClauseView, time: float) -> str:
        return f"it had all spikes, but {' and '.join(gate.text for gate in clause.gates)} was false"

    # ------------------------------------------------------------------------------------ the others

    def _rivals(self, rule: RuleView, attempt: Attempt, time: float) -> str:
        """For whom an attempt waited from a time on, and why."""
        wait = next(w for w in reversed(attempt.waits) if w.time <= time)
        parts: list[str] = []
        for name in wait.for_:
            running = next(
                (
                    a
                    for a in self.history.of(name)
                    if a.started and a.started.time <= wait.time and (a.end is None or a.end >= wait.time)
                ),
                None,
            )
            other = self.description.rule(name)
            common = [] if other is None else [slot for slot in rule.writes if slot in other.writes]
            if running is not None and name != rule.name:
                parts.append(f"{name}, which ran and had taken {_names(common) or 'the spike'}")
            elif name == rule.name:
                parts.append("another run of its own on the same spike")
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
        ran = [fired for fired in self.history.fired.get(rule.name, ()) if fired <= time]
        return min(1.0, (time - ran[-1]) / rule.cooldown) if rule.cooldown and ran else 1.0

    def _path(self, by: str, time: float) -> str:
        """Who answered, and on what account: behind the rule that raised what it heard, where there is one."""
        before = self.history.before(by, time)
        return by if before is None else f"{before} → {by}"

    def _answered(self, rule: RuleView, time: float) -> str:
        """Who had taken one of the rule's slots in this group by a time, if the trace tells."""
        found = ""
        for other in self.description.rules:
            if other.name == rule.name or not set(other.writes) & set(rule.writes):
                continue
            for attempt in self.history.of(other.name):
                if attempt.settled is not None and attempt.settled.fired and attempt.settled.time <= time:
                    found = other.name
        return found or "another rule"

    def _pressure(self, rule: RuleView, end: float) -> str:
        pressed = [p for p in self.history.pressed.get(rule.name, ()) if p.until <= end]
        if not pressed:
            return f"its patience ran out at {_s(end)}"
        last = pressed[-1]
        return f"{last.by} waited for it from {_s(last.time)} on, and its patience ran out at {_s(end)}"

    def _lost(self, attempt: Attempt, clause: ClauseView, by: str) -> str:
        """How it ended, as the end of a sentence."""
        last = attempt.gave_up[-1]
        if last.reason == "age":
            ages = [
                c.max_age for c in clause.constraints if c.signal == last.signal and c.max_age is not None
            ]
            most = f" of {ages[0]:g} s" if ages else ""
            return f"; {last.signal} reached its greatest age{most} at {_s(last.time)}"
        if last.reason == "consumed":
            return f"; {self._path(by, last.time)} answered this cause at {_s(last.time)}"
        if last.reason == "resigned":
            return f"; the rule resigned for it at {_s(last.time)}"
        return f"; {REASONS.get(last.reason, last.reason)} at {_s(last.time)}"

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
            return f"occurred at {_s(refused[0].time)}, but {PASSED[refused[0].reason]}"
        if here:
            late = attempt is not None and attempt.end is not None and here[0].time > attempt.end
            return f"occurred at {_s(here[0].time)}, {'after it had given up' if late else 'but was not held then'}"
        elsewhere = [born for born in self.history.born.values() if born.signal == name]
        if elsewhere:
            near = min(elsewhere, key=lambda born: abs(born.time - self.history.spike.time))
            return f"did not occur for this cause (for another one at {_s(near.time)})"
        if outside and not raisers:
            return "comes from outside, and did not come"
        return "did not occur" if raisers else "did not occur: no rule raises it"

    def _raiser(self, name: str, signal: str) -> Raiser:
        rule = self.description.rule(name)
        runs = [attempt for attempt in self.history.of(name) if attempt.started is not None]
        if runs:
            last = runs[-1]
            if last.settled is None:
                return Raiser(name, "running", None, f"{name} may still raise it: it runs")
            raised = any(
                born.source == last.id and born.signal == signal for born in self.history.born.values()
            )
            ended = last.settled
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
                yield Moment(passed.time, f"did not take {passed.signal}: {PASSED[passed.reason]}")
        for attempt in self.history.of(rule.name):
            for held in attempt.held:
                lacking = f", still lacking {_names(held.lacks)}" if held.lacks else ": it has all it needs"
                yield Moment(held.time, f"took {held.signal}{lacking}")
            last = ""
            for wait in attempt.waits:
                until = "" if wait.until is None else f", until {_s(wait.until)} at the latest"
                words = f"was ready, and waited for {self._rivals(rule, attempt, wait.time)}{until}"
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
                why = (
                    f"{self._path(lost.by, lost.time)} answered it"
                    if lost.reason == "consumed" and lost.by
                    else REASONS.get(lost.reason, lost.reason)
                )
                yield Moment(lost.time, f"gave {lost.signal} up: {why}", (lost.by,) if lost.by else ())
        for pressed in self.history.pressed.get(rule.name, ()):
            if any(a.id for a in self.history.of(pressed.by)):
                lacks = _names(pressed.lacks)
                yield Moment(
                    pressed.time,
                    f"{pressed.by} waits for it; lacking {lacks}, it has patience until {_s(pressed.until)}",
                    (pressed.by,),
                )


REASONS = {
    "age": "too old",
    "consumed": "another rule answered it",
    "resigned": "the rule resigned for it",
    "eliminated": "its patience ran out while others waited",
    "withdrawn": "it was withdrawn",
    "retired": "the rule retired",
}

PASSED = {
    "payload": "its payload did not fit the predicate",
    "consumed": "another rule had answered its cause",
    "caused": "the rule itself was among its causes",
}

DROPPED = {
    "overflow": "there were too many of it",
    "superseded": "a later one took its place",
    "wiped": "it was wiped",
}


def _s(time: float) -> str:
    return f"{time:.3f} s"


def _names(names: Iterable[str]) -> str:
    return _and(list(names))


def _and(parts: list[str]) -> str:
    return parts[0] if len(parts) == 1 else ", ".join(parts[:-1]) + (" and " + parts[-1] if parts else "")
