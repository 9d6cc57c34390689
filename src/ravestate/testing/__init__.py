"""Public helpers for tests. `simulate` runs modules in virtual time."""

from ravestate.testing.simulation import Simulation, simulate

__all__ = ["Simulation", "simulate"]
