"""Public helpers for tests. `simulate` runs modules, and `talk` holds a spoken conversation, both in virtual time.

A platform's tests run `CHECKS`.
"""

from ravestate.testing.platforms import CHECKS, Driver, echo
from ravestate.testing.simulation import Simulation, simulate
from ravestate.testing.talking import Said, talk

__all__ = ["CHECKS", "Driver", "Said", "Simulation", "echo", "simulate", "talk"]
