"""Sensors: statistics of their errors, lever arms, rates and seeds."""

import numpy as np
import pytest
from random_vehicles import REFERENCE

from uvms_core.geodesy import geodetic_to_ned
from uvms_core.signals import JointCommand, ThrusterCommand, to_nanoseconds
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import quat_to_matrix
from uvms_dynamics.kernels.rotations import quat_conjugate, quat_multiply, quat_to_rotation_vector
from uvms_dynamics.simulation import Plant, PlantConfig
from uvms_dynamics.simulation.sensors import SensorSuite
from uvms_dynamics.simulation.sensors.dvl import DvlSensor
from uvms_dynamics.simulation.sensors.encoders import EncoderSensor
from uvms_dynamics.simulation.sensors.gps import GpsSensor
from uvms_dynamics.simulation.sensors.imu import ImuSensor
from uvms_dynamics.simulation.sensors.mounting import Trajectory
from uvms_dynamics.simulation.sensors.pressure import PressureSensor

PERIOD = 10_000_000  # ns
ENVIRONMENT, SENSORS = REFERENCE.environment, REFERENCE.sensors


def at_rest(count, depth=10.0):
    """Level and at rest at a depth, one state a sensor period."""
    state = np.zeros(13)
    state[2], state[6] = depth, 1.0
    stamps = tuple(range(PERIOD, (count + 1) * PERIOD, PERIOD))
    return Trajectory(stamps, np.tile(state, (count, 1)), np.zeros((count, 13)), np.zeros(3))


def exact(**rates):
    """Overrides that take all errors from the sensors."""
    found = {"sensors.encoders.resolution_deg": 0.0}
    for name, sensor in SENSORS:
        for field in type(sensor).model_fields:
            if "noise" in field or "bias" in field or field == "scale_error":
                found[f"sensors.{name}.{field}"] = 1.0 if field.endswith("constant_s") else 0.0
    return {**found, **{f"sensors.{name}.rate_hz": rate for name, rate in rates.items()}}


def test_imu_noise_has_the_files_size():
    sensor = ImuSensor(REFERENCE, SENSORS.imu, PERIOD, seed=1)
    samples = sensor.sample(at_rest(20_000))
    attitude = np.degrees([quat_to_rotation_vector(s.quaternion) for s in samples])
    imu = SENSORS.imu
    white = [imu.roll_pitch_noise_deg, imu.roll_pitch_noise_deg, imu.heading_noise_deg]
    np.testing.assert_allclose(changes(attitude), white, rtol=0.03)
    gyro = np.degrees([s.angular_velocity for s in samples])
    np.testing.assert_allclose(changes(gyro), imu.gyro_noise_deg_s, rtol=0.03)
    force = np.array([s.linear_acceleration for s in samples])
    np.testing.assert_allclose(changes(force), imu.accelerometer_noise_m_s2, rtol=0.03)
    np.testing.assert_allclose(force.mean(axis=0), (0.0, 0.0, -9.81), atol=0.01)


def changes(values):
    """Std of the white part of a series: its differences do not see a slow bias."""
    return np.std(np.diff(values, axis=0), axis=0) / np.sqrt(2.0)


def test_imu_biases_are_spread_as_the_file_says_and_slow():
    first = [
        quat_to_rotation_vector(
            ImuSensor(REFERENCE, SENSORS.imu, PERIOD, seed).sample(at_rest(1))[0].quaternion
        )
        for seed in range(600)
    ]
    imu = SENSORS.imu
    total = np.hypot(
        [imu.roll_pitch_bias_deg] * 2 + [imu.heading_bias_deg],
        [imu.roll_pitch_noise_deg] * 2 + [imu.heading_noise_deg],
    )
    np.testing.assert_allclose(np.degrees(np.std(first, axis=0)), total, rtol=0.1)
    sample = ImuSensor(REFERENCE, imu, PERIOD, 1).sample(at_rest(1))[0]
    np.testing.assert_allclose(
        np.degrees(np.sqrt(np.diag(sample.orientation_covariance))), total, rtol=1e-9
    )


def test_imu_bias_forgets_with_its_time_constant():
    fast = load_vehicle(
        overrides={**exact(), "sensors.imu.accelerometer_bias_m_s2": 1.0,
                   "sensors.imu.bias_time_constant_s": 0.1}
    )  # fmt: skip
    samples = ImuSensor(fast, fast.sensors.imu, PERIOD, 1).sample(at_rest(50_000))
    bias = np.array([s.linear_acceleration for s in samples]) - [0.0, 0.0, -9.81]
    np.testing.assert_allclose(bias.std(axis=0), 1.0, rtol=0.1)
    lagged = np.mean(bias[10:] * bias[:-10], axis=0)  # one time constant apart
    np.testing.assert_allclose(lagged, np.exp(-1.0), atol=0.08)


