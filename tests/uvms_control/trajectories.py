"""Smooth motions with exact derivatives for the tests of this package."""

import numpy as np

from uvms_core.signals import Reference
from uvms_dynamics.kernels.rotations import quat_multiply, quat_to_matrix, rotation_vector_to_quat

AMPLITUDE = np.array([0.8, -0.5, 0.6, 0.4])
FREQUENCY = np.array([0.7, 1.1, 0.5, 0.9])
START = rotation_vector_to_quat(np.array([0.2, -0.1, 2.0]))
AXIS = np.array([1.0, -2.0, 2.0]) / 3.0


def joints(t):
    """Joint angles, rates and accelerations (4,) at t."""
    phase = FREQUENCY * t
    return (
        AMPLITUDE * np.sin(phase),
        AMPLITUDE * FREQUENCY * np.cos(phase),
        -AMPLITUDE * FREQUENCY**2 * np.sin(phase),
    )


def vehicle(t):
    """Position, quaternion, nu and nu_dot: the body turns about a fixed axis while it moves."""
    angle, spin, spin_dot = 0.4 * np.sin(t), 0.4 * np.cos(t), -0.4 * np.sin(t)
    quaternion = quat_multiply(START, rotation_vector_to_quat(angle * AXIS))
    omega, omega_dot = spin * AXIS, spin_dot * AXIS
    position = np.array([np.sin(t), np.cos(0.5 * t), 0.3 * t])
    velocity = np.array([np.cos(t), -0.5 * np.sin(0.5 * t), 0.3])
    acceleration = np.array([-np.sin(t), -0.25 * np.cos(0.5 * t), 0.0])
    to_body = quat_to_matrix(quaternion).T
    v = to_body @ velocity
    v_dot = to_body @ acceleration - np.cross(omega, v)
    return position, quaternion, np.concatenate((v, omega)), np.concatenate((v_dot, omega_dot))


def reference(times, stamp=0, start=0.0):
    """A Reference that samples this motion at `start + times`."""
    times = np.asarray(times, dtype=float)
    body = [vehicle(start + t) for t in times]
    arm = [joints(start + t) for t in times]
    position = np.array([b[0] for b in body])
    return Reference(
        stamp=stamp,
        times=times,
        position=position,
        quaternion=np.array([b[1] for b in body]),
        nu=np.array([b[2] for b in body]),
        nu_dot=np.array([b[3] for b in body]),
        q=np.array([a[0] for a in arm]),
        q_dot=np.array([a[1] for a in arm]),
        q_ddot=np.array([a[2] for a in arm]),
        end_effector=position + np.array([1.0, 0.0, 0.0]),
    )
