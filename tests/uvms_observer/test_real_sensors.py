"""The filter on vehicles with other sensors than the reference vehicle's, each by its physics."""

from dataclasses import fields, replace

import navigation_reference as numpy_reference
import numpy as np
import pytest
from nav_states import minus, numeric_jacobian, random_state
from scipy.spatial.transform import Rotation
from sensor_truth import Motion, Rig, Waves

from uvms_core.errors import ConfigError, SignalError
from uvms_core.sensors.depth import DepthSample
from uvms_core.sensors.heading import HeadingSample
from uvms_core.sensors.magnetometer import MICROTESLA, MagneticSample
from uvms_core.signals import DvlSample, ImuSample, PressureSample, to_nanoseconds
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.simulation.sensors import SensorSuite, Trajectory
from uvms_observer.errors import NotAlignedError
from uvms_observer.navigation import NavigationConfig, NavigationFilter
from uvms_observer.navigation.measurements import course, imu, noise
from uvms_observer.navigation.measurements.dvl import DvlVelocity
from uvms_observer.navigation.measurements.pressure import PressureDepth
from uvms_observer.navigation.state import COMPASS_BIAS

EARTH = np.array([17.0, 3.0, 45.0])  # microtesla, mid latitudes
PLACE = {"rate_hz": 10.0, "position_m": [0.1, 0.0, 0.2]}
HEADING = {**PLACE, "noise_deg": 1.0, "bias_deg": 1.0}
MAGNETOMETER = {**PLACE, "noise_ut": 0.2, "bias_ut": 0.2}
NONE = np.zeros((3, 3))
LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
G = 9.80665
OPEN = float("inf")


@pytest.mark.parametrize("biased", [True, False])
@pytest.mark.parametrize("kind", ["heading", "magnetic"])
@pytest.mark.parametrize("seed", range(3))
def test_derivative_of_a_heading(kind, biased, seed):
    state = random_state(seed)
    state.compass_bias[:] = 0.0
    R = Rotation.from_quat(state.quaternion)
    heading, field = R.as_euler("ZYX")[0], R.inv().apply(EARTH)

    def residual(each):
        if kind == "heading":
            return course.heading(each, heading, biased)
        return course.magnetic(each, field, EARTH, biased)

    zero, H = residual(state)
    np.testing.assert_allclose(zero, 0.0, atol=1e-12)
    numeric = numeric_jacobian(lambda e: -residual(numpy_reference.plus(state, e))[0])
    np.testing.assert_allclose(H, numeric, atol=1e-8)
    assert (H[0, COMPASS_BIAS.start + 2] != 0.0) == biased


@pytest.mark.parametrize("seed", range(3))
def test_derivative_of_the_specific_force_at_rest(seed):
    state = random_state(seed)
    reading, H = imu.specific_force(state, G)
    up = Rotation.from_quat(state.quaternion).inv().apply([0.0, 0.0, -G])
    np.testing.assert_allclose(reading, up + state.accelerometer_bias, atol=1e-12)
    numeric = numeric_jacobian(lambda e: imu.specific_force(numpy_reference.plus(state, e), G)[0])
    np.testing.assert_allclose(H, numeric, atol=1e-7)


MOTION = Motion(
    Waves((0, 0, 10), (0.3, 0.1, 0), (2.0, 1.0, 0.3), (60.0, 45.0, 40.0)),
    Waves((0.02, -0.03, 0.2), amplitude=(0.03, 0.02, 0.4), period_s=(9.0, 13.0, 50.0)),
)
SECONDS = 40.0
MEMS = {
    "sensors.imu.orientation": False,
    "sensors.imu.gyro_noise_deg_s": 0.05,
    "sensors.imu.gyro_bias_deg_s": 0.02,
    "sensors.imu.accelerometer_noise_m_s2": 0.02,
    "sensors.imu.accelerometer_bias_m_s2": 0.02,
}


