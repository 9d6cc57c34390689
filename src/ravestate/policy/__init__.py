"""The analysis of modules before they run: compile, pathways, utility, conflicts, findings, diagram.

This package uses no third-party code. Comments cite the laws of the automaton by number, such as law L9. The files of
``tests/laws`` state the laws, and the pages of ``docs/explanation`` explain many of them.
"""

from ravestate.compiled import prefer

prefer(__path__)
