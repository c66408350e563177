"""What the filter makes of sensors that lie, fall silent or jump, at half a metre a second."""

from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from sensor_truth import Motion, Rig, Waves

from uvms_core.signals import to_seconds
from uvms_core.vehicle import load_vehicle
from uvms_observer import NavigationConfig, NavigationFilter
from uvms_observer.navigation.sensor_health import Health

VEHICLE = load_vehicle()
TURNING = Waves((0.02, -0.03, 0.2), amplitude=(0.03, 0.02, 0.4), period_s=(9.0, 13.0, 50.0))
CRUISE = Motion(Waves((0, 0, 10), (0.45, 0.1, 0), (3.0, 2.0, 0.5), (60.0, 45.0, 40.0)), TURNING)
DIVE = Motion(Waves((0, 0, 10), (0.4, 0.1, 0.2), (1.0, 2.0, 0.2), (60.0, 45.0, 40.0)), TURNING)
BEGIN, END = 15.0, 60.0


@dataclass
class Fault:
    """What is done to the samples of one sensor for `seconds` from BEGIN on.

    Args:
        change: a sample in, a sample out, or None where it is lost.
        bound: m, of the position's error from then on.
        health: of the sensor at the end of the fault.
    """

    sensor: str
    change: object
    seconds: float = np.inf
    bound: float = 0.1
    health: Health = Health.EXCLUDED
    motion: Motion = field(default=CRUISE)

    def spoil(self, samples):
        """The samples of one tick as the filter gets them."""
        for sample in samples:
            hit = BEGIN <= to_seconds(sample.stamp) < BEGIN + self.seconds
            sample = self.change(sample) if hit else sample
            if sample is not None:
                yield sample


def reads(**values):
    return lambda sample: replace(sample, **values)


def off(name, by):
    return lambda sample: replace(sample, **{name: getattr(sample, name) + by})


def turned(degrees):
    turn = Rotation.from_euler("z", degrees, degrees=True)
    return lambda sample: replace(
        sample, quaternion=(turn * Rotation.from_quat(sample.quaternion)).as_quat()
    )


def spikes(share, rate, force):
    """Some samples are off by a lot: white, of this std."""
    rng = np.random.default_rng(5)

    def change(sample):
        if rng.uniform() > share:
            return sample
        return replace(
            sample,
            angular_velocity=sample.angular_velocity + rate * rng.standard_normal(3),
            linear_acceleration=sample.linear_acceleration + force * rng.standard_normal(3),
        )

    return change


def dvl(change, seconds, **rest):
    return Fault("dvl", change, seconds, **rest)


def imu(change, seconds=np.inf, **rest):
    return Fault("imu", change, seconds, **{"health": Health.GOOD, **rest})


def rate(x, y, z):
    return off("angular_velocity", np.radians([x, y, z]))


def force(x, y, z):
    return off("linear_acceleration", np.array([x, y, z]))


ONE = 0.005
STUCK = VEHICLE.environment.atmospheric_pressure_pa + 105_000.0
FAULTS = {
    "dvl reads zero, 6 s": dvl(reads(velocity=np.zeros(3)), 6.0),
    "dvl reads zero, 15 s": dvl(reads(velocity=np.zeros(3)), 15.0),
    "dvl reads its error code": dvl(reads(velocity=np.full(3, -32.768)), 30.0, bound=0.3),
    "dvl off by 5 cm/s": dvl(off("velocity", np.array([0.05, 0.0, 0.0])), 10.0),
    "dvl has water lock in a current": dvl(off("velocity", np.array([0.16, 0.15, 0.0])), 15.0),
    "dvl is silent": dvl(lambda sample: None, 20.0, health=Health.LOST),
    "pressure at the surface": Fault("pressure", reads(pressure=101_325.0), 20.0),
    "pressure is stuck in a dive": Fault("pressure", reads(pressure=STUCK), 20.0, motion=DIVE),
    "compass off by 30 deg": imu(turned(30.0), 20.0, health=Health.EXCLUDED),
    "compass steps by 20 deg": imu(turned(20.0), health=Health.EXCLUDED),
    "gyro steps by 0.1 deg/s": imu(rate(0, 0, 0.1)),
    "gyro steps by 1 deg/s": imu(rate(0, 0, 1.0)),
    "gyro steps by 3 deg/s in roll": imu(rate(3.0, 0, 0)),
    "accelerometer steps by 5 cm/s2": imu(force(0.05, 0, 0)),
    "accelerometer steps by 0.3 m/s2": imu(force(0, 0.3, 0)),
    "accelerometer spikes by 5 m/s2": imu(force(5.0, 0, 0), ONE),
    "accelerometer spikes by 1000 m/s2": imu(force(1000.0, 0, 0), ONE),
    "imu is silent for 1 s": imu(lambda sample: None, 1.0),
    "imu is silent for 5 s": imu(lambda sample: None, 5.0, health=Health.LOST),
    "5 % of the imu's samples are spikes": imu(spikes(0.05, 1.0, 10.0)),
    "5 % of the imu's samples are small spikes": imu(spikes(0.05, 0.05, 0.3)),
    "quaternions are rounded": imu(lambda s: replace(s, quaternion=1.002 * s.quaternion)),
}


