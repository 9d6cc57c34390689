"""Public helpers for tests. `simulate` runs modules in virtual time; `talk` holds a spoken conversation in it."""

from ravestate.testing.simulation import Simulation, simulate
from ravestate.testing.talking import Said, talk

__all__ = ["Said", "Simulation", "simulate", "talk"]
