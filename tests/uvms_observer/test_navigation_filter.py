"""The navigation filter on the readings of an analytic motion."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import chi2
from sensor_truth import Motion, Rig, Waves

from uvms_core.signals import to_nanoseconds
from uvms_core.vehicle import load_vehicle
from uvms_observer import NavigationConfig, NavigationFilter, NotAlignedError

VEHICLE = load_vehicle()
SWIMMING = Motion(
    Waves((3.0, -2.0, 10.0), (0.05, 0.02, 0.0), (1.5, 1.0, 0.5)),
    Waves((0.02, -0.03, 0.7), (0.0, 0.0, 0.01), (0.05, 0.04, 0.4), (7.0, 11.0, 40.0)),
)
RESTING = Motion(Waves((0.0, 0.0, 5.0)), Waves((0.02, -0.01, 0.8)))
SPINNING = Motion(Waves((1.0, 2.0, 8.0)), Waves(speed=(0.0, 0.0, 0.5)))


def vehicle_with(**changes):
    """The reference vehicle with values of its sensors changed: imu={...}, dvl={...}."""
    overrides = {
        f"sensors.{sensor}.{name}": value
        for sensor, values in changes.items()
        for name, value in values.items()
    }
    return load_vehicle(overrides=overrides)


def start_of(motion, **changes):
    return NavigationConfig(initial_position_m=tuple(map(float, motion.position(0.0))), **changes)


MOUNTED = NavigationConfig().noise_floor.misalignment_deg
"""Std of the DVL's mounting that the filter assumes, deg."""


def run(rig, duration, config=None, **options):
    """The filter after the run, and the odometry of every tick."""
    navigation = NavigationFilter(rig.vehicle, config or start_of(rig.motion))
    return navigation, [navigation.step(*frame) for frame in rig.frames(duration, **options)]


def pose_error(motion, odometry):
    t = odometry.stamp * 1e-9
    turn = motion.rotation(t) * Rotation.from_quat(odometry.quaternion).inv()
    return np.concatenate((motion.position(t) - odometry.position, turn.as_rotvec()))


def twist_error(motion, odometry):
    t = odometry.stamp * 1e-9
    return np.concatenate((motion.velocity(t, np.zeros(3)), motion.omega(t))) - odometry.nu


def distance(error, covariance):
    return error @ np.linalg.solve(covariance, error)


@pytest.fixture(scope="module")
def many_runs():
    """Final odometry of 30 runs whose start and DVL are off as the configuration says."""
    finals = []
    for seed in range(30):
        offset = 0.01 * np.random.default_rng([seed, 1]).standard_normal(3)
        start = tuple(map(float, SWIMMING.position(0.0) + offset))
        config = NavigationConfig(initial_position_m=start)
        rig = Rig(VEHICLE, SWIMMING, seed, misalignment_deg=MOUNTED)
        finals.append(run(rig, 15.0, config)[1][-1])
    return finals


def assert_consistent(distances, size):
    """The sum of n distances is chi-square with n * size degrees of freedom, here within 99.9 %."""
    low, high = chi2.ppf([0.0005, 0.9995], len(distances) * size)
    assert low < sum(distances) < high


def test_pose_errors_are_as_large_as_their_covariance_says(many_runs):
    assert_consistent([distance(pose_error(SWIMMING, o), o.pose_covariance) for o in many_runs], 6)


def test_twist_errors_are_as_large_as_their_covariance_says(many_runs):
    assert_consistent(
        [distance(twist_error(SWIMMING, o), o.twist_covariance) for o in many_runs], 6
    )


@pytest.mark.parametrize("part", ["pose_covariance", "twist_covariance"])
def test_covariances_are_symmetric_and_positive(many_runs, part):
    for odometry in many_runs:
        covariance = getattr(odometry, part)
        np.testing.assert_array_equal(covariance, covariance.T)
        assert np.linalg.eigvalsh(covariance).min() > 0.0


def test_perfect_sensors_give_the_motion_back():
    odometry = run(Rig(VEHICLE, SWIMMING, noise=0.0, bias=0.0), 30.0)[1]
    errors = np.array([pose_error(SWIMMING, o) for o in odometry])
    rates = np.array([twist_error(SWIMMING, o) for o in odometry[20:]])
    assert np.abs(errors[:, :3]).max() < 1e-3
    assert np.abs(errors[:, 3:]).max() < 2e-4
    assert np.abs(rates).max() < 1e-3


def test_a_vehicle_that_spins_on_the_spot_has_no_velocity():
    """The DVL on its lever arm reads omega x r, the accelerometer the centripetal acceleration."""
    rig = Rig(VEHICLE, SPINNING, noise=0.0, bias=0.0)
    assert np.linalg.norm(rig.dvl(np.zeros(1))[0].velocity) > 0.1
    last = run(rig, 20.0)[1][-1]
    np.testing.assert_allclose(last.nu, [0.0, 0.0, 0.0, 0.0, 0.0, 0.5], atol=2e-4)
    np.testing.assert_allclose(last.position, SPINNING.position(20.0), atol=1e-3)


