"""The asyncio shell around the engine, which itself has no loop, thread or clock.

Comments cite the laws of the automaton by number, such as law L18: see ``docs/explanation/processing-model.md``.
"""

from ravestate.compiled import prefer

prefer(__path__)
