"""The state at the start: attitude of the first IMU sample, position of the configuration."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from uvms_core.signals import Array, ImuSample, Odometry
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_observer.navigation.begin.levelling import level, level_variance
from uvms_observer.navigation.inertial.installation import Installation
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import (
    ATTITUDE,
    COMPASS_BIAS,
    POSITION,
    SIZE,
    VELOCITY,
    NavigationState,
    empty_state,
)


def aligned(
    sample: ImuSample,
    imu: Installation,
    config: NavigationConfig,
    start: Odometry | None = None,
) -> NavigationState:
    """At the configured position and velocity, with the measured attitude.

    With a `start`, its position and velocity, as uncertain as it says.

    The attitude is off by the gyrocompass's noise and by its bias, so that it starts correlated
    with the bias: dtheta = -R (b_c + n).
    """
    state = empty_state()
    quaternion = sample.quaternion / np.linalg.norm(sample.quaternion)
    state.quaternion[:] = quaternion
    P, R = state.covariance, quat_to_matrix(quaternion)
    state.position[:] = config.initial_position_m - R @ imu.body
    if any(config.initial_velocity_m_s):  # else the IMU is at rest, whatever its noise says
        swing = R @ np.cross(sample.angular_velocity, imu.body)
        state.velocity[:] = config.initial_velocity_m_s - swing
    horizontal, vertical = config.initial_position_std_m, config.initial_depth_std_m
    P[[0, 1, 2], [0, 1, 2]] = np.array([horizontal, horizontal, vertical]) ** 2
    P[VELOCITY, VELOCITY] = np.eye(3) * config.initial_velocity_std_m_s**2
    P[range(9, SIZE), range(9, SIZE)] = imu.process.variance
    if start is not None:
        _go_on_from(start, state, sample, imu, R)
    state.reference[:] = state.velocity
    bias = np.diag(imu.process.variance[6:9])
    P[ATTITUDE, ATTITUDE] = R @ (bias + np.diag(imu.attitude_variance)) @ R.T
    P[ATTITUDE, COMPASS_BIAS] = -R @ bias
    P[COMPASS_BIAS, ATTITUDE] = -bias @ R.T
    return state


def levelled(
    sample: ImuSample, imu: Installation, heading: Callable[[Array], tuple[float, float] | None]
) -> tuple[ImuSample, Installation]:
    """A sample with the attitude that gravity and a heading give, and the unit, so uncertain.

    Args:
        sample: without attitude.
        imu: the unit.
        heading: gives the heading and its variance for an attitude (4,) with heading zero.
    """
    force = sample.linear_acceleration
    angle, variance = heading(level(force)) or (0.0, np.pi**2)
    noise = float(np.hypot(imu.force_noise, max(imu.excess_of(sample)[2]) ** 0.5))
    tilt = level_variance(imu.gravity, noise, float(imu.process.variance[3]))
    return (
        replace(sample, quaternion=level(force, angle)),
        imu._replace(attitude_variance=np.array([tilt, tilt, variance])),
    )


def _go_on_from(
    start: Odometry, state: NavigationState, sample: ImuSample, imu: Installation, R: Array
) -> None:
    """Position and velocity of the IMU from those of the body origin, in place."""
    velocity = start.nu[:3] - np.cross(sample.angular_velocity, imu.body)
    state.position[:] = start.position - R @ imu.body
    state.velocity[:] = R @ velocity
    state.covariance[POSITION, POSITION] = start.pose_covariance[:3, :3]
    state.covariance[VELOCITY, VELOCITY] = R @ start.twist_covariance[:3, :3] @ R.T