def test_depth_comes_from_the_first_pressure_sample_whatever_the_configuration_says():
    tilted = replace(SWIMMING, rpy=Waves((0.2, 0.4, 1.0)))
    config = NavigationConfig(initial_position_m=(3.0, -2.0, 0.0))
    frames = Rig(VEHICLE, tilted, noise=0.0, bias=0.0).frames(0.0)
    first = NavigationFilter(VEHICLE, config).step(*next(frames))
    assert first.position[2] == pytest.approx(10.0, abs=1e-4)
    assert first.pose_covariance[2, 2] < 0.02**2


def test_dead_reckoning_drifts_as_theory_says():
    """White DVL noise sigma at intervals dt integrates to sigma sqrt(dt T)."""
    exact = {"roll_pitch_bias_deg": 0.0, "heading_bias_deg": 0.0, "rate_hz": 20.0}
    vehicle = vehicle_with(imu=exact, dvl={"scale_error": 0.0, "noise_m_s": 0.05})
    config = start_of(RESTING, initial_position_std_m=1e-4)
    duration, finals = 60.0, []
    for seed in range(30):
        finals.append(run(Rig(vehicle, RESTING, seed), duration, config)[1][-1])
    theory = 0.05 * np.sqrt(duration / vehicle.sensors.dvl.rate_hz)
    stated = np.sqrt([o.pose_covariance[i, i] for o in finals for i in (0, 1)])
    np.testing.assert_allclose(stated, theory, rtol=0.1)
    found = np.sqrt(np.mean([pose_error(RESTING, o)[:2] ** 2 for o in finals]))
    assert found == pytest.approx(theory, rel=0.3)


def test_gps_at_the_surface_bounds_the_position():
    vehicle = vehicle_with(gps={"rate_hz": 10.0, "horizontal_noise_m": 0.5})
    floating = Motion(Waves(), Waves((0.0, 0.0, 1.0)))
    config = NavigationConfig(initial_position_m=(4.0, -3.0, 0.0), initial_position_std_m=5.0)
    above = run(Rig(vehicle, floating, surface=True), 60.0, config)
    below = run(Rig(vehicle, floating, surface=False), 60.0, config)
    assert np.linalg.norm(pose_error(floating, above[1][-1])[:2]) < 0.2
    assert above[1][-1].pose_covariance[0, 0] < 0.1**2
    assert np.linalg.norm(pose_error(floating, below[1][-1])[:2]) > 4.5
    assert below[0].status()["gps_accepted"] == 0


def test_gyro_and_accelerometer_biases_are_found():
    poor = {"gyro_bias_deg_s": 0.1, "accelerometer_bias_m_s2": 0.05, "roll_pitch_bias_deg": 0.0}
    rig = Rig(vehicle_with(imu=poor), SWIMMING, seed=4)
    navigation, odometry = run(rig, 60.0)
    state = navigation.state
    sigma = np.sqrt(np.diag(state.covariance))
    assert sigma[9:12].max() < 0.1 * np.radians(0.1)
    assert sigma[12:15].max() < 0.2 * 0.05
    assert np.abs((state.gyro_bias - rig.biases[:3]) / sigma[9:12]).max() < 4.0
    assert np.abs((state.accelerometer_bias - rig.biases[3:6]) / sigma[12:15]).max() < 4.0
    assert np.abs(odometry[-1].nu[3:] - SWIMMING.omega(60.0)).max() < 5e-4  # bias taken off


def test_without_the_dvl_the_covariance_grows_until_it_returns():
    rig = Rig(VEHICLE, SWIMMING, seed=2)
    config = start_of(SWIMMING, noise_floor={"misalignment_deg": 0.01})
    navigation = NavigationFilter(VEHICLE, config)
    spread = []
    for stamp, imu, dvl, pressure, gps in rig.frames(60.0):
        silent = 20.0 < stamp * 1e-9 <= 40.0
        odometry = navigation.step(stamp, imu, () if silent else dvl, pressure, gps)
        spread.append(odometry.twist_covariance[0, 0])
        error = pose_error(SWIMMING, odometry)
        assert np.all(np.abs(error) < 5.0 * np.sqrt(np.diag(odometry.pose_covariance)) + 1e-6)
    assert np.all(np.diff(spread[402:801]) > 0.0)
    assert spread[800] > 25.0 * spread[400]
    assert spread[-1] < 2.0 * spread[400]
    assert navigation.status()["dvl_gated"] <= 1  # of 320: the gate rejects one good in 10000


@pytest.mark.parametrize("sensor", ["dvl", "pressure", "gps"])
def test_the_filter_runs_without_a_sensor(sensor):
    odometry = run(Rig(VEHICLE, RESTING), 10.0, silent=(sensor,))[1]
    assert all(np.isfinite(o.nu).all() and np.isfinite(o.pose_covariance).all() for o in odometry)


