"""Errors of sensors beyond noise and bias: their statistics, geometry, and when samples come."""

import numpy as np
import pytest
from random_vehicles import REFERENCE
from scipy.stats import binom

from uvms_core.geodesy import geodetic_to_ned
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.kernels.rotations import quat_to_rotation_vector, quat_to_rpy, rpy_to_quat
from uvms_dynamics.simulation.sensors import SensorSuite
from uvms_dynamics.simulation.sensors.dvl import DvlSensor
from uvms_dynamics.simulation.sensors.encoders import EncoderSensor
from uvms_dynamics.simulation.sensors.error_model import Errors, misalignment
from uvms_dynamics.simulation.sensors.gps import GpsSensor
from uvms_dynamics.simulation.sensors.imu import ImuSensor
from uvms_dynamics.simulation.sensors.mounting import Trajectory
from uvms_dynamics.simulation.sensors.pressure import PressureSensor

PERIOD = 10_000_000  # ns
MODELS = {"imu": ImuSensor, "dvl": DvlSensor, "pressure": PressureSensor, "gps": GpsSensor}


def exact(**overrides):
    """The reference vehicle, whose sensors have no errors but these, `a__b` for `a.b`."""
    found = {}
    for name, sensor in REFERENCE.sensors:
        for field in type(sensor).model_fields:
            wrong = "noise" in field or "bias" in field or "scale_error" in field
            if (wrong or field == "resolution_deg") and field != "bias_time_constant_s":
                found[f"sensors.{name}.{field}"] = 0.0
    own = {path.replace("__", "."): value for path, value in overrides.items()}
    return load_vehicle(overrides=found | own)


def at_rest(count, depth=10.0, rpy=(0.0, 0.0, 0.0), nu=(0.0,) * 6, period=PERIOD):
    state = np.zeros(13)
    state[2], state[3:7], state[7:13] = depth, rpy_to_quat(*rpy), nu
    stamps = tuple(range(period, (count + 1) * period, period))
    return Trajectory(stamps, np.tile(state, (count, 1)), np.zeros((count, 13)), np.zeros(3))


def sampled(vehicle, name, trajectory, seed=1, period=PERIOD):
    model = MODELS[name](vehicle, getattr(vehicle.sensors, name), period, seed)
    return model.sample(trajectory)


def walk_increments(values, lag):
    """Std of the change over `lag` samples, each lag once."""
    return np.std(values[lag::lag] - values[:-lag:lag], axis=0)


@pytest.mark.parametrize(
    ("name", "field", "size", "read"),
    [
        ("imu", "gyro_random_walk_deg_s", 0.01, lambda s: np.degrees(s.angular_velocity)),
        ("imu", "accelerometer_random_walk_m_s2", 0.01, lambda s: s.linear_acceleration),
        (
            "imu",
            "attitude_random_walk_deg",
            0.05,
            lambda s: np.degrees(quat_to_rotation_vector(s.quaternion)),
        ),
        ("dvl", "random_walk_m_s", 0.002, lambda s: s.velocity),
        ("pressure", "random_walk_pa", 20.0, lambda s: np.array([s.pressure])),
    ],
)
def test_a_random_walk_grows_with_the_root_of_time(name, field, size, read):
    """The change over t s has the std size sqrt(t): its Allan deviation rises by 1/2 a decade."""
    vehicle = exact(**{f"sensors__{name}__{field}": size})
    values = np.array([read(s) for s in sampled(vehicle, name, at_rest(40_000))])
    for lag in (10, 100):
        expected = size * np.sqrt(lag * 0.01)
        np.testing.assert_allclose(walk_increments(values, lag), expected, rtol=0.15)


def test_the_walk_of_gps_has_its_size_by_axis():
    vehicle = exact(
        sensors__gps__horizontal_random_walk_m=0.1, sensors__gps__vertical_random_walk_m=0.3
    )
    samples = sampled(vehicle, "gps", at_rest(4_000, depth=-1.0))
    datum = vehicle.environment.datum_latitude_deg, vehicle.environment.datum_longitude_deg
    place = np.array(
        [geodetic_to_ned(s.latitude_deg, s.longitude_deg, s.altitude, *datum) for s in samples]
    )
    std = np.std(np.diff(place, axis=0), axis=0) / np.sqrt(0.01)
    np.testing.assert_allclose(std, [0.1, 0.1, 0.3], rtol=0.05)


