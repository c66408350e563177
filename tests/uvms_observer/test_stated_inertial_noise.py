"""What an inertial unit's messages say of the noise of its rates and forces counts."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import chi2
from sensor_truth import Motion, Rig, Waves

from uvms_core.vehicle import load_vehicle
from uvms_observer import NavigationConfig, NavigationFilter

NOISY = {  # the noise counts, not the biases, and the unit, not the compass
    "sensors.imu.gyro_noise_deg_s": 0.05,
    "sensors.imu.gyro_bias_deg_s": 1e-4,
    "sensors.imu.accelerometer_noise_m_s2": 0.05,
    "sensors.imu.accelerometer_bias_m_s2": 1e-4,
    "sensors.imu.roll_pitch_noise_deg": 0.1,
    "sensors.imu.heading_noise_deg": 0.1,
    "sensors.imu.roll_pitch_bias_deg": 1e-3,
    "sensors.imu.heading_bias_deg": 1e-3,
}
VEHICLE = load_vehicle(overrides=NOISY)
RATE, FORCE = np.square(np.radians(0.05)), np.square(0.05)  # variances of the noise
TIMES = 3.0
REAL = load_vehicle(
    overrides={
        **NOISY,
        "sensors.imu.gyro_noise_deg_s": TIMES * 0.05,
        "sensors.imu.accelerometer_noise_m_s2": TIMES * 0.05,
    }
)
"""The same vehicle, whose unit is noisier than its file says."""
RESTING = Motion(Waves((0.0, 0.0, 5.0)), Waves((0.02, -0.01, 0.8)))
SPEED = 1e-3  # std of the velocity at the start, m/s
SECONDS, SEEDS = 10.0, 12


def says(rate, force):
    """Lets samples state these variances, along all axes or (3,)."""
    stated = {
        "angular_velocity_covariance": np.eye(3) * rate,
        "linear_acceleration_covariance": np.eye(3) * force,
    }
    return lambda sample: replace(sample, **stated)


def silent(sample):
    return sample


HONEST = says(TIMES**2 * RATE, TIMES**2 * FORCE)


def run(change, vehicle=REAL, seed=0, seconds=SECONDS):
    """The filter of VEHICLE on a unit of `vehicle`, dead reckoning, and its last odometry."""
    rng = np.random.default_rng([seed, 3])
    start = RESTING.position(0.0) + 0.01 * rng.standard_normal(3)
    config = NavigationConfig(
        initial_position_m=tuple(map(float, start)),
        initial_velocity_m_s=tuple(map(float, SPEED * rng.standard_normal(3))),
        initial_velocity_std_m_s=SPEED,
    )
    navigation = NavigationFilter(VEHICLE, config)
    for stamp, imu, *rest in Rig(vehicle, RESTING, seed).frames(seconds, silent=("dvl", "gps")):
        odometry = navigation.step(stamp, [change(sample) for sample in imu], *rest)
    return navigation, odometry


def distances(odometry):
    """Squared, of velocity and attitude, 3 degrees of freedom each."""
    turn = RESTING.rotation(SECONDS) * Rotation.from_quat(odometry.quaternion).inv()
    velocity, attitude = odometry.twist_covariance[:3, :3], odometry.pose_covariance[3:, 3:]
    errors = (-odometry.nu[:3], velocity), (turn.as_rotvec(), attitude)
    return np.array([error @ np.linalg.solve(P, error) for error, P in errors])


def test_a_noisier_unit_that_says_so_is_consistent_and_one_that_does_not_is_not():
    low, high = chi2.ppf([0.0005, 0.9995], 3 * SEEDS)
    honest = [run(HONEST, seed=seed) for seed in range(SEEDS)]
    total = sum(distances(odometry) for _, odometry in honest)
    assert (low < total).all()
    assert (total < high).all()
    assert sum(navigation.status()["imu_held_back"] for navigation, _ in honest) == 0
    quiet = [run(silent, seed=seed) for seed in range(SEEDS)]
    assert (sum(distances(odometry) for _, odometry in quiet) > high).all()


def spread(navigation):
    """Variances of velocity and attitude."""
    return navigation.state.covariance.diagonal()[3:9]


def test_the_noise_follows_what_is_said_sample_by_sample():
    def in_turn(sample):
        return says(*(18.0 * np.array([RATE, FORCE])))(sample) if odd(sample) else sample

    always = spread(run(says(9.5 * RATE, 9.5 * FORCE), VEHICLE)[0])
    turns, never = spread(run(in_turn, VEHICLE)[0]), spread(run(silent, VEHICLE)[0])
    np.testing.assert_allclose(turns, always, rtol=0.02)
    assert (turns > 2.0 * never).all()


def odd(sample):
    return round(100.0e-9 * sample.stamp) % 2


def test_each_axis_counts_for_itself():
    """A gyro that is poor about z alone leaves the heading uncertain, not the tilt."""
    poor = says(np.array([0.0, 0.0, 100.0 * RATE]), 0.0)
    roll, pitch, heading = (spread(run(poor)[0]) / spread(run(silent)[0]))[3:]
    assert heading > 5.0
    assert max(roll, pitch) < 1.1


def test_the_odometry_has_the_noise_of_the_rate():
    found = [run(each, VEHICLE, seconds=0.5)[1].twist_covariance for each in (HONEST, silent)]
    grown = (found[0] - found[1]).diagonal()[3:]
    np.testing.assert_allclose(grown, (TIMES**2 - 1.0) * RATE, rtol=0.01)


@pytest.mark.parametrize(
    "stated", [(0.0, 0.0), (0.25 * RATE, 0.25 * FORCE), (-RATE, -FORCE)], ids=str
)
def test_what_the_vehicle_file_knows_changes_nothing(stated):
    """Nor does what is no covariance; the vehicle file is the floor."""
    plain, other = (run(each, VEHICLE, seconds=2.0)[1] for each in (silent, says(*stated)))
    np.testing.assert_array_equal(plain.position, other.position)
    np.testing.assert_array_equal(plain.pose_covariance, other.pose_covariance)
    np.testing.assert_array_equal(plain.twist_covariance, other.twist_covariance)
