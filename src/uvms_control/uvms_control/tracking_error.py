"""Errors of the vehicle against its reference, all in the vehicle's own body frame."""

from dataclasses import dataclass

import numpy as np

from uvms_control.reference import ReferenceSample
from uvms_core.signals import Array, Odometry
from uvms_dynamics.kernels.jit import exact_kernel
from uvms_dynamics.kernels.products import product, transposed_product
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
    at, to = odometry, desired
    return TrackingError(
        *errors(at.position, at.quaternion, at.nu, to.position, to.quaternion, to.nu, to.nu_dot)
    )


@exact_kernel
def errors(
    position: Array,
    quaternion: Array,
    nu: Array,
    desired_position: Array,
    desired_quaternion: Array,
    desired_nu: Array,
    desired_nu_dot: Array,
) -> tuple[Array, Array, Array]:
    """The three of `TrackingError`."""
    R_world_body = quat_to_matrix(quaternion)
    turn = quat_multiply(quat_conjugate(quaternion), desired_quaternion)
    R_body_desired = quat_to_matrix(turn)
    error, rate, acceleration = np.empty(6), np.empty(6), np.empty(6)
    error[:3] = transposed_product(R_world_body, desired_position - position)
    error[3:] = quat_to_rotation_vector(turn)
    v, omega = product(R_body_desired, desired_nu[:3]), product(R_body_desired, desired_nu[3:])
    rate[:3], rate[3:] = v - nu[:3], omega - nu[3:]
    slip = skew(rate[3:])
    acceleration[:3] = product(R_body_desired, desired_nu_dot[:3]) + product(slip, v)
    acceleration[3:] = product(R_body_desired, desired_nu_dot[3:]) + product(slip, omega)
    return error, rate, acceleration
