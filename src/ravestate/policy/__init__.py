"""The analysis of modules before they run: compile, pathways, utility, conflicts, findings, diagram.

This package uses no third-party code.
"""

from ravestate.compiled import prefer

prefer(__path__)
