"""Joint corrections that keep the end effector on its path when the vehicle is off its own."""

from dataclasses import dataclass

import numpy as np

from uvms_control.arm_config import CompensationConfig
from uvms_control.reference import ReferenceSample
from uvms_core.signals import Array, Odometry
from uvms_dynamics import end_effector, end_effector_jacobian
from uvms_dynamics.kernels.jit import exact_kernel

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
        low, high = self._bounds(desired.q)
        wanted = _needed(
            self._model,
            odometry.position,
            odometry.quaternion,
            desired.q,
            desired.end_effector,
            low,
            high,
            self._config.damping,
        )
        gain = -np.expm1(-self._config.bandwidth * dt)
        largest = self._config.max_rate * dt
        change = np.minimum(np.maximum(gain * (wanted - self._angle), -largest), largest)
        # The joint limits come before the rate bound where the reference runs into a limit.
        moved = np.minimum(np.maximum(self._angle + change, low), high)
        rate = (moved - self._angle) / dt
        self._angle = moved
        return JointCorrection(moved, rate)

    def _bounds(self, q: Array) -> tuple[Array, Array]:
        """The largest angle and the joint limits, but never away from a reference there."""
        low = np.maximum(np.minimum(self._lower - q, 0.0), -self._config.max_angle)
        high = np.minimum(np.maximum(self._upper - q, 0.0), self._config.max_angle)
        return low, high


@exact_kernel
def _needed(
    model: Array,
    position: Array,
    quaternion: Array,
    q: Array,
    target: Array,
    low: Array,
    high: Array,
    damping: float,
) -> Array:
    """Smallest correction (n,) rad of q, within its bounds, that brings the tool to the target."""
    correction = np.zeros(q.shape[0])
    for _ in range(ITERATIONS):
        tool, _ = end_effector(model, position, quaternion, q + correction)
        J = end_effector_jacobian(model, quaternion, q + correction)[:3, 6:].copy()
        damped = J @ J.T + damping**2 * np.eye(3)
        correction = correction + J.T @ np.linalg.solve(damped, target - tool)
        correction = np.minimum(np.maximum(correction, low), high)
    return correction
