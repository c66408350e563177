"""Wrench of the thrusters over an interval: the commanded wrench with their lag.

The allocator reports the wrench of the thrusts that it commands. The thrusts follow from the wrench
by the least-norm inverse of the thruster matrix, which is exact when thrusters that share an axis
share a time constant. Slew limits are neglected.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics.model import thruster_matrix
from uvms_observer.lagged_thrusts import LaggedThrusts


class ThrustLag:
    """Wrench of the vehicle's thrusters behind the commanded one; it starts at rest."""

    def __init__(self, vehicle: Vehicle) -> None:
        self._matrix = thruster_matrix(vehicle)
        self._inverse = np.linalg.pinv(self._matrix)
        self._thrusts = LaggedThrusts(vehicle)

    def step(self, dt: float, commanded: Array) -> Array:
        """Mean wrench (6,) over dt s with this wrench commanded."""
        return self._matrix @ self._thrusts.step(dt, self._inverse @ commanded)
