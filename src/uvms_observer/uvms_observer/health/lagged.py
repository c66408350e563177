"""Thrusts behind their commands, one by one."""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle


class LaggedThrusts:
    """Mean thrusts over a tick, by T' = (T_c - T) / tau within it; starts at rest."""

    def __init__(self, vehicle: Vehicle) -> None:
        self._tau = np.array([thruster.time_constant_s for thruster in vehicle.thrusters])
        self._thrust = np.zeros(len(self._tau))
        self._dt, self._decay, self._mean = 0.0, np.ones(len(self._tau)), np.ones(len(self._tau))

    def step(self, dt: float, commanded: Array) -> Array:
        """Mean (m,) N over dt s with these thrusts commanded."""
        if dt != self._dt:
            self._dt, self._decay = dt, np.exp(-dt / self._tau)
            self._mean = (1.0 - self._decay) * self._tau / dt
        start = self._thrust - commanded
        self._thrust = commanded + start * self._decay
        return commanded + start * self._mean
