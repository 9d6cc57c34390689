"""The table of the outcomes of runs (laws L18, L20, L21).

The key of a row has two words: the engine's reason to cancel the run (empty without a cancellation), and the way in
which the run's function ended. A row has two outcomes: one for a run that wrote no slot, and one for a run that wrote a
slot. A run that *fired* consumes its spikes for the slots that it writes. After any other end, these slots are free,
and the next best rule may answer.
"""

from __future__ import annotations

from typing import Final, get_args

from ravestate.engine import events

DONE: Final = "done"
RESIGNED: Final = "resigned"
FAILED: Final = "failed"
RETIRED: Final = "retired"
KINDS = get_args(events.OutcomeKind)
INTERRUPTED, TIMEOUT, WIPED = "interrupted", "timeout", "wiped"

End = tuple[str, bool]
"""An outcome (`reasons.Outcome`), and whether the run has fired."""

OUTCOMES: dict[tuple[str, str], tuple[End, End]] = {
    # told, ended              no slot written         a slot written
    ("", DONE): ((DONE, True), (DONE, True)),
    ("", RESIGNED): ((RESIGNED, False), (FAILED, True)),  # to resign after a write is an error
    ("", FAILED): ((FAILED, False), (FAILED, True)),
    ("", RETIRED): ((RETIRED, True), (RETIRED, True)),
    (INTERRUPTED, DONE): ((INTERRUPTED, True), (INTERRUPTED, True)),
    (INTERRUPTED, RESIGNED): ((INTERRUPTED, True), (FAILED, True)),
    (INTERRUPTED, FAILED): ((FAILED, True), (FAILED, True)),
    (INTERRUPTED, RETIRED): ((RETIRED, True), (RETIRED, True)),
    (TIMEOUT, DONE): ((FAILED, False), (FAILED, True)),
    (TIMEOUT, RESIGNED): ((FAILED, False), (FAILED, True)),
    (TIMEOUT, FAILED): ((FAILED, False), (FAILED, True)),
    (TIMEOUT, RETIRED): ((FAILED, False), (FAILED, True)),
    # A run that is wiped before it writes a slot has answered nothing: other rules may answer the remaining spikes.
    (WIPED, DONE): ((WIPED, False), (WIPED, True)),
    (WIPED, RESIGNED): ((WIPED, False), (FAILED, True)),
    (WIPED, FAILED): ((FAILED, False), (FAILED, True)),
    (WIPED, RETIRED): ((RETIRED, False), (RETIRED, True)),
}


def verdict(told: str, ended: str, wrote: bool) -> End:
    """Return the outcome of a run, and whether it has fired."""
    return OUTCOMES[told, ended][wrote]
