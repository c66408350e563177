"""Pressure sensor."""

import numpy as np

from uvms_core.rng import generator
from uvms_core.signals import PressureSample
from uvms_core.vehicle import Environment
from uvms_core.vehicle.sensors import Pressure
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.simulation.sensors.mounting import QUATERNION, VELOCITY, Trajectory


class PressureSensor:
    """Absolute pressure at the lever arm: p_atm + rho g z in the water, with bias and noise."""

    def __init__(
        self, pressure: Pressure, environment: Environment, period: int, seed: int
    ) -> None:
        self.period = period
        self._noise = pressure.noise_pa
        self._lever = np.array(pressure.position_m)
        self._surface = environment.atmospheric_pressure_pa
        self._gradient = environment.water_density_kg_m3 * environment.gravity_m_s2
        self._rng = generator(seed, "sensors/pressure")
        self._bias = pressure.bias_pa * self._rng.standard_normal()
        self._variance = pressure.noise_pa**2 + pressure.bias_pa**2

    def sample(self, trajectory: Trajectory) -> tuple[PressureSample, ...]:
        """Samples that fall due on the trajectory."""
        return tuple(self._read(trajectory, row) for row in trajectory.due(self.period))

    def _read(self, trajectory: Trajectory, row: int) -> PressureSample:
        state = trajectory.states[row]
        rotation = quat_to_matrix(state[QUATERNION:VELOCITY])
        depth = state[2] + float(rotation[2] @ self._lever)
        error = self._bias + self._noise * self._rng.standard_normal()
        pressure = self._surface + self._gradient * max(depth, 0.0) + error
        return PressureSample(trajectory.stamps[row], pressure, self._variance)
