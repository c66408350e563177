"""What can be done to the navigation's sensors at half a metre a second, and what comes of it.

The tests judge it, and `benchmarks/navigation_table.py` prints it.
"""

from dataclasses import dataclass, field, replace

import numpy as np
from hull_truth import TICK
from scipy.spatial.transform import Rotation
from sensor_truth import Motion, Rig, Waves

from uvms_core.signals import to_nanoseconds, to_seconds
from uvms_core.vehicle import load_vehicle
from uvms_observer import NavigationConfig, NavigationFilter
from uvms_observer.navigation.trust.sensor_health import Health

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
    begin: float = BEGIN

    def spoil(self, samples):
        """The samples of one tick as the filter gets them."""
        for sample in samples:
            hit = self.begin <= to_seconds(sample.stamp) < self.begin + self.seconds
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


def yawed(degrees):
    turn = Rotation.from_euler("z", degrees, degrees=True)
    return lambda sample: replace(sample, velocity=turn.apply(sample.velocity))


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
    "accelerometer steps by 2 m/s2": imu(force(0, 2.0, 0), bound=1.0),
    "gyro steps by 10 deg/s": imu(rate(0, 0, 10.0)),
    "dvl is mounted 1 deg off": Fault("dvl", yawed(1.0), bound=1.0, health=Health.GOOD, begin=0.0),
    "imu is silent for 1 s": imu(lambda sample: None, 1.0),
    "imu is silent for 5 s": imu(lambda sample: None, 5.0, health=Health.LOST),
    "5 % of the imu's samples are spikes": imu(spikes(0.05, 1.0, 10.0)),
    "5 % of the imu's samples are small spikes": imu(spikes(0.05, 0.05, 0.3)),
    "quaternions are rounded": imu(lambda s: replace(s, quaternion=1.002 * s.quaternion)),
}


@dataclass
class Outcome:
    """Of the position, (k,): errors in m and in sigma, jumps in sigma; and the filter.

    A jump is by how much the error changes from one tick to the next.
    """

    errors: np.ndarray
    distances: np.ndarray
    jumps: np.ndarray
    health: Health
    navigation: NavigationFilter


def outcome_of(fault, seed=1, vehicle=VEHICLE, motion=None, thrusts=None):
    """A run of a minute; on another motion than the fault's where one is given.

    thrusts: as of `hull_truth`, of the same motion; None: nobody tells them.
    """
    motion = motion or fault.motion
    rig = Rig(vehicle, motion, seed)
    start = tuple(map(float, motion.position(0.0)))
    navigation = NavigationFilter(vehicle, NavigationConfig(initial_position_m=start))
    errors, distances, jumps, health, last = [], [], [], Health.GOOD, None
    for stamp, *samples in rig.frames(END):
        groups = dict(zip(("imu", "dvl", "pressure", "gps"), samples, strict=True))
        groups[fault.sensor] = list(fault.spoil(groups[fault.sensor]))
        if thrusts is not None and stamp:
            navigation.inform(thrusts.allocation(stamp - to_nanoseconds(TICK)))
        odometry, _ = navigation.step_screened(stamp, groups)
        error = motion.position(to_seconds(stamp)) - odometry.position
        errors.append(np.linalg.norm(error))
        spread = np.linalg.solve(odometry.pose_covariance[:3, :3], error)
        distances.append(np.sqrt(error @ spread))
        if last is not None:
            change, covariance = error - last[0], last[1]
            jumps.append(np.sqrt(change @ np.linalg.solve(covariance, change)))
        last = error, odometry.pose_covariance[:3, :3]
        if to_seconds(stamp) < fault.begin + fault.seconds:
            health = navigation.health()[fault.sensor]
    return Outcome(np.array(errors), np.array(distances), np.array(jumps), health, navigation)
