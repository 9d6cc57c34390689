"""The command line, as the command ``ravestate`` and as ``python -m ravestate``."""

import sys


def script() -> int:
    """Run the command line. Ctrl-C ends it without a traceback, even during the imports."""
    try:
        from ravestate.cli import script

        return script()
    except KeyboardInterrupt:
        return 130  # the exit code of a command that Ctrl-C has ended


if __name__ == "__main__":
    sys.exit(script())
