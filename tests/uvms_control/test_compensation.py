"""The arm compensates for the vehicle's position error, within bounds."""

from dataclasses import replace

import numpy as np
import pytest
from closed_loop import PERIOD, at_rest
from hypothesis import given, settings
from hypothesis import strategies as st

from uvms_control import CompensationConfig
from uvms_control.compensation import EndEffectorCompensation
from uvms_control.reference import ReferenceSample
from uvms_control.vehicle_data import least_moment
from uvms_core.vehicle import joint_limits, load_vehicle
from uvms_dynamics import build_model, end_effector, mass_matrix
from uvms_dynamics.kernels.rotations import rotation_vector_to_quat

VEHICLE = load_vehicle()
MODEL = build_model(VEHICLE)
LOWER, UPPER = joint_limits(VEHICLE)
WORKING = np.radians([10.0, 30.0, 70.0, 0.0])
LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
MASS = mass_matrix(MODEL, WORKING)


def wanted(q=WORKING):
    tool, _ = end_effector(MODEL, np.zeros(3), LEVEL, q)
    zero = np.zeros(4)
    return ReferenceSample(np.zeros(3), LEVEL, np.zeros(6), np.zeros(6), q, zero, zero, tool)


def make(config=None):
    moment = least_moment(VEHICLE)
    compensation = EndEffectorCompensation(
        MODEL, config or CompensationConfig(), LOWER, UPPER, moment
    )
    compensation.fastest, compensation.hull = 3.0, 1.7
    return compensation


def settle(displaced, desired, config=None, ticks=200):
    compensation = make(config)
    odometry, _ = displaced.estimates(0)
    for _ in range(ticks):
        correction = compensation.step(odometry, desired, MASS, PERIOD)
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
        correction = compensation.step(odometry, wanted(), MASS, PERIOD)
    assert np.allclose(correction.angle, 0.0, atol=1e-6)


@settings(deadline=None, max_examples=40)
@given(
    shift=st.lists(st.floats(-5.0, 5.0), min_size=3, max_size=3).map(np.array),
    share=st.lists(st.floats(0.0, 1.0), min_size=4, max_size=4).map(np.array),
)
def test_angle_rate_and_joint_limits_hold(shift, share):
    config = CompensationConfig()
    q = LOWER + share * (UPPER - LOWER)
    compensation = make(config)
    odometry, _ = at_rest(q, shift).estimates(0)
    last = np.zeros(4)
    for _ in range(60):
        correction = compensation.step(odometry, wanted(q), MASS, PERIOD)
        assert np.all(np.abs(correction.angle) <= config.max_angle + 1e-12)
        assert np.all(np.abs(correction.rate) <= config.max_rate + 1e-12)
        assert np.all(np.abs(correction.angle - last) <= config.max_rate * PERIOD + 1e-12)
        assert np.all(q + correction.angle >= LOWER - 1e-12)
        assert np.all(q + correction.angle <= UPPER + 1e-12)
        last = correction.angle


def test_a_reference_that_runs_into_a_limit_takes_the_correction_back():
    compensation = make()
    odometry, _ = at_rest(WORKING, (0.2, -0.2, -0.2)).estimates(0)
    for k in range(200):
        q = WORKING + min(k / 100, 1.0) * (UPPER - WORKING)
        correction = compensation.step(odometry, wanted(q), MASS, PERIOD)
        assert np.all(q + correction.angle <= UPPER + 1e-12)


def test_no_step_is_taken_without_elapsed_time():
    compensation = make()
    odometry, _ = at_rest(WORKING, (0.1, 0.0, 0.0)).estimates(0)
    correction = compensation.step(odometry, wanted(), MASS, 0.0)
    assert not correction.angle.any()
    assert not correction.rate.any()


@pytest.mark.parametrize("reset", [False, True])
def test_a_reset_forgets_the_correction(reset):
    _, compensation = settle(at_rest(WORKING, (0.05, 0.0, 0.0)), wanted())
    if reset:
        compensation.reset()
    odometry, _ = at_rest(WORKING).estimates(0)
    assert (not compensation.step(odometry, wanted(), MASS, 0.0).angle.any()) == reset


def follow_noise(step_m, ticks=3000, config=None):
    """Accelerations (k, 4) of the correction, and the compensation, on a wandering estimate."""
    rng, compensation = np.random.default_rng(3), make(config)
    position, found = np.zeros(3), []
    for _ in range(ticks):
        # A wander that stays near, as the vehicle's own loop keeps it.
        position = 0.99 * position + step_m * rng.standard_normal(3)
        odometry, _ = at_rest(WORKING, position).estimates(0)
        found.append(compensation.step(odometry, wanted(), MASS, PERIOD).acceleration)
    return np.array(found), compensation


@pytest.mark.parametrize("step_m", [2e-4, 1e-3, 4e-3])
def test_noise_costs_no_more_than_its_share_of_the_moment(step_m):
    acceleration, _ = follow_noise(step_m)
    moment = acceleration[500:] @ MASS[3:6, 6:].T
    rms = np.sqrt(np.mean(np.sum(moment**2, axis=1)))
    assert rms < 1.6 * CompensationConfig().noise_share * least_moment(VEHICLE)


def test_bandwidth_falls_with_the_noise_by_the_power_of_two_thirds():
    _, quiet = follow_noise(1e-3)
    _, loud = follow_noise(8e-3)
    assert np.allclose(loud.bandwidth[:2] * 4.0, quiet.bandwidth[:2], rtol=0.1)


def test_without_noise_the_arm_is_as_fast_as_its_joints_and_the_hull_allow():
    """The swing joint rolls the hull as much as it moves the tool: there the hull's loop counts."""
    _, compensation = settle(at_rest(WORKING, (0.02, 0.0, 0.0)), wanted())
    assert compensation.bandwidth[2] == pytest.approx(3.0, rel=0.05)
    assert np.all(compensation.bandwidth[:3] >= 1.7 - 1e-9)


def test_swell_is_followed_without_the_lag_of_the_filter():
    """A vehicle that moves 5 cm to and fro within 8 s, its velocity known well."""
    compensation, w, errors = make(), 2.0 * np.pi / 8.0, []
    for k in range(1200):
        t = k * PERIOD
        x, v = 0.05 * np.sin(w * t), 0.05 * w * np.cos(w * t)
        odometry, _ = at_rest(WORKING, (x, 0.0, 0.0)).estimates(0)
        odometry = replace(odometry, nu=np.array([v, 0.0, 0.0, 0.0, 0.0, 0.0]))
        correction = compensation.step(odometry, wanted(), MASS, PERIOD)
        errors.append(tool_error(at_rest(WORKING, (x, 0.0, 0.0)), wanted(), correction))
    lag_of_the_filter = 0.05 * 2.0 * w / 3.0
    assert max(errors[400:]) < 0.35 * lag_of_the_filter
