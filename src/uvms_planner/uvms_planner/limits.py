"""What one planner step may change, from the vehicle file and the planner's own limits."""

from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle, joint_limits
from uvms_planner.config import LimitsConfig

PEAK_BRAKING = 1.5  # a smooth stop's greatest deceleration over its mean


@dataclass(frozen=True)
class JointLimits:
    """The vehicle file's limits of the joints, in rad."""

    names: tuple[str, ...]
    lower: Array  # (n,) rad
    upper: Array  # (n,) rad
    rate: Array  # (n,) rad/s
    acceleration: Array  # (n,) rad/s^2

    @staticmethod
    def of(vehicle: Vehicle) -> "JointLimits":
        """The limits in `vehicle`."""
        joints = vehicle.arm.joints
        lower, upper = joint_limits(vehicle)
        return JointLimits(
            names=tuple(joint.name for joint in joints),
            lower=lower,
            upper=upper,
            rate=np.deg2rad([joint.rate_limit_deg_s for joint in joints]),
            acceleration=np.deg2rad([joint.acceleration_limit_deg_s2 for joint in joints]),
        )


@dataclass(frozen=True)
class StepLimits:
    """Bounds of the configuration c = (x, y, z, psi, q) and of its change in a step."""

    lower: Array  # (m,) m, rad
    upper: Array  # (m,) m, rad
    reach: Array  # (m,) greatest increment of a step
    jump: Array  # (m,) greatest change of the increment from step to step

    @staticmethod
    def of(joints: JointLimits, config: LimitsConfig, step: float) -> "StepLimits":
        """Limits for steps of `step` s."""
        margin = np.deg2rad(config.joint_margin_deg)
        rate = config.joint_rate_fraction * joints.rate
        rate[0] = min(rate[0], np.deg2rad(config.base_joint_rate_deg_s))
        vehicle_rate = [config.translation_rate_m_s] * 3 + [np.deg2rad(config.yaw_rate_deg_s)]
        vehicle_acceleration = [config.translation_acceleration_m_s2] * 3
        vehicle_acceleration += [np.deg2rad(config.yaw_acceleration_deg_s2)]
        acceleration = config.joint_acceleration_fraction * joints.acceleration
        shallow, deep = config.depth_min_m, config.depth_max_m
        return StepLimits(
            lower=np.concatenate([[-np.inf, -np.inf, shallow, -np.inf], joints.lower + margin]),
            upper=np.concatenate([[np.inf, np.inf, deep, np.inf], joints.upper - margin]),
            reach=np.concatenate([vehicle_rate, rate]) * step,
            jump=np.concatenate([vehicle_acceleration, acceleration]) * step**2,
        )

    def increments(self, configuration: Array, previous: Array) -> tuple[Array, Array]:
        """Least and greatest increment (m,) from `configuration` after the increment `previous`.

        Within the rate, within the change of rate that the acceleration allows, and no faster
        towards a bound than can be stopped before it. A configuration that is beyond a bound may
        stay or come back, not go on.
        """
        braking = self.jump / PEAK_BRAKING
        upper = np.minimum(self.reach, _stoppable(self.upper - configuration, braking))
        lower = -np.minimum(self.reach, _stoppable(configuration - self.lower, braking))
        return (
            np.minimum(np.maximum(lower, previous - self.jump), upper),
            np.maximum(np.minimum(upper, previous + self.jump), lower),
        )

    def rate_increments(self, configuration: Array) -> tuple[Array, Array]:
        """The same without the acceleration: what the rates and bounds alone allow."""
        room_up = np.maximum(self.upper - configuration, 0.0)
        room_down = np.maximum(configuration - self.lower, 0.0)
        return -np.minimum(self.reach, room_down), np.minimum(self.reach, room_up)

    def violation(self, configuration: Array) -> Array:
        """How far (m,) a configuration lies beyond its bounds."""
        return np.maximum(self.lower - configuration, 0) + np.maximum(configuration - self.upper, 0)


def _stoppable(room: Array, jump: Array) -> Array:
    """Greatest increment d that can shrink by `jump` a step to zero within `room`.

    d + (d - jump) + (d - 2 jump) + ... = d (d / jump + 1) / 2 <= room.
    """
    with np.errstate(invalid="ignore"):
        increment = jump * (np.sqrt(0.25 + 2 * np.maximum(room, 0.0) / jump) - 0.5)
    return np.minimum(increment, np.maximum(room, 0.0))