class Run:
    """A filter along `MOTION` with the sensors that a vehicle has; keeps what it estimates."""

    def __init__(self, overrides, seed=4):
        whole = load_vehicle(overrides={**overrides, **ALL_THERE})
        self.vehicle = load_vehicle(overrides=overrides)
        self.rig, self.rng = Rig(whole, MOTION, seed), np.random.default_rng(seed)
        start = tuple(map(float, MOTION.position(0.0)))
        self.filter = NavigationFilter(self.vehicle, NavigationConfig(initial_position_m=start))
        self.found = []
        self.compass = self.rng.standard_normal(4)

    def series(self, name, section):
        t = np.arange(round(SECONDS * section.rate_hz) + 1) / section.rate_hz
        if name == "imu":
            oriented = section.orientation
            samples = self.rig.imu(t)
            if oriented:
                return samples
            return [replace(each, quaternion=LEVEL, oriented=False) for each in samples]
        return getattr(self, name)(t) if hasattr(self, name) else getattr(self.rig, name)(t)

    def heading(self, t):
        section = self.vehicle.sensors.mounted["heading"]
        noise = section.noise_deg * self.rng.standard_normal(len(t))
        errors = np.radians(section.bias_deg * self.compass[0] + noise)
        turned = Rotation.from_rotvec(np.outer(errors, [0, 0, 1])) * MOTION.rotation(t)
        rows = zip(t, turned.as_quat(), strict=True)
        return [HeadingSample(to_nanoseconds(s), q, NONE) for s, q in rows]

    def magnetometer(self, t):
        section = self.vehicle.sensors.mounted["magnetometer"]
        fields = MOTION.rotation(t).inv().apply(EARTH) + section.bias_ut * self.compass[1:]
        fields = fields + section.noise_ut * self.rng.standard_normal((len(t), 3))
        rows = zip(t, MICROTESLA * fields, strict=True)
        return [MagneticSample(to_nanoseconds(s), field, NONE) for s, field in rows]

    def depth(self, t):
        section = self.vehicle.sensors.mounted["depth"]
        depths = MOTION.place(t, section.position_m)[:, 2]
        depths = depths + section.noise_m * self.rng.standard_normal(len(t))
        rows = zip(t, depths, strict=True)
        return [DepthSample(to_nanoseconds(s), float(depth), 0.0) for s, depth in rows]

    def dvl_aft(self, t):
        section = self.vehicle.sensors.mounted["dvl_aft"]
        read = 1.005 * MOTION.velocity(t, section.position_m)
        read = read + section.noise_m_s * self.rng.standard_normal((len(t), 3))
        return [DvlSample(to_nanoseconds(s), v, NONE) for s, v in zip(t, read, strict=True)]

    def go(self):
        series = {n: self.series(n, s) for n, s in self.vehicle.sensors.mounted.items()}
        for k in range(1, round(SECONDS / 0.05) + 1):
            stamp, taken = to_nanoseconds(k * 0.05), {}
            for name, samples in series.items():
                count = sum(1 for each in samples[:64] if each.stamp <= stamp)
                taken[name], series[name] = samples[:count], samples[count:]
            odometry, faults = self.filter.step_screened(stamp, taken)
            assert not faults
            self.found.append(odometry)
        return self

    def largest(self):
        """Largest distance of position and of attitude from the truth in std, after 1 s."""
        return np.max([self._distances(each) for each in self.found[20:]], axis=0)

    def _distances(self, odometry):
        t, P = odometry.stamp * 1e-9, odometry.pose_covariance
        place = MOTION.position(t) - odometry.position
        turn = MOTION.rotation(t) * Rotation.from_quat(odometry.quaternion).inv()
        pair = (place, P[:3, :3]), (turn.as_rotvec(), P[3:, 3:])
        return [np.sqrt(e @ np.linalg.solve(Q, e)) for e, Q in pair]


ALL_THERE = {
    f"sensors.{name}": load_vehicle().sensors.mounted[name].model_dump(exclude_unset=True)
    for name in ("dvl", "pressure", "gps")
}
FIELD = {"environment.magnetic_field_ut": EARTH.tolist()}
GAUGE = {"sensors.depth": {**PLACE, "noise_m": 0.02}}
AFT = {**PLACE, "type": "dvl", "noise_m_s": 0.005, "scale_error": 0.005}
VEHICLES = {
    "no GPS": {"sensors.gps": None},
    "no DVL": {"sensors.dvl": None},
    "no pressure": {"sensors.pressure": None},
    "IMU alone": {"sensors.dvl": None, "sensors.pressure": None, "sensors.gps": None},
    "depth in metres": {"sensors.pressure": None, **GAUGE},
    "two DVLs": {"sensors.dvl_aft": AFT},
    "compass": {**MEMS, "sensors.heading": HEADING},
    "magnetometer": {**MEMS, **FIELD, "sensors.magnetometer": MAGNETOMETER},
    "no attitude, no DVL": {**MEMS, "sensors.dvl": None, "sensors.heading": HEADING},
}


@pytest.mark.parametrize("name", VEHICLES)
def test_estimates_are_right_within_what_they_say(name):
    """A chi of three degrees of freedom is beyond 4.1 in 0.1 per cent of independent samples."""
    run = Run(VEHICLES[name]).go()
    assert (run.largest() < 4.1).all(), run.largest()
    missing = str(run.filter.status().get("not_mounted", ""))
    gone = [kind for kind in ("dvl", "pressure", "gps") if f"sensors.{kind}" in VEHICLES[name]]
    assert missing == ", ".join(gone)


def test_a_second_dvl_carries_on_alone():
    run = Run({"sensors.dvl_aft": AFT})
    run.dvl = lambda t: []
    run.go()
    std = np.sqrt(np.trace(run.found[-1].twist_covariance[:3, :3]))
    assert (run.largest() < 4.1).all()
    assert std < 0.1
    assert run.filter.status()["dvl_aft_accepted"] > 300


def test_without_attitude_and_heading_there_is_no_filter():
    with pytest.raises(ConfigError, match="mount one of type heading or magnetometer"):
        NavigationFilter(load_vehicle(overrides=MEMS), NavigationConfig())


def at_rest(stamp, force, quaternion=LEVEL, oriented=True):
    return ImuSample(stamp, quaternion, np.zeros(3), np.array(force), NONE, NONE, NONE, oriented)


