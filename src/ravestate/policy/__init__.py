"""What can be known before running: compile, pathways, utility, conflicts, findings, diagram. Pure."""