@pytest.mark.parametrize(
    ("name", "field", "size", "read"),
    [
        ("dvl", "bias_m_s", 0.1, lambda s: s.velocity),
        ("pressure", "scale_error", 0.01, lambda s: np.array([s.pressure / 199_500.0 - 1.0])),
        ("imu", "gyro_scale_error", 0.02, lambda s: s.angular_velocity / 0.3 - 1.0),
    ],
)
def test_constant_errors_are_drawn_from_their_std_once_a_run(name, field, size, read):
    vehicle = exact(**{f"sensors__{name}__{field}": size})
    sea = vehicle.environment
    surface = sea.atmospheric_pressure_pa
    trajectory = at_rest(2, nu=(0, 0, 0, 0.3, 0.3, 0.3))
    drawn = []
    for seed in range(400):
        first, second = (read(s) for s in sampled(vehicle, name, trajectory, seed))
        np.testing.assert_allclose(first, second, atol=1e-12)
        drawn.append(first)
    if name == "pressure":  # about its own mean, which is that of the pressure at rest
        true = surface + sea.water_density_kg_m3 * sea.gravity_m_s2 * 10.0
        drawn = (np.array(drawn) + 1.0) * 199_500.0 / true - 1.0
    if name == "dvl":
        drawn = np.array(drawn) - np.cross([0.3] * 3, vehicle.sensors.dvl.position_m)
    np.testing.assert_allclose(np.std(drawn, axis=0), size, rtol=0.15)
    np.testing.assert_allclose(np.mean(drawn, axis=0), 0.0, atol=4.0 * size / 20.0)


def test_a_misaligned_dvl_sees_the_velocity_in_its_own_axes():
    vehicle = exact(sensors__dvl__misalignment_deg=3.0)
    mount = misalignment(7, "dvl", 3.0)
    (sample,) = sampled(vehicle, "dvl", at_rest(1, nu=(1.0, 0.2, -0.1, 0, 0, 0)), seed=7)
    np.testing.assert_allclose(sample.velocity, mount.T @ [1.0, 0.2, -0.1], atol=1e-12)
    assert np.linalg.norm(sample.velocity) == pytest.approx(np.linalg.norm([1.0, 0.2, -0.1]))
    assert 1e-3 < np.abs(sample.velocity - [1.0, 0.2, -0.1]).max() < 0.2


def test_a_misaligned_unit_turns_attitude_rates_and_gravity_alike():
    vehicle = exact(sensors__imu__misalignment_deg=2.0)
    rpy, mount = (0.2, -0.1, 1.0), misalignment(3, "imu", 2.0)
    nu = (0.0, 0.0, 0.0, 0.1, -0.2, 0.3)
    (sample,) = sampled(vehicle, "imu", at_rest(1, rpy=rpy, nu=nu), seed=3)
    (true,) = sampled(exact(), "imu", at_rest(1, rpy=rpy, nu=nu), seed=3)
    np.testing.assert_allclose(sample.angular_velocity, mount.T @ true.angular_velocity, atol=1e-12)
    np.testing.assert_allclose(
        sample.linear_acceleration, mount.T @ true.linear_acceleration, atol=1e-12
    )
    off = quat_to_rotation_vector(_difference(true.quaternion, sample.quaternion))
    turn = np.arccos(0.5 * (np.trace(mount) - 1.0))
    assert np.linalg.norm(off) == pytest.approx(turn, rel=1e-6)


def _difference(a, b):
    from uvms_dynamics.kernels.rotations import quat_conjugate, quat_multiply

    return quat_multiply(quat_conjugate(a), b)


