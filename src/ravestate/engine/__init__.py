"""The automaton: events and times in, effects out. Pure: no clock, thread, lock, random number or hash order.

An event takes one way through the parts of an `Engine`, which share one `State`:

1. *Receive.* `Engine.receive` gets the event and calls its handler. A write goes to `Slots`, which raises the signals.
2. *Match.* `Matching.birth` creates the spike and offers it to activations: `Holdings.acquire`, then `Holdings.update`.
   `Halves`, `Benches` and `ConflictSets` save activations that would change nothing. `Holdings.complete` queues a ready one.
3. *Consent.* `Engine.effects` lets the `Agenda` choose. `Consent.ask` looks for rivals, and a `Horizon` judges whether
   each may still come. With consent, `Runs.start` orders the run. Without it, `Waits.begin` keeps the `Refusal`.
   A `Roster` finds the rivals in a large group, and `Leaders` save questions whose answer is known.
4. *Effects.* `Runs.finish` settles a run by the table `OUTCOMES`. `Waits.wake` returns the activations that ask again.

Time takes the same way from `Engine.advance`, which has a handler for each kind of deadline (`DUE`). When a patience ends,
the waiting activation asks again, and `Consent` eliminates the rival.

To see why a rule waits, read the `Refusal` of its activation; `explain` puts it into words.
"""

from ravestate.compiled import prefer

prefer(__path__)