def test_dvl_noise_and_scale():
    sensor = DvlSensor(REFERENCE, SENSORS.dvl, PERIOD, seed=2)
    samples = sensor.sample(at_rest(20_000))
    velocity = np.array([s.velocity for s in samples])
    np.testing.assert_allclose(velocity.std(axis=0), SENSORS.dvl.noise_m_s, rtol=0.03)
    np.testing.assert_allclose(samples[0].covariance, 4e-6 * np.eye(3), atol=1e-9)
    scales = []
    moving = at_rest(1)
    moving.states[:, 7] = 10.0
    for seed in range(400):
        scales.append(
            DvlSensor(REFERENCE, SENSORS.dvl, PERIOD, seed).sample(moving)[0].velocity[0] / 10.0
        )
    assert np.std(scales) == pytest.approx(SENSORS.dvl.scale_error, rel=0.12)


def test_pressure_noise_bias_and_depth():
    def read(seed, count=1, depth=10.0):
        sensor = PressureSensor(REFERENCE, SENSORS.pressure, PERIOD, seed)
        return np.array([s.pressure for s in sensor.sample(at_rest(count, depth))])

    assert read(1, 20_000).std() == pytest.approx(SENSORS.pressure.noise_pa, rel=0.03)
    biases = [read(seed, 50).mean() for seed in range(300)]
    assert np.mean(biases) == pytest.approx(101325.0 + 1025.0 * 9.81 * 10.0, abs=20.0)
    assert np.std(biases) == pytest.approx(SENSORS.pressure.bias_pa, rel=0.15)
    assert read(1, 2000, depth=-1.0).mean() == pytest.approx(101325.0, abs=400.0)


def test_gps_has_a_fix_only_with_the_antenna_in_the_air():
    sensor = GpsSensor(REFERENCE, SENSORS.gps, PERIOD, seed=3)
    (below,) = sensor.sample(at_rest(1, depth=0.3))
    assert not below.fix
    assert np.isnan([below.latitude_deg, below.longitude_deg, below.altitude]).all()
    samples = sensor.sample(at_rest(5000, depth=0.1))
    assert all(sample.fix for sample in samples)
    datum = (ENVIRONMENT.datum_latitude_deg, ENVIRONMENT.datum_longitude_deg)
    places = [geodetic_to_ned(s.latitude_deg, s.longitude_deg, s.altitude, *datum) for s in samples]
    np.testing.assert_allclose(np.std(places, axis=0), (1.5, 1.5, 3.0), rtol=0.05)
    np.testing.assert_allclose(np.mean(places, axis=0), (0.1, 0.0, -0.15), atol=0.15)


def test_encoders_round_and_add_noise():
    sensor = EncoderSensor(SENSORS.encoders, seed=4)
    q, rate, effort = np.array([0.1, -0.2]), np.array([0.3, 0.0]), np.array([5.0, 6.0])
    samples = [sensor.sample(0, q, rate, effort) for _ in range(5000)]
    angles = np.degrees([s.position for s in samples])
    step = SENSORS.encoders.resolution_deg
    np.testing.assert_allclose(angles / step, np.round(angles / step), atol=1e-6)
    expected = np.hypot(SENSORS.encoders.noise_deg, step / np.sqrt(12.0))
    np.testing.assert_allclose(angles.std(axis=0), expected, rtol=0.06)
    np.testing.assert_allclose(np.degrees(np.std([s.velocity for s in samples], axis=0)),
                               SENSORS.encoders.rate_noise_deg_s, rtol=0.05)  # fmt: skip
    np.testing.assert_array_equal(samples[0].effort, effort)


@pytest.fixture(scope="module")
def manoeuvre():
    """True odometry and exact samples at every step of a turning vehicle in a current."""
    step = 0.005
    vehicle = load_vehicle(overrides=exact(imu=200.0, dvl=200.0, pressure=200.0, gps=200.0))
    config = PlantConfig(
        step_s=step,
        control_period_s=step,
        initial_position_m=(1.0, 2.0, 0.083),
        initial_velocity=(0.8, 0.2, -0.1, 0.3, -0.2, 0.4),
        initial_rpy_deg=(20.0, -10.0, 120.0),
        current_ned_m_s=(0.2, 0.3, 0.0),
    )
    plant = Plant(vehicle, config, seed=1)
    thrust = ThrusterCommand(0, np.array([60.0, 20.0, -20.0, 10.0, -15.0, 5.0, 10.0]))
    effort = JointCommand(0, np.array([5.0, 3.0, -2.0, 1.0]))
    truths, frames = [plant.truth()], [plant.sense()]
    for _ in range(100):
        plant.step(thrust, effort)
        truths.append(plant.truth())
        frames.append(plant.sense())
    return step, vehicle, truths, frames


def places_of(truths, lever):
    """Where a point of the body is, map_ned."""
    return np.array(
        [t.odometry.position + quat_to_matrix(t.odometry.quaternion) @ lever for t in truths]
    )


def in_body(truths, vectors):
    return np.array(
        [quat_to_matrix(t.odometry.quaternion).T @ v for t, v in zip(truths, vectors, strict=True)]
    )


