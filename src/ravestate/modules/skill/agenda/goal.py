"""Declare goals. One rule of the designer's module pursues the goal; other rules of the module may end the goal."""

from __future__ import annotations

import inspect
import math
import re
import sys
from collections.abc import Awaitable, Callable, Iterable
from dataclasses import dataclass
from typing import Any, cast

import ravestate as rs
from ravestate.declare.condition import AllOf, AnyOf, Condition, Constraint, Holds
from ravestate.modules import rawio, verbaliser
from ravestate.modules.meta.verbaliser.intents import Intent

from .names import OPEN, GoalState, Status, goals, opportunity
from .wish import whole_words

Words = str | Iterable[str] | Callable[[rs.RuleContext], str | Awaitable[str]]

MOMENT = 1.0  # the seconds for which an opportunity to pursue a goal lasts
LONGEST = 1000  # `done` and `refused` search at most this number of characters of the user's words


@dataclass(frozen=True, slots=True)
class Goal:
    """A declared goal.

    Attributes:
        name: The name of the goal's rule, ``module:name``; `agenda.goals` has the goal's state under this name.
        rule: The rule that pursues the goal; the rule retires when the goal is over.
        pursued: A constraint for your own rules; its spikes mean that the goal has just been pursued. A rule with
            ``when=offer.pursued.max_age(60) & rawio.input.changed`` reacts to the user's answer to the goal `offer`.
    """

    name: str
    rule: rs.Rule[Any, Any]
    pursued: Constraint

    def state(self, agent: rs.Context | Any) -> GoalState:
        """Return the state of the goal in an agent: a context, or a simulation."""
        return agent.read(goals).get(self.name, OPEN)


