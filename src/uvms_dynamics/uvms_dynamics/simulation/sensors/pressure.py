"""Pressure sensor."""

import numpy as np

from uvms_core.sensors import pressure
from uvms_core.signals import PressureSample
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Pressure
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.simulation.sensors.error_model import Errors
from uvms_dynamics.simulation.sensors.model import SensorModel
from uvms_dynamics.simulation.sensors.mounting import QUATERNION, VELOCITY, Trajectory


class PressureSensor(SensorModel):
    """Absolute pressure at the lever arm: p_atm + rho g z in the water, with bias and noise.

    Under waves with their linear pressure. The pressure that accelerates a uniform stream has no
    place where it is zero, and is left out.
    """

    type = pressure.TYPE

    def __init__(self, vehicle: Vehicle, section: Pressure, period: int, seed: int) -> None:
        super().__init__(vehicle, section, period, seed)
        sea = vehicle.environment
        self._noise = section.noise_pa
        self._lever = np.array(section.position_m)
        self._surface = sea.atmospheric_pressure_pa
        self._gradient = sea.water_density_kg_m3 * sea.gravity_m_s2
        self._bias = section.bias_pa * self.rng.standard_normal()
        self._errors = Errors(
            seed,
            self.type.name,
            1,
            walk=section.random_walk_pa,
            scale=section.scale_error,
            resolution=section.resolution_pa,
            outlier=section.outlier_pa,
            outlier_rate=section.outlier_rate,
        )
        self._variance = section.noise_pa**2 + section.bias_pa**2

    def sample(self, trajectory: Trajectory) -> tuple[PressureSample, ...]:
        """Samples that are due on the trajectory."""
        return tuple(self._read(trajectory, row) for row in trajectory.due(self.period))

    def _read(self, trajectory: Trajectory, row: int) -> PressureSample:
        state = trajectory.states[row]
        rotation = quat_to_matrix(state[QUATERNION:VELOCITY])
        place = state[:3] + rotation @ self._lever
        depth = float(place[2]) + trajectory.wave_head(row, place)
        error = self._bias + self._noise * self.rng.standard_normal()
        stamp, true = trajectory.stamps[row], self._surface + self._gradient * max(depth, 0.0)
        if not self._errors.exist:
            return PressureSample(stamp, true + error, self._variance)
        noisy = self._errors.scaled(np.array([true])) + error
        return PressureSample(stamp, float(self._errors.completed(stamp, noisy)[0]), self._variance)
