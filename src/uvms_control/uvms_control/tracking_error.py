"""Errors of the vehicle against its reference, all in the vehicle's own body frame."""

from dataclasses import dataclass

import numpy as np

from uvms_control.reference import ReferenceSample
from uvms_core.signals import Array, Odometry
from uvms_dynamics.kernels.rotations import (
    quat_conjugate,
    quat_multiply,
    quat_to_matrix,
    quat_to_rotation_vector,
    skew,
)


@dataclass(frozen=True)
class TrackingError:
    """Errors "desired minus actual" and the desired acceleration, in the actual body frame."""

    error: Array  # (6,) m and rad
    rate: Array  # (6,) m/s and rad/s
    acceleration: Array  # (6,) body-frame derivative of the desired twist, m/s^2 and rad/s^2


def tracking_error(odometry: Odometry, desired: ReferenceSample) -> TrackingError:
    """Pose, rate and acceleration of the reference as the vehicle sees them.

    With R = R_world_body and Rt = R^T R_world_desired:
        position  R^T (p_d - p)
        attitude  rotation vector of quat^-1 quat_d (the same in both body frames)
        rate      [Rt v_d; Rt omega_d] - nu
        acceleration  d/dt of [Rt v_d; Rt omega_d], seen in the body frame:
                  Rt nu_dot_d + [w x Rt v_d; w x Rt omega_d],  w = Rt omega_d - omega
    """
    R_world_body = quat_to_matrix(odometry.quaternion)
    turn = quat_multiply(quat_conjugate(odometry.quaternion), desired.quaternion)
    R_body_desired = quat_to_matrix(turn)
    position = R_world_body.T @ (desired.position - odometry.position)
    v, omega = R_body_desired @ desired.nu[:3], R_body_desired @ desired.nu[3:]
    slip = omega - odometry.nu[3:]
    linear = R_body_desired @ desired.nu_dot[:3] + skew(slip) @ v
    angular = R_body_desired @ desired.nu_dot[3:] + skew(slip) @ omega
    return TrackingError(
        error=np.concatenate((position, quat_to_rotation_vector(turn))),
        rate=np.concatenate((v, omega)) - odometry.nu,
        acceleration=np.concatenate((linear, angular)),
    )
