"""Faults of sensors: the same run with and without, sample by sample."""

import numpy as np
import pytest
from random_vehicles import REFERENCE

from uvms_core.signals import JointCommand, ThrusterCommand
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.kernels.rotations import (
    quat_conjugate,
    quat_multiply,
    quat_to_rotation_vector,
)
from uvms_dynamics.simulation import Plant, PlantConfig
from uvms_dynamics.simulation.events import event_from_text

N, M = REFERENCE.n_joints, REFERENCE.n_thrusters
TICKS = 100
BEGIN, END = 1.0, 4.0
PERIOD = 50_000_000  # of the control ticks, ns


def frames_of(*texts, seed=3, ticks=TICKS, vehicle=REFERENCE):
    events = tuple(event_from_text(text, 0) for text in texts)
    config = PlantConfig(initial_velocity=(0.5, 0.1, 0.0, 0.0, 0.0, 0.05))
    plant = Plant(vehicle, config, seed, events)
    frames = [plant.sense()]
    for _ in range(ticks):
        plant.step(
            ThrusterCommand(plant.stamp, np.zeros(M)), JointCommand(plant.stamp, np.zeros(N))
        )
        frames.append(plant.sense())
    return frames


def samples_of(frames, sensor):
    return [sample for frame in frames for sample in frame.samples[sensor]]


def fault(sensor, text):
    return f"{{at_s: {BEGIN}, until_s: {END}, sensor: {sensor}, {text}}}"


@pytest.fixture(scope="module")
def whole():
    return frames_of()


def is_covered(stamp):
    return BEGIN <= 1e-9 * stamp < END


def pairs(whole, sensor, *texts, **more):
    """Samples of the run with faults and without, of the same stamps: during the fault."""
    frames = frames_of(*texts, **more)
    ours, theirs = samples_of(frames, sensor), samples_of(whole, sensor)
    assert [each.stamp for each in ours] == [each.stamp for each in theirs]
    for mine, other in zip(ours, theirs, strict=True):
        if not is_covered(mine.stamp):
            for name in vars(other):
                np.testing.assert_array_equal(getattr(mine, name), getattr(other, name))
    for name in {"imu", "dvl", "pressure", "gps"} - {sensor}:  # nobody else's numbers change
        for mine, other in zip(samples_of(frames, name), samples_of(whole, name), strict=True):
            for field in vars(other):
                np.testing.assert_array_equal(getattr(mine, field), getattr(other, field))
    return [(a, b) for a, b in zip(ours, theirs, strict=True) if is_covered(a.stamp)]


def test_bias(whole):
    found = pairs(whole, "dvl", fault("dvl", "fault: bias, bias: [0.1, -0.2, 0.3]"))
    assert len(found) == 24
    for mine, other in found:
        np.testing.assert_allclose(mine.velocity - other.velocity, (0.1, -0.2, 0.3), atol=1e-15)
        np.testing.assert_array_equal(mine.covariance, other.covariance)


def test_bias_of_an_attitude_is_a_turn_about_the_body_axes(whole):
    text = fault("imu", "fault: bias, field: quaternion, bias: [0.0, 0.0, 0.1]")
    for mine, other in pairs(whole, "imu", text):
        turn = quat_multiply(quat_conjugate(other.quaternion), mine.quaternion)
        np.testing.assert_allclose(quat_to_rotation_vector(turn), (0.0, 0.0, 0.1), atol=1e-12)
        np.testing.assert_array_equal(mine.angular_velocity, other.angular_velocity)


def test_scale(whole):
    for mine, other in pairs(whole, "dvl", fault("dvl", "fault: scale, scale: [2, 1, 0.5]")):
        np.testing.assert_array_equal(mine.velocity, other.velocity * (2.0, 1.0, 0.5))


