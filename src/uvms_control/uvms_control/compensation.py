"""Joint corrections that keep the end effector on its path when the vehicle is off its own."""

from dataclasses import dataclass

import numpy as np

from uvms_control.config import CompensationConfig
from uvms_control.reference import ReferenceSample
from uvms_core.signals import Array, Odometry
from uvms_dynamics import end_effector, end_effector_jacobian

# Gauss-Newton steps: the first leaves 1 % or so to damping and curvature, the second nothing.
ITERATIONS = 2


@dataclass(frozen=True)
class JointCorrection:
    """Correction added to the joint reference."""

    angle: Array  # (n,) rad
    rate: Array  # (n,) rad/s


class EndEffectorCompensation:
    """Resolved motion with damped least squares on the arm's block of the Jacobian, eq. (12)."""

    def __init__(self, model, config: CompensationConfig, lower: Array, upper: Array):
        """`lower`, `upper` (n,): joint limits in rad."""
        self._model = model
        self._config = config
        middle = 0.5 * (lower + upper)
        self._lower = np.minimum(lower + config.joint_margin, middle)
        self._upper = np.maximum(upper - config.joint_margin, middle)
        self.reset()

    def reset(self) -> None:
        """Reset the correction to zero."""
        self._angle = np.zeros(self._lower.size)

    def step(self, odometry: Odometry, desired: ReferenceSample, dt: float) -> JointCorrection:
        """Follow the correction that this vehicle pose needs, bounded in angle and rate.

        The desired correction is computed from zero each time, so that it vanishes with the
        vehicle's error and nothing drifts where the arm is redundant.
        """
        if dt <= 0.0:
            return JointCorrection(self._angle, np.zeros_like(self._angle))
        wanted = self._wanted(odometry, desired)
        gain = -np.expm1(-self._config.bandwidth * dt)
        largest = self._config.max_rate * dt
        change = np.clip(gain * (wanted - self._angle), -largest, largest)
        # The joint limits come before the rate bound where the reference runs into a limit.
        moved = self._bounded(self._angle + change, desired.q)
        rate = (moved - self._angle) / dt
        self._angle = moved
        return JointCorrection(moved, rate)

    def _wanted(self, odometry: Odometry, desired: ReferenceSample) -> Array:
        """Smallest correction (n,) rad that brings the tool to the path from this vehicle pose."""
        correction = np.zeros_like(self._angle)
        for _ in range(ITERATIONS):
            q = desired.q + correction
            tool, _ = end_effector(self._model, odometry.position, odometry.quaternion, q)
            jacobian = end_effector_jacobian(self._model, odometry.quaternion, q)[:3, 6:]
            missing = desired.end_effector - tool
            damped = jacobian @ jacobian.T + self._config.damping**2 * np.eye(3)
            correction = correction + jacobian.T @ np.linalg.solve(damped, missing)
            correction = self._bounded(correction, desired.q)
        return correction

    def _bounded(self, correction: Array, q: Array) -> Array:
        """Within the largest angle and the joint limits, but never away from a reference there."""
        low = np.maximum(np.minimum(self._lower - q, 0.0), -self._config.max_angle)
        high = np.minimum(np.maximum(self._upper - q, 0.0), self._config.max_angle)
        return np.clip(correction, low, high)
