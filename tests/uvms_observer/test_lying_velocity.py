"""A DVL that lies without a flag, with an inertial unit that is soon less certain than the lie.

Other speeds, currents and lengths than the table of faults has, on the BlueROV2's sensors.
"""

from dataclasses import replace

import numpy as np
import pytest
from navigation_cases import CRUISE, TURNING, VEHICLE, dvl, off, outcome_of, reads
from sensor_truth import Motion, Rig, Waves

from uvms_core.signals import DvlSample, to_nanoseconds, to_seconds
from uvms_core.vehicle import load_vehicle
from uvms_observer import NavigationConfig, NavigationFilter
from uvms_observer.navigation.measurements.base import Linear
from uvms_observer.navigation.measurements.noise import most_alike
from uvms_observer.navigation.state import MOUNTING, SIZE, empty_state
from uvms_observer.navigation.trust import lasting
from uvms_observer.navigation.trust.top_speed import speed_std

POOR = load_vehicle("bluerov2_alpha5")
HOVER = Motion(
    Waves((0, 0, 10), (0, 0, 0), (0.05, 0.05, 0.03), (30.0, 25.0, 20.0)),
    Waves((0.02, -0.03, 0.2), amplitude=(0.01, 0.01, 0.05), period_s=(9.0, 13.0, 50.0)),
)
FAST = Motion(Waves((0, 0, 10), (1.0, 0.2, 0), (3.0, 2.0, 0.5), (60.0, 45.0, 40.0)), TURNING)


def through_water(current, motion):
    """Water lock, as the current is in the world."""
    current = np.array(current)

    def change(sample):
        turn = motion.rotation(to_seconds(sample.stamp)).inv()
        return replace(sample, velocity=sample.velocity - turn.apply(current))

    return change


def around_zero():
    rng = np.random.default_rng(3)
    return lambda sample: replace(sample, velocity=0.005 * rng.standard_normal(3))


LOCK = (0.8, -0.6, 0.0)
ZERO, CODE = reads(velocity=np.zeros(3)), reads(velocity=np.full(3, -32.768))
LIES = {  # what, for how long, on which motion, m that it may cost
    "lock, 0.1 m/s": (through_water(0.1 * np.array(LOCK), CRUISE), 20.0, CRUISE, 1.5),
    "lock, 0.4 m/s": (through_water(0.4 * np.array(LOCK), CRUISE), 10.0, CRUISE, 2.0),
    "lock at a metre a second": (through_water(0.22 * np.array(LOCK), FAST), 15.0, FAST, 3.0),
    "lock in hover": (through_water(0.22 * np.array(LOCK), HOVER), 15.0, HOVER, 1.0),
    "off by a constant": (off("velocity", np.array([0.0, 0.3, 0.1])), 12.0, CRUISE, 2.0),
    "zeros": (ZERO, 25.0, CRUISE, 30.0),
    "zeros, with noise": (around_zero(), 10.0, CRUISE, 10.0),
    "zeros in hover": (ZERO, 10.0, HOVER, 10.0),
    "an error code": (CODE, 25.0, FAST, 30.0),
}


@pytest.mark.parametrize("name", LIES)
def test_a_lie_costs_what_the_covariance_says_and_ends_with_its_end(name):
    change, seconds, motion, most = LIES[name]
    fault = dvl(change, seconds)
    rig = Rig(POOR, motion, 2)
    start = tuple(map(float, motion.position(0.0)))
    navigation = NavigationFilter(POOR, NavigationConfig(initial_position_m=start))
    inside, errors, speeds = [], [], []
    for stamp, imu, dvl_samples, pressure, gps in rig.frames(fault.begin + seconds + 3.0):
        odometry = navigation.step(stamp, imu, list(fault.spoil(dvl_samples)), pressure, gps)
        error = motion.position(to_seconds(stamp)) - odometry.position
        spread = np.linalg.solve(odometry.pose_covariance[:3, :3], error)
        inside.append(np.sqrt(error @ spread) < 3.76)
        errors.append(np.linalg.norm(error))
        speeds.append(motion.velocity(to_seconds(stamp), np.zeros(3)) - odometry.nu[:3])
    assert np.mean(inside) > 0.99
    assert max(errors) < most
    assert np.abs(speeds[-1]).max() < 0.03
    assert navigation.health()["dvl"].value == "good"
    assert len(navigation.state.target) == 0  # nothing is carried any more


@pytest.mark.parametrize("seed", [1, 4])
def test_water_lock_is_not_believed_though_the_unit_is_soon_less_certain(seed):
    """0.22 m/s, of which the inertial unit alone knows nothing after three seconds."""
    fault = dvl(off("velocity", np.array([0.16, 0.15, 0.0])), 15.0)
    outcome = outcome_of(fault, seed, POOR)
    status = outcome.navigation.status()
    assert 15 * 8 <= status["dvl_gated"] <= 15 * 8 + 2  # two more, until it is sure to be back
    assert outcome.distances.max() < 3.76
    assert outcome.errors.max() < 2.0  # 3.3 m if it is believed


def test_silence_is_bounded_by_what_the_vehicle_can_do():
    """The free inertial solution is off by 0.15 m/s^2 t^2 / 2 and more: by hundreds of metres."""
    outcome = outcome_of(dvl(lambda sample: None, 40.0), 2, POOR)
    std = speed_std(POOR, 0.3)
    assert outcome.errors.max() < 40.0 * std
    assert (outcome.distances < 3.76).all()


