"""Joint encoders."""

import math

import numpy as np

from uvms_core.rng import generator
from uvms_core.signals import Array, JointStates
from uvms_core.vehicle.sensors import Encoders
from uvms_dynamics.simulation.sensors.error_model import Errors


class EncoderSensor:
    """Joint angles with errors, rounded to the encoder's step, rates with noise, true torques."""

    def __init__(self, encoders: Encoders, seed: int) -> None:
        self._step = math.radians(encoders.resolution_deg)
        self._noise = math.radians(encoders.noise_deg)
        self._rate_noise = math.radians(encoders.rate_noise_deg_s)
        self._rng = generator(seed, "sensors/encoders")
        self._section, self._seed = encoders, seed
        self._errors: Errors | None = None  # made when the number of joints is known

    def sample(self, stamp: int, q: Array, q_dot: Array, effort: Array) -> JointStates:
        """One reading of all joints."""
        noise = self._rng.standard_normal((2, q.shape[0]))
        angle = q + self._noise * noise[0]
        errors = self._errors or self._further_errors(q.shape[0])
        if errors.adds:
            angle = angle + errors.added(stamp)
        if self._step > 0.0:
            angle = self._step * np.round(angle / self._step)
        return JointStates(stamp, angle, q_dot + self._rate_noise * noise[1], effort.copy())

    def _further_errors(self, n: int) -> Errors:
        self._errors = Errors(
            self._seed,
            "encoders",
            n,
            bias=math.radians(self._section.bias_deg),
            outlier=math.radians(self._section.outlier_deg),
            outlier_rate=self._section.outlier_rate,
        )
        return self._errors