def test_dvl_measures_the_velocity_of_its_own_place_over_ground(manoeuvre):
    step, vehicle, truths, frames = manoeuvre
    place = places_of(truths, vehicle.sensors.dvl.position_m)
    slope = (place[:-4] - 8.0 * place[1:-3] + 8.0 * place[3:-1] - place[4:]) / (12.0 * step)
    measured = np.array([frame.dvl[0].velocity for frame in frames[2:-2]])
    # the thrusters' slew ends after 0.2 s; before it and after it the motion is smooth
    np.testing.assert_allclose(measured, in_body(truths[2:-2], slope), atol=2e-5)


def test_imu_measures_the_specific_force_of_its_own_place(manoeuvre):
    step, vehicle, truths, frames = manoeuvre
    place = places_of(truths, vehicle.sensors.imu.position_m)
    curvature = (place[:-2] - 2.0 * place[1:-1] + place[2:]) / step**2
    expected = in_body(truths[1:-1], curvature - [0.0, 0.0, 9.81])
    measured = np.array([frame.imu[0].linear_acceleration for frame in frames[1:-1]])
    np.testing.assert_allclose(measured[2:], expected[2:], atol=5e-3)


def test_imu_measures_attitude_and_turn_rate(manoeuvre):
    step, _, truths, frames = manoeuvre
    for before, now, after, frame in zip(
        truths[:-2], truths[1:-1], truths[2:], frames[1:-1], strict=True
    ):
        (sample,) = frame.imu
        np.testing.assert_allclose(sample.quaternion, now.odometry.quaternion, atol=1e-15)
        turned = quat_multiply(
            quat_conjugate(before.odometry.quaternion), after.odometry.quaternion
        )
        rate = quat_to_rotation_vector(turned) / (2.0 * step)
        np.testing.assert_allclose(sample.angular_velocity, rate, atol=2e-3)


def test_pressure_and_gps_are_those_of_their_own_place(manoeuvre):
    _, vehicle, truths, frames = manoeuvre
    depth = places_of(truths, vehicle.sensors.pressure.position_m)[:, 2]
    measured = np.array([frame.pressure[0].pressure for frame in frames])
    np.testing.assert_allclose(
        measured, 101325.0 + 1025.0 * 9.81 * np.maximum(depth, 0.0), rtol=1e-12
    )
    assert (depth > 0.0).any()
    assert (depth < 0.0).any()
    antenna = places_of(truths, vehicle.sensors.gps.position_m)
    datum = (ENVIRONMENT.datum_latitude_deg, ENVIRONMENT.datum_longitude_deg)
    for place, frame in zip(antenna, frames, strict=True):
        (sample,) = frame.gps
        assert sample.fix == (place[2] < 0.0)
        if sample.fix:
            found = geodetic_to_ned(
                sample.latitude_deg, sample.longitude_deg, sample.altitude, *datum
            )
            np.testing.assert_allclose(found, place, atol=1e-6)


def run_frames(vehicle, seed, ticks=30):
    plant = Plant(vehicle, PlantConfig(), seed)
    frames = [plant.sense()]
    for _ in range(ticks):
        plant.step(None, None)
        frames.append(plant.sense())
    return frames


def test_each_sensor_samples_at_its_own_rate():
    frames = run_frames(REFERENCE, 1, ticks=40)  # 2 s
    assert [len(frames[0].imu), len(frames[0].dvl), len(frames[0].pressure)] == [1, 1, 1]
    for name, rate in (("imu", 100), ("dvl", 8), ("pressure", 10), ("gps", 1)):
        stamps = [sample.stamp for frame in frames for sample in getattr(frame, name)]
        period = to_nanoseconds(1.0 / rate)
        assert stamps == list(range(0, 2_000_000_001, period))


def test_sense_only_looks():
    plant = Plant(REFERENCE, PlantConfig(), 1)
    assert plant.sense() is plant.sense()


def readings(frames):
    return [np.concatenate([s.linear_acceleration for s in f.imu]) for f in frames]


def test_the_seed_makes_the_samples():
    one, same, other = (readings(run_frames(REFERENCE, seed)) for seed in (1, 1, 2))
    np.testing.assert_array_equal(np.concatenate(one), np.concatenate(same))
    assert all((a != b).all() for a, b in zip(one, other, strict=True))


def test_one_sensors_rate_leaves_the_others_alone():
    faster = load_vehicle(overrides={"sensors.dvl.rate_hz": 20.0})
    one, other = run_frames(REFERENCE, 1), run_frames(faster, 1)
    np.testing.assert_array_equal(np.concatenate(readings(one)), np.concatenate(readings(other)))


def test_the_suite_lets_its_owner_refuse_a_period():
    asked = []
    SensorSuite(REFERENCE, 1, lambda period, name: asked.append((period, name)))
    assert asked == [
        (10_000_000, "sensors.imu.rate_hz"),
        (125_000_000, "sensors.dvl.rate_hz"),
        (100_000_000, "sensors.pressure.rate_hz"),
        (1_000_000_000, "sensors.gps.rate_hz"),
    ]
