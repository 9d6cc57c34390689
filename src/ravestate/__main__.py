"""``python -m ravestate``: the command line."""

from ravestate.cli import script

raise SystemExit(script())