def test_turning_the_world_turns_the_estimate():
    """A heading offset of start, motion and compass only turns the axes."""
    turn = Rotation.from_euler("Z", 1.1)
    turned = SWIMMING.rpy
    turned = replace(turned, offset=(*turned.offset[:2], turned.offset[2] + 1.1))
    straight = Motion(Waves((3.0, -2.0, 10.0)), SWIMMING.rpy)
    other = Motion(Waves(tuple(turn.apply((3.0, -2.0, 10.0)))), turned)
    first, second = (run(Rig(VEHICLE, motion, 5), 20.0)[1][-1] for motion in (straight, other))
    np.testing.assert_allclose(second.position, turn.apply(first.position), atol=1e-9)
    np.testing.assert_allclose(second.nu, first.nu, atol=1e-10)
    np.testing.assert_allclose(second.twist_covariance, first.twist_covariance, atol=1e-12)
    axes = np.kron(np.eye(2), turn.as_matrix())
    np.testing.assert_allclose(
        second.pose_covariance, axes @ first.pose_covariance @ axes.T, atol=1e-10
    )


def test_the_length_of_a_step_does_not_matter():
    frames = list(Rig(VEHICLE, SWIMMING, 3).frames(5.0))
    often, once = (NavigationFilter(VEHICLE, start_of(SWIMMING)) for _ in range(2))
    for frame in frames:
        last = often.step(*frame)
    whole = [[sample for frame in frames for sample in frame[i]] for i in range(1, 5)]
    at_once = once.step(frames[-1][0], *whole)
    np.testing.assert_allclose(at_once.position, last.position, atol=1e-12)
    np.testing.assert_allclose(at_once.pose_covariance, last.pose_covariance, atol=1e-15)


def test_a_late_sample_is_put_where_it_belongs():
    on_time, late = (NavigationFilter(VEHICLE, start_of(SWIMMING)) for _ in range(2))
    waiting = []
    for stamp, imu, dvl, pressure, gps in Rig(VEHICLE, SWIMMING, 3).frames(5.0):
        expected = on_time.step(stamp, imu, dvl, pressure, gps)
        odometry = late.step(stamp, imu, waiting, pressure, gps)
        waiting = dvl
    odometry = late.step(stamp + 1, (), waiting, (), ())
    expected = on_time.step(stamp + 1, (), (), (), ())
    assert late.status()["late"] == 41
    np.testing.assert_allclose(odometry.position, expected.position, atol=1e-12)
    np.testing.assert_allclose(odometry.nu, expected.nu, atol=1e-12)
    np.testing.assert_allclose(odometry.pose_covariance, expected.pose_covariance, atol=1e-15)
    assert late.status() == {**on_time.status(), "late": late.status()["late"]}


def test_the_same_samples_give_the_same_estimate():
    first, second = (run(Rig(VEHICLE, SWIMMING, 3), 5.0)[1][-1] for _ in range(2))
    for ours, theirs in zip(vars(first).values(), vars(second).values(), strict=True):
        np.testing.assert_array_equal(ours, theirs)


def test_outliers_are_rejected_and_counted():
    navigation = NavigationFilter(VEHICLE, start_of(RESTING))
    for k, (stamp, imu, dvl, pressure, gps) in enumerate(Rig(VEHICLE, RESTING).frames(20.0)):
        if k > 100 and k % 10 == 0:
            dvl = [replace(sample, velocity=sample.velocity + 3.0) for sample in dvl]
        odometry = navigation.step(stamp, imu, dvl, pressure, gps)
    assert navigation.status()["dvl_gated"] > 10
    assert np.abs(odometry.nu[:3]).max() < 5e-3
    assert np.abs(pose_error(RESTING, odometry)[:2]).max() < 0.05


def test_a_start_that_was_wrong_is_found_out():
    """The vehicle begins at another speed than the filter is told: only the DVL knows."""
    config = start_of(RESTING, initial_velocity_std_m_s=1e-3)
    navigation = NavigationFilter(VEHICLE, config)
    moved = np.array([0.3, 0.0, 0.0])
    for stamp, imu, dvl, pressure, gps in Rig(VEHICLE, RESTING).frames(20.0):
        dvl = [replace(sample, velocity=sample.velocity + moved) for sample in dvl]
        odometry = navigation.step(stamp, imu, dvl, pressure, gps)
    assert navigation.status()["corrected"] == 1
    np.testing.assert_allclose(odometry.nu[:3], moved, atol=0.02)


def test_without_an_imu_sample_there_is_no_estimate():
    _, _, dvl, pressure, gps = next(Rig(VEHICLE, RESTING).frames(0.0))
    with pytest.raises(NotAlignedError) as caught:
        NavigationFilter(VEHICLE, start_of(RESTING)).step(0, (), dvl, pressure, gps)
    assert str(caught.value) == "navigation has had no IMU sample yet; it needs an attitude"


def test_samples_before_the_first_imu_sample_are_ignored():
    frames = list(Rig(VEHICLE, RESTING).frames(1.0))
    imu = [sample for frame in frames for sample in frame[1] if sample.stamp > to_nanoseconds(0.5)]
    dvl = [sample for frame in frames for sample in frame[2]]
    navigation = NavigationFilter(VEHICLE, start_of(RESTING))
    navigation.step(frames[-1][0], imu, dvl, (), ())
    assert navigation.status()["dvl_accepted"] == sum(s.stamp >= imu[0].stamp for s in dvl)
