"""The command line, as ``python -m ravestate``."""

import sys

from ravestate.cli import script

sys.exit(script())
