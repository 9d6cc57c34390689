"""A child process ends, and says why."""

import sys

from ravestate.modules._children.child import Child

WARNINGS = """
import sys
for number in range(5000):
    print("warning number", number, file=sys.stderr)
print("the reason", file=sys.stderr)
sys.exit(3)
"""


def test_the_last_line_of_a_long_error_output_says_why_a_process_ended() -> None:
    assert Child([sys.executable, "-c", WARNINGS]).end(10.0) == "exit code 3: the reason"
