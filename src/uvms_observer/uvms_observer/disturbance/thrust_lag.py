"""Wrench of the thrusters over an interval: the commanded wrench with their lag.

The allocator reports the wrench of the thrusts that it commands; a thruster follows its command by
T' = (T_c - T) / tau. Over an interval dt with constant command the mean of T is

    T_c + (T_0 - T_c) (1 - exp(-dt/tau)) tau / dt.

The thrusts follow from the wrench by the least-norm inverse of the thruster matrix, which is exact
when thrusters that share an axis share a time constant. Slew limits are neglected.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics.model import thruster_matrix


class ThrustLag:
    """Thrust state of the vehicle's thrusters; starts at rest."""

    def __init__(self, vehicle: Vehicle) -> None:
        self._matrix = thruster_matrix(vehicle)
        self._inverse = np.linalg.pinv(self._matrix)
        self._tau = np.array([thruster.time_constant_s for thruster in vehicle.thrusters])
        self._thrust = np.zeros(len(self._tau))
        self._dt, self._decay = 0.0, np.ones(len(self._tau))

    def step(self, dt: float, commanded: Array) -> Array:
        """Mean wrench (6,) over dt s with this wrench commanded."""
        if dt != self._dt:
            self._dt, self._decay = dt, np.exp(-dt / self._tau)
        command = self._inverse @ commanded
        start = self._thrust - command
        self._thrust = command + start * self._decay
        return self._matrix @ (command + start * (1.0 - self._decay) * self._tau / dt)