def test_misalignment_has_its_std_about_each_axis():
    turns = []
    for seed in range(500):
        R = misalignment(seed, "dvl", 1.0)
        turns.append(np.degrees([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / 2.0)
    np.testing.assert_allclose(np.std(turns, axis=0), 1.0, rtol=0.1)


def test_rounded_values_are_multiples_of_the_step_and_the_nearest():
    vehicle = exact(
        sensors__dvl__resolution_m_s=0.01,
        sensors__pressure__resolution_pa=50.0,
        sensors__imu__gyro_resolution_deg_s=0.5,
        sensors__imu__attitude_resolution_deg=0.1,
        sensors__imu__accelerometer_resolution_m_s2=0.02,
    )
    trajectory = at_rest(1, rpy=(0.123, -0.05, 2.0), nu=(0.1234, -0.777, 0.3, 0.01, 0.02, 0.03))
    for name, read, step in (
        ("dvl", lambda s: s.velocity, 0.01),
        ("pressure", lambda s: s.pressure, 50.0),
        ("imu", lambda s: np.degrees(s.angular_velocity), 0.5),
        ("imu", lambda s: np.degrees(quat_to_rpy(s.quaternion)), 0.1),
        ("imu", lambda s: s.linear_acceleration, 0.02),
    ):
        rounded, true = (read(sampled(each, name, trajectory)[0]) for each in (vehicle, exact()))
        np.testing.assert_allclose(rounded / step, np.round(rounded / step), atol=1e-6)
        assert np.max(np.abs(rounded - true)) <= 0.5 * step + 1e-9
        assert np.max(np.abs(rounded - true)) > 0.0


@pytest.mark.parametrize(
    ("name", "field", "size", "read"),
    [
        ("dvl", "outlier_m_s", 5.0, lambda s: s.velocity),
        ("pressure", "outlier_pa", 1e5, lambda s: np.array([s.pressure])),
        ("imu", "gyro_outlier_deg_s", 9.0, lambda s: np.degrees(s.angular_velocity)),
    ],
)
def test_outliers_come_at_their_rate_with_their_size(name, field, size, read):
    fields = {f"sensors__{name}__outlier_rate": 0.02, f"sensors__{name}__{field}": size}
    count = 10_000
    values = np.array([read(s) for s in sampled(exact(**fields), name, at_rest(count))])
    errors = values - np.median(values, axis=0)
    struck = np.abs(errors).max(axis=1) > 1e-9
    low, high = binom.interval(0.9999, count, 0.02)
    assert low <= struck.sum() <= high
    np.testing.assert_allclose(np.std(errors[struck], axis=0), size, rtol=0.2)


def test_encoders_have_a_bias_and_outliers_of_the_angle():
    encoders = exact(
        sensors__encoders__bias_deg=0.5,
        sensors__encoders__outlier_rate=0.05,
        sensors__encoders__outlier_deg=10.0,
    ).sensors.encoders
    sensor, zero = EncoderSensor(encoders, 5), np.zeros(4)
    samples = [sensor.sample(k, zero, zero, zero) for k in range(4000)]
    angles = np.degrees([s.position for s in samples])
    bias = np.median(angles, axis=0)
    assert 0.01 < np.abs(bias).max() < 2.0
    struck = np.abs(angles - bias).max(axis=1) > 1e-9
    low, high = binom.interval(0.9999, 4000, 0.05)
    assert low <= struck.sum() <= high
    assert not np.array([s.velocity for s in samples]).any()


def suite_frames(vehicle, ticks, seed=1):
    """Frames of a vehicle at rest, 50 ms each, after that of t = 0."""
    suite = SensorSuite(vehicle, seed, lambda period, name: None)
    state = np.zeros(13)
    state[2], state[6] = 10.0, 1.0
    zero = np.zeros(4)

    def frame(stamps):
        rows = len(stamps)
        trajectory = Trajectory(
            stamps, np.tile(state, (rows, 1)), np.zeros((rows, 13)), np.zeros(3)
        )
        return stamps[-1], suite.sample(trajectory, zero, zero, zero)

    yield frame((0,))
    for tick in range(ticks):
        begin = 50_000_000 * tick
        yield frame(tuple(range(begin + 5_000_000, begin + 50_000_001, 5_000_000)))


@pytest.mark.parametrize("latency", [0.0, 0.012, 0.1, 0.23])
def test_a_late_sample_keeps_its_stamp_and_comes_at_the_first_tick_after_its_latency(latency):
    vehicle = exact(sensors__dvl__latency_s=latency)
    came = [(now, s.stamp) for now, f in suite_frames(vehicle, 100) for s in f.dvl]
    stamps = [stamp for _, stamp in came]
    assert stamps == list(range(0, stamps[-1] + 1, stamps[1]))  # each once, in order
    for now, stamp in came:
        due = stamp + round(latency * 1e9) if stamp else 0
        assert now == -(-due // 50_000_000) * 50_000_000
    assert len(stamps) >= (100 * 0.05 - latency) * REFERENCE.sensors.dvl.rate_hz - 1


def test_samples_drop_out_at_their_rate_and_never_the_first():
    vehicle = exact(sensors__imu__drop_out_rate=0.1, sensors__pressure__drop_out_rate=1.0)
    frames = [frame for _, frame in suite_frames(vehicle, 1000)]
    came, due = sum(len(frame.imu) for frame in frames), 1 + 5000
    low, high = binom.interval(0.9999, due, 0.9)
    assert low <= came <= high
    assert [s.stamp for frame in frames for s in frame.pressure] == [0]
    assert all(len(next(iter(suite_frames(vehicle, 0, seed)))[1].imu) == 1 for seed in range(20))


def test_one_error_shifts_no_other_random_number():
    """The same noise with and without drop-outs, outliers, walks and rounding of others."""
    plain = [f for _, f in suite_frames(REFERENCE, 40)]
    changed = {
        "sensors.imu.drop_out_rate": 0.5,
        "sensors.imu.latency_s": 0.02,
        "sensors.dvl.outlier_rate": 0.5,
        "sensors.dvl.outlier_m_s": 1.0,
        "sensors.dvl.random_walk_m_s": 0.0,
    }
    other = [f for _, f in suite_frames(load_vehicle(overrides=changed), 40)]
    known = {s.stamp: s for f in plain for s in f.imu}
    for sample in (s for f in other for s in f.imu):
        np.testing.assert_array_equal(sample.angular_velocity, known[sample.stamp].angular_velocity)
    pairs = [
        (a.velocity, b.velocity)
        for f, g in zip(plain, other, strict=True)
        for a, b in zip(f.dvl, g.dvl, strict=True)
    ]
    same = [np.array_equal(a, b) for a, b in pairs]
    assert 0.2 < np.mean(same) < 0.8  # those that no outlier has struck


@pytest.mark.parametrize(
    ("depth", "roll_deg", "comes"),
    [
        (10.0, 0.0, True),
        (35.0, 0.0, True),
        (49.9, 0.0, False),
        (5.0, 0.0, False),
        (30.0, 31.0, False),
    ],
)
def test_a_dvl_loses_the_seabed_by_altitude_and_tilt(depth, roll_deg, comes):
    """Seabed at 50 m, lock from 0.3 to 42 m above it and up to 30 degrees."""
    vehicle = exact(
        environment__seabed_depth_m=50.0,
        sensors__dvl__min_altitude_m=0.3,
        sensors__dvl__max_altitude_m=42.0,
        sensors__dvl__max_tilt_deg=30.0,
    )
    rpy = (np.radians(roll_deg), 0.0, 0.0)
    assert bool(sampled(vehicle, "dvl", at_rest(1, depth, rpy))) == comes


def test_the_altitude_is_that_of_the_transducer():
    """With the nose 30 degrees up the transducer is lower or higher by its lever's share."""
    vehicle = exact(
        environment__seabed_depth_m=20.0,
        sensors__dvl__max_altitude_m=10.0,
        sensors__dvl__position_m=[-1.0, 0.0, 0.0],
    )
    up, down = (0.0, np.radians(30.0), 0.0), (0.0, np.radians(-30.0), 0.0)
    assert sampled(vehicle, "dvl", at_rest(1, 9.6, up))  # 0.5 m lower, 9.9 m above the seabed
    assert not sampled(vehicle, "dvl", at_rest(1, 10.4, down))  # 0.5 m higher


def test_without_a_seabed_there_is_no_loss_by_altitude():
    vehicle = exact(sensors__dvl__max_altitude_m=5.0)
    assert sampled(vehicle, "dvl", at_rest(1, 10.0))


def test_errors_that_are_none_change_nothing():
    none, values = Errors(1, "dvl", 3), np.array([1.0, 2.0, 3.0])
    assert not none.exist
    assert none.completed(5, values) is values
    assert none.scaled(values) is values
