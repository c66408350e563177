"""Doppler velocity log."""

import numpy as np

from uvms_core.rng import generator
from uvms_core.signals import Array, DvlSample
from uvms_core.vehicle.sensors import Dvl
from uvms_dynamics.simulation.sensors.mounting import SPEED, Trajectory, at_lever


class DvlSensor:
    """Velocity over ground at the lever arm, body axes: (1 + s) (v + omega x r) + noise."""

    def __init__(self, dvl: Dvl, period: int, seed: int) -> None:
        self.period = period
        self._dvl = dvl
        self._lever = np.array(dvl.position_m)
        self._rng = generator(seed, "sensors/dvl")
        self._scale = 1.0 + dvl.scale_error * self._rng.standard_normal()

    def sample(self, trajectory: Trajectory) -> tuple[DvlSample, ...]:
        """Samples that fall due on the trajectory."""
        rows = trajectory.due(self.period)
        if not rows:
            return ()
        motion = at_lever(
            trajectory.states,
            trajectory.rates,
            np.array(rows, dtype=np.int64),
            trajectory.current,
            self._lever,
            0.0,
        )
        return tuple(
            self._read(trajectory.stamps[row], motion[k, SPEED]) for k, row in enumerate(rows)
        )

    def _read(self, stamp: int, velocity: Array) -> DvlSample:
        noise = self._dvl.noise_m_s * self._rng.standard_normal(3)
        measured = self._scale * velocity + noise
        variance = self._dvl.noise_m_s**2 + (self._dvl.scale_error * measured) ** 2
        return DvlSample(stamp, measured, np.diag(variance))