def test_noise_has_its_standard_deviation_and_is_white(whole):
    text = fault("imu", "fault: noise, field: angular_velocity, std: 0.02")
    found = pairs(whole, "imu", text)
    error = np.array([mine.angular_velocity - other.angular_velocity for mine, other in found])
    assert error.shape == (300, 3)
    assert np.abs(error.std(axis=0) / 0.02 - 1.0).max() < 3.0 / np.sqrt(2 * 300) + 0.02
    assert np.abs(error.mean(axis=0)).max() < 3.5 * 0.02 / np.sqrt(300)
    assert np.abs(np.mean(error[1:] * error[:-1], axis=0)).max() < 4.0 * 0.02**2 / np.sqrt(300)


def test_outliers_come_at_their_rate_and_size(whole):
    text = fault("imu", "fault: outliers, field: linear_acceleration, rate: 0.2, std: 5")
    found = pairs(whole, "imu", text)
    error = np.array(
        [mine.linear_acceleration - other.linear_acceleration for mine, other in found]
    )
    hit = np.abs(error).any(axis=1)
    assert abs(hit.mean() - 0.2) < 3.5 * np.sqrt(0.2 * 0.8 / 300)
    assert abs(error[hit].std() / 5.0 - 1.0) < 0.25


def test_zeros_are_zero_and_an_attitude_is_level(whole):
    for mine, _ in pairs(whole, "imu", fault("imu", "fault: zeros")):
        np.testing.assert_array_equal(mine.angular_velocity, 0.0)
        np.testing.assert_array_equal(mine.linear_acceleration, 0.0)
        np.testing.assert_array_equal(mine.quaternion, (0.0, 0.0, 0.0, 1.0))
    for mine, _ in pairs(whole, "pressure", fault("pressure", "fault: zeros")):
        assert mine.pressure == 0.0


def test_a_stuck_sensor_repeats_what_it_measured_last(whole):
    last = [s for s in samples_of(whole, "dvl") if 1e-9 * s.stamp < BEGIN][-1]
    for mine, _ in pairs(whole, "dvl", fault("dvl", "fault: stuck")):
        np.testing.assert_array_equal(mine.velocity, last.velocity)


def test_a_silent_sensor_says_nothing_and_the_gaps_are_told(whole):
    frames = frames_of(fault("dvl", "fault: silent"))
    stamps = [sample.stamp for sample in samples_of(frames, "dvl")]
    every = [sample.stamp for sample in samples_of(whole, "dvl")]
    assert stamps == [stamp for stamp in every if not is_covered(stamp)]
    told = [frame.gaps for frame in frames if frame.gaps is not None]
    assert {gaps.sensors for gaps in told} == {("dvl",)}
    assert {gaps.newest for gaps in told} == {(875_000_000,)}
    assert len(told) == len(every) - len(stamps)
    assert all(frame.gaps is None for frame in whole)


