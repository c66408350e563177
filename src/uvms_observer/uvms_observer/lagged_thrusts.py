"""Thrusts behind their commands: a thruster follows its command by T' = (T_c - T) / tau.

Over an interval dt with constant command the mean of T is

    T_c + (T_0 - T_c) (1 - exp(-dt/tau)) tau / dt.

Slew limits are neglected.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle


class LaggedThrusts:
    """Thrusts behind their commands, one by one; they start at rest."""

    def __init__(self, vehicle: Vehicle) -> None:
        self._tau = np.array([thruster.time_constant_s for thruster in vehicle.thrusters])
        self._thrust = np.zeros(len(self._tau))
        self._dt, self._decay, self._mean = 0.0, np.ones(len(self._tau)), np.ones(len(self._tau))

    def step(self, dt: float, commanded: Array) -> Array:
        """Mean thrusts (m,) N over dt s with these thrusts (m,) commanded."""
        if dt != self._dt:
            self._dt, self._decay = dt, np.exp(-dt / self._tau)
            self._mean = (1.0 - self._decay) * self._tau / dt
        start = self._thrust - commanded
        self._thrust = commanded + start * self._decay
        return commanded + start * self._mean
