"""Stalemates (law L16): activations that wait only for each other."""

from __future__ import annotations

from collections.abc import Iterable

from ravestate.engine.activation import Activation, by_age
from ravestate.engine.consent import Consent
from ravestate.engine.stuck import Stuck


def stalemate(consent: Consent, refused: Iterable[Activation], known: Stuck | None = None) -> set[Activation]:
    """Return activations that wait only for each other.

    Suppose that two rules are ready, and each waits for a rival. Each rival lacks a signal that only the other ready
    rule may cause, so both rules would wait forever. The engine starts the rule with the greater effective utility. If
    both utilities are equal, it starts the rule declared first.

    Args:
        consent: The part of the engine that asks for consent.
        refused: The activations with which the search begins (`State.refused`). Each new stalemate has at least one of
            these.
        known: The activations that earlier searches found. They count as doing nothing.
    """
    waiting = consent.state.waiting.keys()
    seen: set[Activation] = set()
    reached = list(refused)
    while True:
        while reached:
            one = reached.pop()
            if one in seen or not _hangs(one):
                continue
            if any([waiting.isdisjoint(roots) for roots in _sure(one)]):
                continue  # at least one rival depends on no waiting activation, so this wait will end
            seen.add(one)
            for roots in _sure(one):
                reached += roots
        if not seen:
            return seen
        stuck: set[Activation] = seen.copy()
        freed: set[Activation] | None = None
        while freed is None or freed:
            freed = {one for one in stuck if any([stuck.isdisjoint(roots) for roots in _sure(one)])}
            stuck -= freed
        while stuck:
            new = Stuck(one for one in sorted(stuck, key=by_age) if known is None or one not in known)
            others = (new,) if known is None else (new, known)
            answers = [(one, consent.ask(one, others, commit=False)) for one in sorted(stuck, key=by_age)]
            moved = [(one, refusal) for one, refusal in answers if refusal]
            if not moved:
                break
            stuck -= {one for one, _ in moved}
            for (
                _,
                refusal,
            ) in moved:  # refused even if the stuck activations do nothing: it waits for others, which may wait for it
                reached += [root for roots in refusal.sure for root in roots if root not in seen]
        if not any([_hangs(root) for root in reached]):
            return stuck


def no_longer_stuck(one: Activation, stuck: Stuck) -> list[Activation]:
    """Return the members of a stalemate that by now wait for an activation outside the stalemate, oldest first.

    The search covers only `one` and the members for which it waits, directly or through others.
    """
    seen: set[Activation] = set()
    reached = [one]
    while reached:
        each = reached.pop()
        if each in stuck and each not in seen:
            seen.add(each)
            for roots in _sure(each):
                reached += roots
    left, freed = seen.copy(), seen
    while freed:
        freed = {each for each in left if any([left.isdisjoint(roots) for roots in _sure(each)])}
        left -= freed
    return sorted(seen - left, key=by_age)


def _sure(activation: Activation) -> list[tuple[Activation, ...]]:
    """Return an activation's `Refusal.sure`: for each rival, the activations that will make it ready or rule it out."""
    return [] if activation.refusal is None else activation.refusal.sure


def _hangs(activation: Activation) -> bool:
    """Return whether only the progress of other activations can end an activation's wait: the wait might never end."""
    refusal = activation.refusal
    return refusal is not None and bool(refusal.sure) and not refusal.bounded
