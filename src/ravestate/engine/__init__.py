"""The automaton: events and times go in, effects come out.

The automaton is pure. It uses no clock, thread, lock or random number, and does not depend on hash order.

The code cites the laws of the automaton by number, such as L15. ``tests/laws`` has one file for each law, which states
and tests it. ``docs/explanation/processing-model.md`` explains the laws about spikes and runs.

A working `Engine` has `Parts` (``parts.py``): objects that share one `State`. Each part has a file of its own. An event
passes through the parts in this order:

1. *Receive.* `Engine.receive` finds the event's handler in the table `HANDLERS` (``parts.py``). A write goes to
   `Slots`, which raises the slot's signals.
2. *Match.* `Matching.birth` creates the spike and offers it to activations, which take it with `Holdings.acquire`. Then
   `Holdings.update` finds out whether the activation is ready. A simple clause needs no such check, because one spike
   makes it ready (`Clause.simple`). `Holdings.complete` queues the ready activation. `Halves`, `Benches` and
   `ConflictSets` create many activations only when they may run. So most possible activations are never created.
3. *Start.* `Engine.effects` runs the loop in `Parts.effects`, until a run must start or stop, or nothing is left to do.
   Activations that need no consent start first (`Agenda.start_free`). The caller performs the returned effects, reports
   the runs that have ended, and calls `Engine.effects` again.
4. *Consent.* When the activations of step 3 have started, `Agenda.consent_round` lets the other ready activations ask
   for consent. `Consent.ask` looks for rivals (better clauses that write the same slots), and a `Horizon` judges
   whether each rival may still become ready. With consent, `Runs.start` starts the run. Without consent, `Waits.begin`
   keeps the `Refusal`, the reasons for the wait. A `Roster` finds the rivals in a large group. If a better activation
   was refused just before, `Leaders` may refuse without examining every rival. `stalemate` finds activations that wait
   only for each other.
5. *End.* `Runs.finish` settles a run by the table `OUTCOMES` (``outcomes.py``).
6. *Wake.* A change that may lift a refusal marks a causal group in `State.dirty`, or a *hope* in `State.stirred`, or
   puts the refused activation into `State.asking`. A hope is something outside the activation's groups that may lift
   its refusal (``activation.py``). The next round of consent begins with `Waits.wake`, which returns the activations
   that ask again.

Deadlines go through the same steps. `Engine.advance` finds the deadlines that are due, and the table `DUE`
(``parts.py``) has a handler for each kind of deadline. When a rival's patience ends, the activation that waits for it
asks again, and `Consent` eliminates the rival.

To see why a rule waits, call `explain`: it names the rules that each activation waits for. The activation's `Refusal`
also has the activations (`blockers`), groups (`interests`) and hopes on which the wait depends.
"""

from ravestate.compiled import prefer

prefer(__path__)
