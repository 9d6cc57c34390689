"""The analysis of modules before they run: compile, pathways, utility, conflicts, findings, diagram.

This package uses no third-party code. Comments cite the laws of the automaton by number, such as law L9: see
``docs/explanation/processing-model.md``.
"""

from ravestate.compiled import prefer

prefer(__path__)
