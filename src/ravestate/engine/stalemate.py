"""Stalemates (L16): activations that wait for nothing but each other."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from ravestate.engine.activation import Activation
from ravestate.engine.consent import Consent


def stalemate(consent: Consent, refused: Iterable[Activation], known: Collection[Activation] = ()) -> set[Activation]:
    """Return activations that wait for nothing but each other.

    Two ready rules may each wait for a rival that the other might bring about. They would wait for ever, so the one
    with the greater effective utility goes first, or else the one declared first.

    Args:
        consent: The part of the engine that asks for consent.
        refused: The activations that were refused since the last search: at least one is in any new stalemate.
        known: The activations that earlier searches found.
    """
    waiting = consent.state.waiting.keys()
    seen: set[Activation] = set()
    reached = list(refused)
    while True:
        while reached:
            one = reached.pop()
            if one in seen or not _hangs(one):
                continue
            if any([waiting.isdisjoint(roots) for roots in _firm(one)]):
                continue  # it waits for work that waits for nothing
            seen.add(one)
            for roots in _firm(one):
                reached += roots
        if not seen:
            return seen
        stuck: set[Activation] = seen.copy()
        freed: set[Activation] | None = None
        while freed is None or freed:
            freed = {one for one in stuck if any([stuck.isdisjoint(roots) for roots in _firm(one)])}
            stuck -= freed
        while stuck:
            without = stuck.union(known)
            answers = [(one, consent.ask(one, without, commit=False)) for one in stuck]
            moved = [(one, refusal) for one, refusal in answers if refusal]
            if not moved:
                break
            stuck -= {one for one, _ in moved}
            for _, refusal in moved:  # it waits for others as well, and these may wait for it
                reached += [root for roots in refusal.firm for root in roots if root not in seen]
        if not any([_hangs(root) for root in reached]):
            return stuck


def _firm(activation: Activation) -> list[tuple[Activation, ...]]:
    """Return for each rival that an activation surely waits for the activations at work."""
    return [] if activation.refusal is None else activation.refusal.firm


def _hangs(activation: Activation) -> bool:
    """Return whether an activation waits for work in progress alone, so that it might wait for ever."""
    refusal = activation.refusal
    return refusal is not None and bool(refusal.firm) and not refusal.bounded
