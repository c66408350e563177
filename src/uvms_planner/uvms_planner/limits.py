"""What a plan may do, from the vehicle file and the planner's own limits; and one step of it."""

from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle, joint_limits
from uvms_dynamics import Model
from uvms_planner.config import LimitsConfig, PlannerConfig
from uvms_planner.vehicle_limits import vehicle_limits

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
class MotionLimits:
    """Bounds of the planned configuration c = (x, y, z, psi, q) and of its first two derivatives.

    They hold at every instant of a plan, not only at its knots.
    """

    lower: Array  # (m,) m, rad; -inf where there is none
    upper: Array  # (m,) m, rad
    rate: Array  # (m,) m/s, rad/s, in either direction
    acceleration: Array  # (m,) m/s^2, rad/s^2, in either direction
    roll_max: float  # rad, that the vehicle may take up freely, eq. (17)
    pitch_max: float  # rad, likewise

    @staticmethod
    def of(vehicle: Vehicle, model: Model, config: LimitsConfig) -> "MotionLimits":
        """Those that `config` gives, and by rule from the vehicle file where it gives none.

        Raises:
            PlannerError: a limit follows from no thruster of the vehicle; names the fields.
        """
        joints, margin = JointLimits.of(vehicle), np.deg2rad(config.joint_margin_deg)
        shallow, deep = depth_range(vehicle, config)
        rate, acceleration = _of_vehicle(vehicle, model, config)
        rate = np.concatenate([rate, _joint_rates(joints, config, config.base_joint_rate_deg_s)])
        of_joints = config.joint_acceleration_fraction * joints.acceleration
        return MotionLimits(
            lower=np.concatenate([[-np.inf, -np.inf, shallow, -np.inf], joints.lower + margin]),
            upper=np.concatenate([[np.inf, np.inf, deep, np.inf], joints.upper - margin]),
            rate=rate,
            acceleration=np.concatenate([acceleration, of_joints]),
            roll_max=np.deg2rad(config.roll_max_deg),
            pitch_max=np.deg2rad(config.pitch_max_deg),
        )


def depth_range(vehicle: Vehicle, config: LimitsConfig) -> tuple[float, float]:
    """Least and greatest depth of the vehicle's origin, m.

    By rule a sphere of the hull's volume about the origin stays between surface and seabed.
    """
    radius = float(np.cbrt(3 * vehicle.hull.volume_m3 / (4 * np.pi)))
    shallow, deep = config.depth_min_m, config.depth_max_m
    if deep is None:
        seabed = vehicle.environment.seabed_depth_m
        deep = np.inf if seabed is None else seabed - radius
    return (radius if shallow is None else shallow), deep


def _of_vehicle(vehicle: Vehicle, model: Model, config: LimitsConfig) -> tuple[Array, Array]:
    """Rates and accelerations (4,) of x, y, z and psi."""
    rate = _in_radians(config.translation_rate_m_s, config.yaw_rate_deg_s)
    acceleration = _in_radians(config.translation_acceleration_m_s2, config.yaw_acceleration_deg_s2)
    if np.all(np.isfinite([rate, acceleration])):
        return rate, acceleration
    rule = vehicle_limits(vehicle, model)
    return (
        np.where(np.isnan(rate), rule.rate, rate),
        np.where(np.isnan(acceleration), rule.acceleration, acceleration),
    )


def _in_radians(translation: float | None, turn_deg: float | None) -> Array:
    """(4,) of x, y, z and psi; NaN where it is to be by rule."""
    along = np.nan if translation is None else translation
    return np.array([along] * 3 + [np.nan if turn_deg is None else np.deg2rad(turn_deg)])


def _joint_rates(joints: JointLimits, config: LimitsConfig, base_deg_s: float | None) -> Array:
    rate = config.joint_rate_fraction * joints.rate
    if base_deg_s is not None:
        rate[0] = min(rate[0], np.deg2rad(base_deg_s))
    return rate


@dataclass(frozen=True)
class StepScales:
    """What the cost of a step counts as one: an increment (m,), and a change of it (m,).

    They are parameters of the methods that plan step by step, and no limits: a longer step costs
    more.
    """

    reach: Array  # (m,) m, rad
    jump: Array  # (m,) m, rad

    @staticmethod
    def of(vehicle: Vehicle, config: PlannerConfig) -> "StepScales":
        """Scales for steps of `config.step_s`."""
        own, joints, step = config.fitness, JointLimits.of(vehicle), config.step_s
        rate = _in_radians(own.full_rate_m_s, own.full_yaw_rate_deg_s)
        acceleration = _in_radians(own.full_acceleration_m_s2, own.full_yaw_acceleration_deg_s2)
        of_joints = _joint_rates(joints, config.limits, own.full_base_joint_rate_deg_s)
        jump = config.limits.joint_acceleration_fraction * joints.acceleration
        return StepScales(
            reach=np.concatenate([rate, of_joints]) * step,
            jump=np.concatenate([acceleration, jump]) * step**2,
        )


@dataclass(frozen=True)
class StepLimits:
    """Bounds of the configuration c = (x, y, z, psi, q) and of its change in a step."""

    lower: Array  # (m,) m, rad
    upper: Array  # (m,) m, rad
    reach: Array  # (m,) greatest increment of a step
    jump: Array  # (m,) greatest change of the increment from step to step

    @staticmethod
    def of(limits: MotionLimits, step: float) -> "StepLimits":
        """Limits for steps of `step` s."""
        return StepLimits(
            lower=limits.lower,
            upper=limits.upper,
            reach=limits.rate * step,
            jump=limits.acceleration * step**2,
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
