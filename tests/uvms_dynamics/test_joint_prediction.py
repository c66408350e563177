"""Late joint states, carried to the tick: exact where the acceleration is constant."""

import numpy as np
import pytest

from uvms_core.errors import SignalError
from uvms_core.signals import JointStates, to_nanoseconds
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.joint_prediction import JointPrediction, encoder_variances, joint_age_limit

VEHICLE = load_vehicle()
PERIOD = 0.05


def swing(t):
    """Angles, rates and accelerations (3, 4) of a quintic by 90 degrees in 10 s."""
    s = np.clip(t / 10.0, 0.0, 1.0)
    shape = [
        s**3 * (10 - 15 * s + 6 * s * s),
        30 * s * s * (1 - s) ** 2 / 10.0,
        60 * s * (1 - s) * (1 - 2 * s) / 100.0,
    ]
    return np.outer(shape, np.radians([90.0, -45.0, 30.0, 10.0]))


def sample(t, motion):
    q, q_dot, _ = motion(t)
    return JointStates(to_nanoseconds(t), q, q_dot, np.zeros(4))


def late(motion, age, seconds=9.0):
    """Largest errors of angle and rate, predicted and as they came."""
    predict, errors = JointPrediction(VEHICLE), []
    for t in np.arange(age, seconds, PERIOD):
        joints = sample(t - age, motion)
        found, true = predict.step(joints, to_nanoseconds(t)), motion(t)
        if t > 3.0:
            held = [
                np.abs(joints.position - true[0]).max(),
                np.abs(joints.velocity - true[1]).max(),
            ]
            carried = [np.abs(found.q - true[0]).max(), np.abs(found.q_dot - true[1]).max()]
            errors.append(np.array([held, carried]))
    return np.max(errors, axis=0)


def test_a_sample_of_the_tick_is_used_as_it_is():
    joints = sample(4.0, swing)
    found = JointPrediction(VEHICLE).step(joints, joints.stamp)
    np.testing.assert_array_equal(found[:2], [joints.position, joints.velocity])


def test_the_filter_halves_the_noise_of_the_angles():
    """Without lag, and the rates are no noisier than the encoders'."""
    rng, sigma = np.random.default_rng(1), np.sqrt(encoder_variances(VEHICLE))
    predict, errors = JointPrediction(VEHICLE), []
    for t in np.arange(0.0, 9.0, PERIOD):
        true = swing(t)
        seen = true[:2] + sigma[:, None] * rng.standard_normal((2, 4))
        stamp = to_nanoseconds(t)
        predict.step(JointStates(stamp, *seen, np.zeros(4)), stamp)
        found = predict.filter.estimate
        errors.append([found.q - true[0], found.q_dot - true[1]])
    noise = np.std(errors[20:], axis=0)
    assert (noise[0] < 0.5 * sigma[0]).all()
    assert (noise[1] < 1.05 * sigma[1]).all()


def test_a_constant_acceleration_is_carried_exactly():
    a = np.array([0.1, -0.05, 0.02, 0.0])
    _, carried = late(lambda t: np.array([0.5 * a * t * t, a * t, a]), 0.1)
    assert carried.max() < 1e-5


@pytest.mark.parametrize(("age", "share"), [(0.05, 0.25), (0.1, 0.25), (0.2, 0.65)])
def test_of_a_swing_a_part_of_the_error_is_left(age, share):
    """Of the angle little, of the rate the more the slower the acceleration is followed."""
    held, carried = late(swing, age)
    assert (carried < np.array([0.1, share]) * held).all()


def shaken(frequency):
    """All joints to and fro with an acceleration of 1 rad/s^2."""
    one = np.ones(4)
    return lambda t: np.array(
        [
            -np.sin(frequency * t) / frequency**2 * one,
            -np.cos(frequency * t) / frequency * one,
            np.sin(frequency * t) * one,
        ]
    )


def followed(frequency, age, vehicle=VEHICLE, period=PERIOD):
    """Amplitude of the acceleration that the filter finds of 1 rad/s^2, in the steady state."""
    predict, motion = JointPrediction(vehicle), shaken(frequency)
    times = np.arange(age, 20.0, period)
    found = np.array(
        [predict.step(sample(t - age, motion), to_nanoseconds(t)).q_ddot[0] for t in times]
    )[len(times) // 2 :]
    turns = np.exp(1j * frequency * times[len(times) // 2 :])
    return 2.0 * abs(np.mean(found * turns))


@pytest.mark.parametrize("age", [0.05, 0.1, 0.2])
def test_the_acceleration_of_late_samples_is_followed_up_to_a_third_of_the_inverse_of_their_age(
    age,
):
    bandwidth = 1.0 / (3.0 * age)
    assert followed(0.3 * bandwidth, age) == pytest.approx(1.0, abs=0.2)
    assert 0.4 < followed(bandwidth, age) < 1.3
    assert followed(5.0 * bandwidth, age) < 0.35
    assert followed(min(5.0 * bandwidth, 16.0), 0.0) > 0.7  # on time it is, as far as noise allows


def test_a_sample_that_came_before_is_carried_further():
    predict = JointPrediction(VEHICLE)
    for k in range(60):
        predict.step(sample(PERIOD * k, swing), to_nanoseconds(PERIOD * k))
    last, before = sample(PERIOD * 59, swing), predict.filter.estimate
    found = predict.step(last, to_nanoseconds(PERIOD * 61))
    np.testing.assert_array_equal(found.q_ddot, before.q_ddot)
    assert (found.covariance[:, [0, 1], [0, 1]] > before.covariance[:, [0, 1], [0, 1]]).all()
    np.testing.assert_allclose(found.q, swing(PERIOD * 61)[0], atol=2e-4)


def test_older_than_the_loop_stands_is_an_error():
    predict = JointPrediction(VEHICLE)
    for k in range(3):
        predict.step(sample(PERIOD * k, swing), to_nanoseconds(PERIOD * k))
    limit = joint_age_limit(VEHICLE, PERIOD)
    assert limit == pytest.approx(0.225)
    joints = sample(2 * PERIOD, swing)
    predict.check(joints, to_nanoseconds(3 * PERIOD))
    with pytest.raises(SignalError, match=r"must lie within 0\.5 s"):
        JointPrediction(VEHICLE).check(joints, to_nanoseconds(2 * PERIOD + 0.6))
    with pytest.raises(SignalError, match=r"must lie within 0\.08 s"):
        JointPrediction(VEHICLE, age_limit_s=0.08).check(joints, to_nanoseconds(2 * PERIOD + 0.1))


def noisier(factor):
    encoders = VEHICLE.sensors.encoders
    noise = {
        name: factor * getattr(encoders, name)
        for name in ("noise_deg", "rate_noise_deg_s", "resolution_deg")
    }
    encoders = encoders.model_copy(update=noise)
    sensors = VEHICLE.sensors.model_copy(update={"encoders": encoders})
    return VEHICLE.model_copy(update={"sensors": sensors})


@pytest.mark.parametrize("period", [0.02, 0.05, 0.1])
def test_by_rule_the_bandwidth_follows_the_period_whatever_the_encoders(period):
    bandwidth = 0.5 * np.pi / period
    assert followed(0.2 * bandwidth, 0.0, period=period) == pytest.approx(1.0, abs=0.1)
    assert 0.3 < followed(bandwidth, 0.0, period=period) < 1.1
    quiet = followed(0.5 * bandwidth, 0.0, period=period)
    noisy = followed(0.5 * bandwidth, 0.0, noisier(10.0), period)
    assert noisy == pytest.approx(quiet, rel=0.3)