def test_the_speed_is_that_at_which_drag_takes_all_thrust():
    """BlueROV2 ahead: four thrusters at 45 degrees against 4.03 u + 18.18 u^2, half a std."""
    std = speed_std(POOR, 0.0)
    top = 2.0 * std
    thrust = sum(each.greatest_n * abs(each.direction[0]) for each in POOR.thrusters)
    assert 4.03 * top + 18.18 * top**2 == pytest.approx(thrust, rel=0.05)
    assert speed_std(POOR, 0.4) == pytest.approx(np.hypot(std, 0.4))


def test_an_offset_is_what_a_filter_finds_that_knew_nothing_of_it():
    """Against a plain Kalman correction of both, from a std of the offset of a kilometre a second;
    and a sample that has a known offset tells as much as one that has none.
    """
    rng = np.random.default_rng(4)
    root = rng.standard_normal((SIZE, SIZE)) * 0.1
    state = empty_state()._replace(covariance=root @ root.T)
    H, N = np.zeros((3, SIZE)), np.diag([1e-3, 2e-3, 3e-3])
    H[:, 3:9] = rng.standard_normal((3, 6))
    sample = Linear(np.array([0.3, -0.2, 0.1]), H, N)
    wider = lasting.with_offset(state.copied(), sample)
    P, both = np.zeros((SIZE + 3, SIZE + 3)), np.hstack([H, np.eye(3)])
    P[:SIZE, :SIZE], P[SIZE:, SIZE:] = state.covariance, 1e6 * np.eye(3)
    K = P @ both.T @ np.linalg.inv(both @ P @ both.T + N)
    kept = np.eye(SIZE + 3) - K @ both
    P = kept @ P @ kept.T + K @ N @ K.T
    np.testing.assert_allclose(wider.covariance, P[:SIZE, :SIZE], atol=1e-5)
    np.testing.assert_allclose(wider.cross[lasting.OWN], P[SIZE:, :SIZE], atol=1e-5)
    own = wider.target_covariance[lasting.OWN, lasting.OWN]
    np.testing.assert_allclose(own, P[SIZE:, SIZE:], atol=1e-5)
    np.testing.assert_allclose(wider.target[lasting.PLACE], (K @ sample.residual)[SIZE:], atol=1e-5)

    wider.cross[:], wider.target_covariance[:], wider.target[lasting.PLACE] = 0.0, 0.0, 0.0
    lasting.correct_by_changes(wider, sample)
    left = np.linalg.inv(np.linalg.inv(state.covariance) + H.T @ np.linalg.inv(N) @ H)
    free = [k for k in range(SIZE) if k not in MOUNTING]
    told = wider.covariance[np.ix_(free, free)]
    np.testing.assert_allclose(told, left[np.ix_(free, free)], atol=1e-9)
    assert lasting.without_offset(wider).cross.shape == (0, SIZE)


def test_the_sample_about_the_estimate_is_that_which_the_filter_uses():
    """Residual and derivative against differences of the reading, and the noise's diagonal."""
    rig = Rig(VEHICLE, CRUISE)
    navigation = NavigationFilter(VEHICLE, NavigationConfig(initial_position_m=(0, 0, 10)))
    for frame in rig.frames(5.0):
        navigation.step(*frame)
    measurement = navigation._estimator._measurements["dvl"]
    state, rate = navigation.state, np.array([0.01, -0.02, 0.05])
    sample = DvlSample(0, np.array([0.4, -0.1, 0.02]), np.zeros((3, 3)))
    about = measurement.about(state, sample, rate)

    for k, step in enumerate(1e-4 * np.eye(3)):
        ends = (state._replace(velocity=state.velocity + way * step) for way in (1.0, -1.0))
        plus, minus = (measurement.about(end, sample, rate).residual for end in ends)
        np.testing.assert_allclose((plus - minus) / 2e-4, -about.H[:, 3 + k], atol=1e-9)
    before = state.copied()
    distance = measurement.correct(before, sample, rate, -1.0)
    S = about.H @ state.covariance @ about.H.T + about.N
    assert distance == pytest.approx(about.residual @ np.linalg.solve(S, about.residual))


@pytest.mark.parametrize(("noise", "step"), [(0.0, 0.0), (0.005, 0.05)])
def test_readings_that_may_well_be_the_same_are_not_held_against_a_sensor(noise, step):
    assert most_alike(noise, step, 3) is None


def test_equal_readings_by_chance_are_as_rare_as_said():
    """Rounded white noise at rest: rows of equal triples, counted."""
    noise, step = 0.005, 0.01
    rng = np.random.default_rng(1)
    values = np.round(rng.normal(0.0037, noise, (200_000, 1)) / step)
    same = float(np.mean(values[1:] == values[:-1]))
    assert same < step / (2.0 * np.sqrt(np.pi) * noise)
    assert most_alike(0.005, 0.001, 3) in (3, 4)
    assert most_alike(0.005, 0.0, 3) == most_alike(0.002, 0.0, 3)


def test_a_sensor_that_stands_still_to_the_last_bit_is_excluded_though_it_agrees():
    """At rest a frozen reading is right, and the next motion would be missed."""
    rig, still = Rig(POOR, Motion(Waves((0, 0, 10)))), None
    navigation = NavigationFilter(POOR, NavigationConfig(initial_position_m=(0, 0, 10)))
    for stamp, imu, dvl_samples, pressure, gps in rig.frames(10.0):
        if stamp > to_nanoseconds(5.0) and dvl_samples:
            still = still or dvl_samples[0]
            dvl_samples = [replace(each, velocity=still.velocity) for each in dvl_samples]
        navigation.step(stamp, imu, dvl_samples, pressure, gps)
    assert navigation.health()["dvl"].value == "excluded"