def goal(
    module: rs.Module,
    name: str,
    *,
    say: Words | None = None,
    intent: str | Intent | None = None,
    reads: rs.Slot[Any] | Iterable[rs.Slot[Any]] = (),
    when: Condition | None = None,
    unless: Condition | None = None,
    priority: float = 1.0,
    cooldown: float = 60.0,
    done: Condition | str | None = None,
    refused: Condition | str | None = None,
    tries: int = 2,
) -> Goal:
    """Declare a goal of the agent.

    The agent *pursues* the goal: it says the goal's words when it is bored. It does not if it has just pursued a goal, or
    if the conversation has a topic. The goal is over when `done` or `refused` happens, or `cooldown` seconds after the
    last try. The user's words interrupt the pursuit.

    The goal is a rule, ``module:name``. So ``sim.explain("module:name")`` says why the goal was pursued or not.

    Args:
        module: The goal's module; it must require `agenda`.
        name: The goal's name within the module.
        say: The agent's words: a text; several texts, one for each try in turn (the last is repeated); or a function of the
            rule context that returns a text. The function may be async, and slow.
        intent: An intent of `verbaliser`, or its name, instead of `say`.
        reads: The slots that the function `say` reads.
        when: A further condition for a pursuit, e.g. ``interloc.users.holds(bool)``.
        unless: A condition that prevents a pursuit. It may contain only ``slot.holds(...)``.
        priority: The weight of the goal's rule, which multiplies its utility. The goal with the greatest utility goes
            first.
        cooldown: Seconds from one try to the next; also the seconds that the user has for an answer.
        done: The event that makes the goal a success: a signal or a condition, at any time; or a regular expression of
            whole words for the user's answer. If it is None, the first try makes the goal a success.
        refused: The event that makes the agent drop the goal, such as the user's "no". It has the same forms as `done`.
            If an answer fits both expressions, the goal is dropped.
        tries: The maximum number of tries; the goal is dropped `cooldown` seconds after the last one.

    Raises:
        rs.DeclarationError: `say` and `intent` are both given or both missing, `say` has no text, or a number is
            impossible. The error also means that an expression is invalid, or that `unless` contains a signal.

    Example:
        >>> import ravestate as rs
        >>> from ravestate.modules import agenda
        >>> game = rs.Module("game", requires=[agenda])
        >>> playing = game.flag("playing")
        >>> offer = agenda.goal(game, "offer", say="Shall we play a game?", unless=playing.holds(bool), done=playing.true)
        >>> offer.name
        'game:offer'
    """
    whole = f"{module.name}:{name}"
    _check(whole, say, intent, priority, cooldown, tries)
    texts = say if say is None or callable(say) else _texts(whole, say)
    frame = sys._getframe(1)  # pyright: ignore[reportPrivateUsage]  # messages name the line of the declaration
    origin = f"{frame.f_code.co_filename}:{frame.f_lineno}"
    known = len(module.rules)
    said: rs.Slot[Any] = rawio.output if intent is None else verbaliser.intent
    done_words, refused_words = _expression(whole, "done", done), _expression(whole, "refused", refused)

    def is_over(entry: Any) -> bool:
        return entry.key == whole and entry.item.is_over

    def is_pursued(entry: Any) -> bool:
        # Without `done`, the first try makes the goal a success; nothing else does.
        return entry.key == whole and entry.item.status == ("done" if done is None else "pursued")

    def was_the_last_try(entry: Any) -> bool:
        return is_pursued(entry) and entry.item.tries >= tries

    condition: Condition = opportunity.max_age(MOMENT)
    if when is not None:
        condition = condition & when
    if unless is not None:
        condition = condition & negated(unless)

    @module.rule(
        when=condition | goals.changed.where(is_over).detached(),
        reads=reads,
        writes=(rawio.output, goals) if intent is None else (verbaliser.intent, rawio.output, goals),
        weight=priority,  # no `cooldown=` here: it would only let other rules go first, but this rule must resign
        until=rawio.input.changed | goals.changed.where(is_over),  # the goal may be reached while `say()` runs
        detached=True,  # a new causal group begins, so that rules can react to the user's answer
        name=name,
    )
    async def pursue(ctx: rs.RuleContext) -> rs.Resign | rs.Retire | None:
        state = ctx[goals].get(whole, OPEN)
        if state.is_over:
            return rs.Retire(f"the goal is {state.status}")
        past = ctx.now - state.since
        if state.tries and (past < cooldown or state.tries >= tries):
            return rs.Resign(
                f"the goal was pursued {past:.0f} s ago, and rests for another {max(cooldown - past, 0):.0f} s"
            )
        words = await _worded(ctx, texts, state.tries) if intent is None else ""
        over = done is None
        ctx[said] = words if intent is None else intent  # if the slot refuses the words, this is no try
        ctx[goals].add(whole, GoalState("done" if over else "pursued", state.tries + 1, ctx.now))
        return rs.Retire("the goal's words were said") if over else None

    def end(ctx: rs.RuleContext, status: Status, *, by_words: bool) -> rs.Resign | None:
        state = ctx[goals].get(whole, OPEN)
        if state.is_over:
            return rs.Resign(f"the goal is already {state.status}")
        if by_words and not (state.status == "pursued" and ctx.now - state.since <= cooldown):
            return rs.Resign("the goal was not pursued lately, so the words do not answer it")
        ctx[goals].add(whole, GoalState(status, state.tries, state.since))
        return None

    def ends(how: str, by: Condition) -> Callable[[Callable[[rs.RuleContext], Any]], object]:
        return module.rule(when=by, writes=goals, detached=True, background=True, name=f"{name}_{how}")

    if done is not None:

        @ends("given_up", goals.changed.where(was_the_last_try).min_age(cooldown).max_age(None).detached())
        async def give_up(ctx: rs.RuleContext) -> rs.Resign | None:
            return end(ctx, "dropped", by_words=False)

        @ends("done", _condition(done, done_words, refused_words))
        async def finish(ctx: rs.RuleContext) -> rs.Resign | None:
            return end(ctx, "done", by_words=done_words is not None)

    if refused is not None:

        @ends("refused", _condition(refused, refused_words, None))
        async def drop(ctx: rs.RuleContext) -> rs.Resign | None:
            return end(ctx, "dropped", by_words=refused_words is not None)

    for rule in module.rules[known:]:
        rule.origin = origin
    return Goal(whole, pursue, goals.changed.where(is_pursued))


