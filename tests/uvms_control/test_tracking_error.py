"""Errors in the body frame: right under any yaw and tilt, and in any world frame."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from uvms_control.reference import ReferenceSample
from uvms_control.tracking_error import tracking_error
from uvms_core.signals import Odometry
from uvms_dynamics.kernels.rotations import (
    quat_multiply,
    quat_to_matrix,
    rotation_vector_to_quat,
    rpy_to_quat,
)

ZERO = np.zeros(6)
vectors = st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3).map(np.array)


def at(position, quaternion, nu=ZERO, nu_dot=ZERO):
    none = np.zeros(0)
    return ReferenceSample(position, quaternion, nu, nu_dot, none, none, none, np.zeros(3))


def estimate(position, quaternion, nu=ZERO):
    return Odometry(0, position, quaternion, nu, np.zeros((6, 6)), np.zeros((6, 6)))


def test_north_of_a_vehicle_that_looks_east_is_to_port():
    found = tracking_error(
        estimate(np.zeros(3), rpy_to_quat(0.0, 0.0, np.pi / 2)),
        at(np.array([1.0, 0.0, 0.0]), rpy_to_quat(0.0, 0.0, np.pi / 2)),
    )
    assert np.allclose(found.error, [0.0, -1.0, 0.0, 0.0, 0.0, 0.0], atol=1e-12)


def test_yaw_error_takes_the_short_way_across_south():
    found = tracking_error(
        estimate(np.zeros(3), rpy_to_quat(0.0, 0.0, 3.1)),
        at(np.zeros(3), rpy_to_quat(0.0, 0.0, -3.1)),
    )
    assert np.allclose(found.error[3:], [0.0, 0.0, 2 * np.pi - 6.2], atol=1e-12)


def test_desired_twist_is_turned_into_the_body_frame():
    """Both move north at 1 m/s; the reference looks north, the vehicle east: no rate error."""
    found = tracking_error(
        estimate(
            np.zeros(3),
            rpy_to_quat(0.0, 0.0, np.pi / 2),
            np.array([0.0, -1.0, 0.0, 0.0, 0.0, 0.0]),
        ),
        at(
            np.zeros(3),
            np.array([0.0, 0.0, 0.0, 1.0]),
            np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        ),
    )
    assert np.allclose(found.rate, 0.0, atol=1e-12)


@settings(deadline=None)
@given(turn=vectors, move=vectors, p=vectors, tilt=vectors, off=vectors, v=vectors, w=vectors)
def test_errors_do_not_depend_on_the_world_frame(turn, move, p, tilt, off, v, w):
    nu, nu_d = np.concatenate((v, w)), np.concatenate((w, off))
    quaternion, desired = rotation_vector_to_quat(2.0 * tilt), rotation_vector_to_quat(tilt + off)
    G = rotation_vector_to_quat(3.0 * turn)
    R = quat_to_matrix(G)
    here = tracking_error(estimate(p, quaternion, nu), at(p + off, desired, nu_d, nu))
    there = tracking_error(
        estimate(R @ p + move, quat_multiply(G, quaternion), nu),
        at(R @ (p + off) + move, quat_multiply(G, desired), nu_d, nu),
    )
    for name in ("error", "rate", "acceleration"):
        assert np.allclose(getattr(here, name), getattr(there, name), atol=1e-9)


@settings(deadline=None)
@given(tilt=vectors, off=vectors, v=vectors, w=vectors, v_d=vectors, w_d=vectors, a=vectors)
def test_acceleration_is_the_derivative_of_the_desired_twist_in_the_body(
    tilt, off, v, w, v_d, w_d, a
):
    """Turn both frames for a moment and differentiate the turned desired twist."""
    h = 1e-5
    nu, nu_d, nu_dot_d = (np.concatenate(pair) for pair in ((v, w), (v_d, w_d), (a, a[::-1])))
    quaternion = rotation_vector_to_quat(tilt)
    desired = rotation_vector_to_quat(tilt + off)

    def twist_in_body(t):
        body = quat_multiply(quaternion, rotation_vector_to_quat(w * t))
        goal = quat_multiply(desired, rotation_vector_to_quat(w_d * t))
        found = tracking_error(
            estimate(np.zeros(3), body), at(np.zeros(3), goal, nu_d + t * nu_dot_d)
        )
        return found.rate

    found = tracking_error(
        estimate(np.zeros(3), quaternion, nu), at(np.zeros(3), desired, nu_d, nu_dot_d)
    )
    numeric = (twist_in_body(h) - twist_in_body(-h)) / (2 * h)
    assert np.allclose(found.acceleration, numeric, atol=1e-6)
