"""The automaton: events and times in, effects out. Pure: no clock, thread, lock, random number or hash order.

The path of an event: ``engine.py`` receives it; ``slots.py`` changes values; ``matching.py`` offers the new spikes;
``halves.py`` keeps first spikes; ``holdings.py`` makes activations ready; ``agenda.py`` starts them, with consent
(``consent.py``, ``horizon.py``).
"""

from ravestate.compiled import prefer

prefer(__path__)