def test_without_attitude_it_waits_for_a_heading():
    vehicle = load_vehicle(overrides={**MEMS, "sensors.heading": HEADING})
    navigation = NavigationFilter(vehicle, NavigationConfig())
    with pytest.raises(NotAlignedError, match="no heading has come yet"):
        navigation.step_screened(0, {"imu": [at_rest(0, [0.0, 0.0, -G], oriented=False)]})
    north = HeadingSample(50_000_000, LEVEL, NONE)
    later = at_rest(50_000_000, [0.0, 0.0, -G], oriented=False)
    odometry, _ = navigation.step_screened(50_000_000, {"imu": [later], "heading": [north]})
    np.testing.assert_allclose(odometry.quaternion, LEVEL, atol=1e-9)


HALF_TURN = np.array([1.0, 0.0, 0.0, 0.0])  # about x
EAST = Rotation.from_euler("z", 90, degrees=True).as_quat()


@pytest.mark.parametrize(
    ("quaternion", "force", "oriented", "advice"),
    [
        (EAST, [0.0, 0.0, G], True, "sensors.imu.axes: flu and sensors.imu.world: enu"),
        (HALF_TURN, [0.0, 0.0, -G], True, "sensors.imu.world: enu"),
        (LEVEL, [0.0, 0.0, G], False, "sensors.imu.axes: flu"),
        (LEVEL, [0.0, 0.0, -1.0], True, "in m/s^2 (not in g"),
        (LEVEL, [0.0, 0.0, 0.0], True, "gravity not taken off"),
        (LEVEL, [G, 0.0, 0.0], True, "rpy_deg"),
    ],
)
def test_an_imu_that_feels_gravity_the_wrong_way_is_refused_with_advice(
    quaternion, force, oriented, advice
):
    navigation = NavigationFilter(load_vehicle(), NavigationConfig())
    with pytest.raises(NotAlignedError) as caught:
        navigation.step_screened(0, {"imu": [at_rest(0, force, quaternion, oriented)]})
    assert advice in str(caught.value)
    with pytest.raises(SignalError):
        navigation.step(0, [at_rest(0, force, quaternion, oriented)])


def test_a_message_adds_to_the_noise_and_never_takes_from_it():
    white, known = np.array([1.0, 1.0, 4.0]), [2.0, 2.0, 5.0]
    for stated, expected in ((0.0, white), (2.0, white), (6.0, [5.0, 5.0, 5.0])):
        found = noise.with_stated(white, stated * np.eye(3), known)
        np.testing.assert_array_equal(found, expected)


def moved(measurement, sample, states):
    """By how much a sample moves a state, the norm of the error state's change."""
    state = random_state(1)
    before = state.copied()
    measurement.correct(state, sample, np.zeros(3), OPEN)
    return np.linalg.norm(minus(state, before)[states])


def test_a_sample_that_says_that_it_is_poor_moves_less():
    vehicle, config = load_vehicle(), NavigationConfig()
    dvl = DvlVelocity(vehicle, vehicle.sensors.dvl, config)
    velocity = np.array([0.5, 0.0, 0.0])
    stated = [moved(dvl, DvlSample(0, velocity, C), slice(3, 6)) for C in (NONE, np.eye(3))]
    assert stated[1] < 0.5 * stated[0]
    pressure = PressureDepth(vehicle, vehicle.sensors.pressure, config)
    stated = [moved(pressure, PressureSample(0, 2e5, v), slice(2, 3)) for v in (0.0, 1e12)]
    assert stated[1] < 0.5 * stated[0]


def simulated(vehicle, seconds=2.0):
    """Samples of a vehicle's simulated sensors, level and at rest, its antenna in the air."""
    state, count = np.zeros(13), round(100 * seconds) + 1
    state[2], state[6] = 0.1, 1.0
    stamps = tuple(range(0, count * 10_000_000, 10_000_000))
    trajectory = Trajectory(stamps, np.tile(state, (count, 1)), np.zeros((count, 13)), np.zeros(3))
    suite = SensorSuite(vehicle, 3, lambda period, name: None)
    return stamps[-1], suite.sample(trajectory, *np.zeros((3, vehicle.n_joints))).samples


@pytest.mark.parametrize("name", ["reference_auv", "bluerov2_alpha5"])
def test_what_the_simulation_states_is_what_the_vehicle_file_knows(name):
    """So its covariances change nothing, to the last bit."""
    vehicle = load_vehicle(name)
    stamp, samples = simulated(vehicle)
    silent = {each: [without_covariance(one) for one in samples[each]] for each in samples}
    found = [
        NavigationFilter(vehicle, NavigationConfig()).step_screened(stamp, each)[0]
        for each in (samples, silent)
    ]
    assert all(samples.values())
    for field in ("position", "quaternion", "nu", "pose_covariance", "twist_covariance"):
        np.testing.assert_array_equal(*(getattr(each, field) for each in found))


def without_covariance(sample):
    names = [field.name for field in fields(sample)]
    stated = {name: NONE for name in names if "covariance" in name}
    return replace(sample, **stated, **({"variance": 0.0} if "variance" in names else {}))