@dataclass
class Outcome:
    """Errors (k,) m of the position, in units of their own covariance, and the filter."""

    errors: np.ndarray
    distances: np.ndarray
    health: Health
    navigation: NavigationFilter


def outcome_of(fault, seed=1):
    rig = Rig(VEHICLE, fault.motion, seed)
    start = tuple(map(float, fault.motion.position(0.0)))
    navigation = NavigationFilter(VEHICLE, NavigationConfig(initial_position_m=start))
    errors, distances, health = [], [], Health.GOOD
    for stamp, *samples in rig.frames(END):
        groups = dict(zip(("imu", "dvl", "pressure", "gps"), samples, strict=True))
        groups[fault.sensor] = list(fault.spoil(groups[fault.sensor]))
        odometry, _ = navigation.step_screened(stamp, groups)
        error = fault.motion.position(to_seconds(stamp)) - odometry.position
        errors.append(np.linalg.norm(error))
        spread = np.linalg.solve(odometry.pose_covariance[:3, :3], error)
        distances.append(np.sqrt(error @ spread))
        if to_seconds(stamp) < BEGIN + fault.seconds:
            health = navigation.health()[fault.sensor]
    return Outcome(np.array(errors), np.array(distances), health, navigation)


@pytest.mark.parametrize("name", FAULTS)
def test_the_estimate_stays_right_and_says_how_right(name):
    """Within 3.76 sigma, 99.9 % of a right filter's errors in space, in 99 % of the ticks."""
    fault = FAULTS[name]
    outcome = outcome_of(fault)
    assert outcome.errors.max() < fault.bound
    assert (outcome.distances < 3.76).mean() > 0.99
    if fault.seconds > 1.0:
        assert outcome.health is fault.health
    P = outcome.navigation.state.covariance
    np.testing.assert_array_equal(P, P.T)
    assert np.linalg.eigvalsh(P).min() > -1e-12


def test_a_sensor_that_is_good_again_is_used_again():
    outcome = outcome_of(FAULTS["dvl reads zero, 6 s"])
    assert outcome.navigation.health()["dvl"] is Health.GOOD
    assert outcome.navigation.status()["dvl_gated"] < 60


def test_what_is_held_back_is_counted():
    status = outcome_of(FAULTS["accelerometer spikes by 5 m/s2"]).navigation.status()
    assert status["imu_held_back"] == 1


def test_trouble_names_the_sensors_that_are_not_used():
    rig = Rig(VEHICLE, CRUISE)
    navigation = NavigationFilter(VEHICLE, NavigationConfig(initial_position_m=(0, 0, 10)))
    assert navigation.trouble() is None
    for stamp, imu_samples, dvl_samples, _, gps in rig.frames(4.0):
        lies = [replace(sample, velocity=sample.velocity + 1.0) for sample in dvl_samples]
        navigation.step(stamp, imu_samples, lies if stamp > 1e9 else dvl_samples, (), gps)
    assert navigation.trouble().text == (
        "excluded, since their samples do not fit: dvl; no samples: pressure"
    )


def test_dvl_samples_that_come_late_cost_and_keep_no_more_than_their_latency():
    """Every step stays in memory once, and only as long as a trial may need it."""
    rig = Rig(VEHICLE, CRUISE)
    navigation = NavigationFilter(VEHICLE, NavigationConfig(initial_position_m=(0, 0, 10)))
    waiting = []
    for stamp, imu_samples, dvl_samples, pressure, gps in rig.frames(20.0):
        waiting += dvl_samples
        due = [sample for sample in waiting if sample.stamp <= stamp - 200_000_000]
        waiting = waiting[len(due) :]
        navigation.step(stamp, imu_samples, due, pressure, gps)
    assert navigation.status()["late"] > 100
    assert len(navigation._steps) < 110
    assert max(len(step.readings) for step in navigation._steps) < 12