async def _worded(ctx: rs.RuleContext, say: Any, tries: int) -> str:
    """Return the words for the next try, after `tries` earlier tries."""
    if not callable(say):
        return say[min(tries, len(say) - 1)]
    words: Any = say(ctx)
    return await words if inspect.isawaitable(words) else words


def _condition(event: Condition | str, words: re.Pattern[str] | None, unless: re.Pattern[str] | None) -> Condition:
    """Return a condition that consumes nothing: `event`, or an input that fits `words` but not `unless`."""
    if words is None:
        assert not isinstance(event, str)  # if `event` is a text, `words` is its pattern
        return watching(event)

    def says_so(text: str) -> bool:
        text = text[:LONGEST]
        return bool(words.search(text)) and not (unless and unless.search(text))

    return rawio.input.changed.where(says_so).max_age(None).detached()


def _expression(goal: str, what: str, event: Condition | str | None) -> re.Pattern[str] | None:
    if event is None or isinstance(event, Condition):
        return None
    if not isinstance(event, str):  # pyright: ignore[reportUnnecessaryIsInstance]  # users may not check types
        hint = f": write {what}={event}.changed" if isinstance(event, rs.Slot) else ""
        raise rs.DeclarationError(f"goal {goal}: {what}={event!r} is neither a condition nor a text{hint}")
    try:
        return whole_words(event)
    except re.error as error:
        raise rs.DeclarationError(
            f"goal {goal}: {what}={event!r} is not a regular expression ({error}): write for example {what}='yes|sure'"
        ) from None


def _texts(goal: str, say: object) -> tuple[str, ...]:
    """Return the texts of a goal. Read them only once, because they may come from a generator."""
    texts = tuple(cast("Iterable[str]", (say,) if isinstance(say, str) or not isinstance(say, Iterable) else say))
    if not texts or not all(isinstance(text, str) and text for text in texts):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise rs.DeclarationError(
            f"goal {goal}: say={say!r}: write a text, several texts, or a function of the rule context"
        )
    return texts


def _check(goal: str, say: object, intent: object, priority: object, cooldown: object, tries: object) -> None:
    if (say is None) == (intent is None):
        raise rs.DeclarationError(
            f"goal {goal}: say={say!r} and intent={intent!r}: give exactly one of them, such as say='Shall we play?'"
        )
    for what, number in (("priority", priority), ("cooldown", cooldown)):
        if isinstance(number, bool) or not isinstance(number, (int, float)) or not 0 < number < math.inf:
            raise rs.DeclarationError(
                f"goal {goal}: {what}={number!r} must be a finite number above 0: write {what}=1.0"
            )
    if isinstance(tries, bool) or not isinstance(tries, int) or tries < 1:
        raise rs.DeclarationError(f"goal {goal}: tries={tries!r} must be a whole number of at least 1")


def watching(condition: Condition) -> Condition:
    """Return the condition with all its constraints detached, so that it consumes nothing."""
    match condition:
        case rs.Signal():
            return condition.max_age(None).detached()
        case Constraint():
            return condition.detached()
        case AllOf(parts):
            return AllOf(tuple(map(watching, parts)))
        case AnyOf(parts):
            return AnyOf(tuple(map(watching, parts)))
        case _:
            return condition


def negated(condition: Condition) -> Condition:
    """Return the negation of a condition that consists of ``slot.holds(...)`` alone.

    Raises:
        rs.DeclarationError: The condition contains a signal, which cannot be negated.
    """
    match condition:
        case Holds(slot, predicate):

            def otherwise(value: Any) -> bool:
                return not predicate(value)

            otherwise.__name__ = f"not_{getattr(predicate, '__name__', 'so')}"
            return slot.holds(otherwise)
        case AllOf(parts):
            return AnyOf(tuple(map(negated, parts)))
        case AnyOf(parts):
            return AllOf(tuple(map(negated, parts)))
        case _:
            raise rs.DeclarationError(
                f"unless={condition} contains a signal: write unless=slot.holds(predicate), with a slot that a rule on "
                "the signal writes"
            )
