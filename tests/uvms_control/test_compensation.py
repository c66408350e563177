"""The arm compensates for the vehicle's position error, within bounds."""

import numpy as np
import pytest
from closed_loop import PERIOD, at_rest
from hypothesis import given, settings
from hypothesis import strategies as st

from uvms_control import CompensationConfig
from uvms_control.compensation import EndEffectorCompensation
from uvms_control.reference import ReferenceSample
from uvms_core.vehicle import joint_limits, load_vehicle
from uvms_dynamics import build_model, end_effector
from uvms_dynamics.kernels.rotations import rotation_vector_to_quat

VEHICLE = load_vehicle()
MODEL = build_model(VEHICLE)
LOWER, UPPER = joint_limits(VEHICLE)
WORKING = np.radians([10.0, 30.0, 70.0, 0.0])
LEVEL = np.array([0.0, 0.0, 0.0, 1.0])


def wanted(q=WORKING):
    tool, _ = end_effector(MODEL, np.zeros(3), LEVEL, q)
    zero = np.zeros(4)
    return ReferenceSample(np.zeros(3), LEVEL, np.zeros(6), np.zeros(6), q, zero, zero, tool)


def settle(displaced, desired, config=None, ticks=200):
    compensation = EndEffectorCompensation(MODEL, config or CompensationConfig(), LOWER, UPPER)
    odometry, _ = displaced.estimates(0)
    for _ in range(ticks):
        correction = compensation.step(odometry, desired, PERIOD)
    return correction, compensation


def tool_error(displaced, desired, correction):
    q = desired.q + correction.angle
    tool, _ = end_effector(MODEL, displaced.position, displaced.quaternion, q)
    return float(np.linalg.norm(tool - desired.end_effector))


@settings(deadline=None, max_examples=40)
@given(
    shift=st.lists(st.floats(-0.05, 0.05), min_size=3, max_size=3).map(np.array),
    turn=st.lists(st.floats(-0.03, 0.03), min_size=3, max_size=3).map(np.array),
)
def test_small_vehicle_errors_are_made_up_for(shift, turn):
    displaced = at_rest(WORKING, shift, rotation_vector_to_quat(turn))
    correction, _ = settle(displaced, wanted())
    none, _ = settle(displaced, wanted(), ticks=0 + 1)
    assert tool_error(displaced, wanted(), correction) < 2e-3
    assert (
        tool_error(displaced, wanted(), correction) <= tool_error(displaced, wanted(), none) + 1e-6
    )


def test_without_an_error_nothing_is_corrected():
    correction, _ = settle(at_rest(WORKING), wanted())
    assert np.allclose(correction.angle, 0.0, atol=1e-12)


def test_the_correction_fades_with_the_error():
    _, compensation = settle(at_rest(WORKING, (0.05, 0.03, -0.04)), wanted())
    odometry, _ = at_rest(WORKING).estimates(0)
    for _ in range(200):
        correction = compensation.step(odometry, wanted(), PERIOD)
    assert np.allclose(correction.angle, 0.0, atol=1e-6)


@settings(deadline=None, max_examples=40)
@given(
    shift=st.lists(st.floats(-5.0, 5.0), min_size=3, max_size=3).map(np.array),
    share=st.lists(st.floats(0.0, 1.0), min_size=4, max_size=4).map(np.array),
)
def test_angle_rate_and_joint_limits_hold(shift, share):
    config = CompensationConfig()
    q = LOWER + share * (UPPER - LOWER)
    compensation = EndEffectorCompensation(MODEL, config, LOWER, UPPER)
    odometry, _ = at_rest(q, shift).estimates(0)
    last = np.zeros(4)
    for _ in range(60):
        correction = compensation.step(odometry, wanted(q), PERIOD)
        assert np.all(np.abs(correction.angle) <= config.max_angle + 1e-12)
        assert np.all(np.abs(correction.rate) <= config.max_rate + 1e-12)
        assert np.allclose(correction.angle - last, correction.rate * PERIOD, atol=1e-12)
        assert np.all(q + correction.angle >= LOWER - 1e-12)
        assert np.all(q + correction.angle <= UPPER + 1e-12)
        last = correction.angle


def test_a_reference_that_runs_into_a_limit_takes_the_correction_back():
    compensation = EndEffectorCompensation(MODEL, CompensationConfig(), LOWER, UPPER)
    odometry, _ = at_rest(WORKING, (0.2, -0.2, -0.2)).estimates(0)
    for k in range(200):
        q = WORKING + min(k / 100, 1.0) * (UPPER - WORKING)
        correction = compensation.step(odometry, wanted(q), PERIOD)
        assert np.all(q + correction.angle <= UPPER + 1e-12)


def test_no_step_is_taken_without_elapsed_time():
    compensation = EndEffectorCompensation(MODEL, CompensationConfig(), LOWER, UPPER)
    odometry, _ = at_rest(WORKING, (0.1, 0.0, 0.0)).estimates(0)
    correction = compensation.step(odometry, wanted(), 0.0)
    assert not correction.angle.any()
    assert not correction.rate.any()


@pytest.mark.parametrize("reset", [False, True])
def test_a_reset_forgets_the_correction(reset):
    _, compensation = settle(at_rest(WORKING, (0.05, 0.0, 0.0)), wanted())
    if reset:
        compensation.reset()
    odometry, _ = at_rest(WORKING).estimates(0)
    assert (not compensation.step(odometry, wanted(), 0.0).angle.any()) == reset
