"""What the model gives at the estimated state: restoring and coupling wrench of eq. (21)."""

import numpy as np

from uvms_core.signals import Array, Odometry
from uvms_dynamics import Model, coupling_wrench, restoring_wrench
from uvms_dynamics.joint_filter import JointEstimate
from uvms_dynamics.joint_prediction import jerk_of_velocity
from uvms_dynamics.kernels.jit import exact_kernel
from uvms_dynamics.tracking import follow, transition, walk

ORDER = 2
"""The vehicle's velocity and acceleration are followed."""


class ModelParts:
    """Restoring and coupling, with the vehicle's acceleration by tracking filters.

    Args:
        noise: (2,) of the linear and angular velocity, standard deviations in m/s and rad/s.
        jerks: (2,) changes of the linear and angular acceleration within a second, m/s^3, rad/s^3;
            one that is None by rule (`jerk_of_velocity`).
    """

    def __init__(self, noise: Array, jerks: tuple[float | None, float | None]) -> None:
        self._noise, self._jerks = noise, jerks
        self._x = np.zeros((ORDER, 6))
        self._P = np.zeros((2, ORDER, ORDER))
        self._dt, self._F, self._Q = 0.0, np.eye(ORDER), np.zeros((2, ORDER, ORDER))
        self._begun = False

    def step(self, model: Model, dt: float, odometry: Odometry, joints: JointEstimate) -> Array:
        """Rows (3, 6): restoring, coupling, and coupling of a vehicle that does not accelerate.

        Args:
            model: with the payload that is held.
            dt: since the step before, s; 0 at the first.
        """
        if not self._begun:
            self._begin(odometry)
        elif dt != self._dt:
            densities = self._squares(dt)
            if not self._dt:  # nothing but the first velocity is known
                self._P[:, 1, 1] = densities
            self._dt, self._F = dt, transition(ORDER, dt)
            self._Q = densities[:, None, None] * walk(ORDER, dt)
        return _parts(
            model, odometry.quaternion, odometry.nu, odometry.twist_covariance,
            *joints[:3], self._x, self._P, self._F, self._Q,
        )  # fmt: skip

    @property
    def nu_dot(self) -> Array:
        """Acceleration (6,) of the vehicle at the last step, body frame."""
        return self._x[1]

    def _squares(self, dt: float) -> Array:
        """Squared jerks (2,) at intervals of dt s."""
        rule = jerk_of_velocity(self._noise, dt)
        given = [own if jerk is None else jerk for jerk, own in zip(self._jerks, rule, strict=True)]
        return np.square(given)

    def _begin(self, odometry: Odometry) -> None:
        """From the measurement, with no acceleration."""
        self._begun = True
        self._x[0] = odometry.nu
        variances = odometry.twist_covariance.diagonal().reshape(2, 3).mean(axis=1)
        for P, variance in zip(self._P, variances, strict=True):
            P[0, 0] = variance


@exact_kernel
def _parts(
    model: Model, quaternion: Array, nu: Array, covariance: Array, q: Array, q_dot: Array,
    q_ddot: Array, x: Array, P: Array, F: Array, Q: Array,
) -> Array:  # fmt: skip
    """As `ModelParts.step`; x and P are changed in place."""
    for part in range(2):  # linear, angular
        first = 3 * part
        own = slice(first, first + 3)
        variance = np.zeros(1)
        for k in range(first, first + 3):
            variance[0] += covariance[k, k] / 3.0
        measured = nu[own].copy().reshape(1, 3)
        x[:, own], P[part] = follow(x[:, own].copy(), P[part], F, Q[part], measured, variance)
    rows = np.empty((3, 6))
    rows[0] = restoring_wrench(model, quaternion, q)
    rows[1] = coupling_wrench(model, nu, x[1].copy(), q, q_dot, q_ddot)
    rows[2] = coupling_wrench(model, nu, np.zeros(6), q, q_dot, q_ddot)
    return rows