def test_late_samples_keep_stamp_value_and_order(whole):
    frames = frames_of(fault("dvl", "fault: latency, latency_s: 0.3"))
    ours, theirs = samples_of(frames, "dvl"), samples_of(whole, "dvl")
    assert [each.stamp for each in ours] == [each.stamp for each in theirs]
    for mine, other in zip(ours, theirs, strict=True):
        np.testing.assert_array_equal(mine.velocity, other.velocity)
    arrival = {
        s.stamp: 50_000_000 * k for k, frame in enumerate(frames) for s in frame.samples["dvl"]
    }
    period = 50_000_000
    last = max(came for stamp, came in arrival.items() if is_covered(stamp))
    for stamp, came in arrival.items():
        delay = 300_000_000 if is_covered(stamp) else 0
        due = -(-(stamp + delay) // period) * period
        assert came == (max(due, last) if 1e-9 * stamp >= END else due)


def test_encoders_can_be_wrong_too(whole):
    text = fault("encoders", "fault: bias, field: position, bias: [0.1, 0, 0, 0]")
    for mine, other in zip(frames_of(text), whole, strict=True):
        shift = 0.1 if is_covered(mine.joints.stamp) else 0.0
        np.testing.assert_allclose(
            mine.joints.position - other.joints.position, (shift, 0.0, 0.0, 0.0), atol=1e-15
        )


def test_late_joint_states_come_at_the_tick_at_or_after_their_latency(whole):
    frames = frames_of(fault("encoders", "fault: latency, latency_s: 0.12"))
    came = [(k * PERIOD, each) for k, frame in enumerate(frames) for each in frame.joint_samples]
    assert [each.stamp for _, each in came] == [k * PERIOD for k in range(TICKS + 1)]
    last = round(1e9 * END) + 2 * PERIOD  # when the last of the late ones comes
    for (tick, mine), other in zip(came, whole, strict=True):
        np.testing.assert_array_equal(mine.position, other.joints.position)
        if 1e-9 * mine.stamp >= END:
            assert tick == max(mine.stamp, last)
        else:
            assert tick == mine.stamp + 3 * PERIOD * is_covered(mine.stamp)
    for k, frame in enumerate(frames):
        known = [each for tick, each in came if tick <= k * PERIOD]
        assert frame.joints is known[-1]
        gaps = frame.gaps
        told = {} if gaps is None else dict(zip(gaps.sensors, gaps.newest, strict=True))
        is_whole = [each.stamp for each in frame.joint_samples] == [k * PERIOD]
        assert told.get("encoders") == (None if is_whole else known[-1].stamp)


def test_faults_are_the_same_for_the_same_seed_and_differ_for_another():
    text = fault("dvl", "fault: noise, std: 0.1")
    first, again = (samples_of(frames_of(text, ticks=60), "dvl") for _ in range(2))
    other = samples_of(frames_of(text, ticks=60, seed=4), "dvl")
    for a, b in zip(first, again, strict=True):
        np.testing.assert_array_equal(a.velocity, b.velocity)
    assert any((a.velocity != b.velocity).any() for a, b in zip(first, other, strict=True))


def test_several_faults_of_a_sensor_work_one_after_another(whole):
    texts = fault("dvl", "fault: bias, bias: 1.0"), fault("dvl", "fault: scale, scale: 2.0")
    for mine, other in pairs(whole, "dvl", *texts):
        np.testing.assert_allclose(mine.velocity, 2.0 * (other.velocity + 1.0), rtol=1e-14)


@pytest.mark.parametrize(("own", "more"), [(0.4, 0.3), (0.4, 0.8), (0.1, 0.05)])
def test_a_late_sensor_comes_later_still_by_the_fault(own, more):
    vehicle = load_vehicle(None, {"sensors.dvl.latency_s": own})
    frames = frames_of(fault("dvl", f"fault: latency, latency_s: {more}"), vehicle=vehicle)
    arrivals = [
        (sample.stamp, tick * PERIOD)
        for tick, frame in enumerate(frames)
        for sample in frame.samples["dvl"]
        if sample.stamp > 0
    ]
    assert sum(is_covered(stamp) for stamp, _ in arrivals) > 10
    last = 0
    for stamp, came in arrivals:
        delay = own + more if is_covered(stamp) else own
        last = max(last, stamp + round(1e9 * delay))
        assert came == -(-last // PERIOD) * PERIOD


def test_no_other_event_changes_the_noise_of_a_fault():
    noise = "{at_s: 0.5, sensor: dvl, fault: noise, std: 0.1}"
    others = (
        "{at_s: 9.0, thruster: main, effectiveness: 1}",
        "{at_s: 9.0, sensor: dvl, fault: noise, std: 0.1}",
        "{at_s: 0.5, sensor: imu, fault: noise, field: linear_acceleration, std: 0.1}",
    )
    alone = frames_of(noise, ticks=20)
    together = frames_of(*others, noise, ticks=20)
    for ours, theirs in zip(samples_of(together, "dvl"), samples_of(alone, "dvl"), strict=True):
        np.testing.assert_array_equal(ours.velocity, theirs.velocity)


def test_two_faults_that_are_alike_have_random_numbers_of_their_own():
    noise = "{at_s: 0.5, sensor: dvl, fault: noise, std: 0.1}"
    runs = [samples_of(frames_of(*[noise] * count, ticks=20), "dvl") for count in range(3)]
    whole, once, twice = (np.array([each.velocity for each in run]) for run in runs)
    first, second = once - whole, twice - once
    assert np.abs(first[-5:]).min() > 1e-6
    assert np.abs(second[-5:] - first[-5:]).min() > 1e-6
