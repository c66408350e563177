"""Inertial units that freeze, break, shake or state nonsense, and a pressure in other units."""

from dataclasses import replace

import numpy as np
import pytest
from navigation_cases import CRUISE, VEHICLE, Fault, off, outcome_of, reads, turned
from sensor_truth import Rig

from uvms_core.signals import to_seconds
from uvms_core.vehicle import load_vehicle
from uvms_observer import NavigationConfig, NavigationFilter
from uvms_observer.navigation.inertial.condition import ConditionCheck
from uvms_observer.navigation.trust.sensor_health import Health

BLUEROV = load_vehicle("bluerov2_alpha5")


def frozen(*names):
    """The first values that come stay."""
    kept = {}

    def change(sample):
        for name in names:
            kept.setdefault(name, getattr(sample, name))
        return replace(sample, **kept)

    return change


def shaken(amplitude, hertz):
    def change(sample):
        wave = amplitude * np.sin(2.0 * np.pi * hertz * to_seconds(sample.stamp))
        return off("linear_acceleration", wave * np.array([1.0, 0.7, 1.0]))(sample)

    return change


def noisy(name, std):
    rng = np.random.default_rng(4)
    return lambda sample: off(name, std * rng.standard_normal(3))(sample)


def stated(value):
    covariance = np.full((3, 3), value)
    names = "orientation", "angular_velocity", "linear_acceleration"
    return reads(**{f"{name}_covariance": covariance for name in names})


PARTS = "quaternion", "angular_velocity", "linear_acceleration"
WITHOUT_GRAVITY = reads(linear_acceleration=np.zeros(3))
BROKEN = {
    "all frozen": frozen(*PARTS),
    "rate frozen": frozen("angular_velocity"),
    "force frozen": frozen("linear_acceleration"),
    "without gravity": WITHOUT_GRAVITY,
    "force at its limit": reads(linear_acceleration=np.full(3, 100.0)),
    "force overflows": reads(linear_acceleration=np.full(3, 1e300)),
    "rate at its limit": reads(angular_velocity=np.full(3, 30.0)),
    "rate overflows": reads(angular_velocity=np.full(3, 1e150)),
}
USED = {
    "attitude frozen": frozen("quaternion"),
    "vibration": shaken(1.0, 30.0),
    "vibration near half the rate": shaken(1.0, 47.0),
    "rate is noisy": noisy("angular_velocity", 0.05),
    "force is noisy": noisy("linear_acceleration", 1.0),
}


def judged(outcome, most):
    assert outcome.errors.max() < most
    assert (outcome.distances < 3.76).mean() > 0.99
    assert outcome.jumps.max() < 3.0
    P = outcome.navigation.state.covariance
    np.testing.assert_array_equal(P, P.T)
    assert np.linalg.eigvalsh(P).min() > -1e-12


@pytest.mark.parametrize("vehicle", [VEHICLE, BLUEROV], ids=["reference", "bluerov2"])
@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_unit_is_as_good_as_a_silent_one(name, vehicle):
    outcome = outcome_of(Fault("imu", BROKEN[name], 10.0), 1, vehicle)
    judged(outcome, 2.0)
    assert outcome.health is Health.LOST
    assert outcome.navigation.health()["imu"] is Health.GOOD


@pytest.mark.parametrize("vehicle", [VEHICLE, BLUEROV], ids=["reference", "bluerov2"])
@pytest.mark.parametrize("name", USED)
def test_a_unit_that_is_worse_than_stated_is_used_and_named(name, vehicle):
    outcome = outcome_of(Fault("imu", USED[name], np.inf), 2, vehicle)
    judged(outcome, 1.5 if vehicle is BLUEROV else 0.1)
    assert "the imu's" in outcome.navigation.trouble().text


@pytest.mark.parametrize("value", [np.inf, 1e300, np.nan, -1.0])
@pytest.mark.parametrize("sensor", ["imu", "dvl"])
def test_whatever_a_message_states_the_covariance_is_one(sensor, value):
    change = stated(value) if sensor == "imu" else reads(covariance=np.full((3, 3), value))
    judged(outcome_of(Fault(sensor, change, 10.0)), 10.0)


def test_a_right_unit_is_not_taken_to_be_noisy():
    for vehicle in (VEHICLE, BLUEROV):
        rig = Rig(vehicle, CRUISE, 3)
        check = ConditionCheck(vehicle)
        for _, imu, *_ in rig.frames(60.0):
            assert all(check.judged("imu", sample) is sample for sample in imu)


def test_a_unit_without_noise_may_read_the_same():
    """As that of a simulation without noise does, at rest."""
    imu = VEHICLE.sensors.imu.model_copy(
        update={
            "gyro_noise_deg_s": 0.0,
            "accelerometer_noise_m_s2": 0.0,
            "roll_pitch_noise_deg": 0.0,
        }
    )
    sensors = VEHICLE.sensors.model_copy(update={"imu": imu})
    check = ConditionCheck(VEHICLE.model_copy(update={"sensors": sensors}))
    (sample,) = Rig(VEHICLE, CRUISE).imu(np.array([0.0]))
    for k in range(200):
        after = replace(sample, stamp=10_000_000 * k)
        assert check.judged("imu", after) is after


@pytest.mark.parametrize("per_pascal", [1e-4, 1e-3])
def test_a_pressure_in_other_units_is_refused(per_pascal):
    outcome = outcome_of(
        Fault(
            "pressure", lambda s: replace(s, pressure=per_pascal * s.pressure), health=Health.LOST
        )
    )
    judged(outcome, 0.1)
    assert outcome.health is Health.LOST
    assert "no samples: pressure" in outcome.navigation.trouble().text


def test_a_pressure_above_the_surface_says_what_is_expected():
    rig, navigation = Rig(VEHICLE, CRUISE), NavigationFilter(VEHICLE, NavigationConfig())
    for stamp, imu, _, pressure, _ in rig.frames(0.5):
        bad = [replace(sample, pressure=20.0) for sample in pressure]
        _, faults = navigation.step_screened(stamp, {"imu": imu, "pressure": bad})
        if bad:
            assert "a depth of -10.1 m" in str(faults[0])
            assert "absolute pressure in Pa" in str(faults[0])


def test_a_velocity_that_no_vehicle_has_is_not_kept():
    """Rates in deg/s for ten seconds: the attitude turns over and over, and gravity with it."""
    change = lambda s: replace(s, angular_velocity=np.degrees(s.angular_velocity))  # noqa: E731
    outcome = outcome_of(Fault("imu", change, 10.0))
    assert outcome.errors.max() < 100.0
    assert outcome.navigation.status()["resets"] >= 1
    assert "begun anew" in outcome.navigation.trouble().text


def test_late_samples_from_before_a_new_beginning_are_left_out():
    rig = Rig(VEHICLE, CRUISE)
    navigation = NavigationFilter(VEHICLE, NavigationConfig(initial_position_m=(0, 0, 10)))
    waiting = []
    for stamp, imu, dvl, pressure, gps in rig.frames(40.0):
        if stamp > 15e9:
            imu = [turned(40.0)(sample) for sample in imu]
            dvl = [off("velocity", np.array([0.5, 0.0, 0.0]))(sample) for sample in dvl]
        waiting += dvl
        due = [sample for sample in waiting if sample.stamp <= stamp - 200_000_000]
        waiting = waiting[len(due) :]
        odometry = navigation.step(stamp, imu, due, pressure, gps)
    assert navigation.status()["resets"] >= 1
    assert np.isfinite(odometry.position).all()


@pytest.mark.parametrize("vehicle", [VEHICLE, BLUEROV], ids=["reference", "bluerov2"])
def test_where_all_is_silent_the_vehicle_still_has_its_top_speed(vehicle):
    """Thirty seconds at half a metre a second; then all come back."""
    rig = Rig(vehicle, CRUISE)
    navigation = NavigationFilter(vehicle, NavigationConfig(initial_position_m=(0, 0, 10)))
    distances = []
    for stamp, *samples in rig.frames(50.0):
        silent = 10e9 < stamp <= 40e9
        odometry = navigation.step(stamp, *([()] * 4 if silent else samples))
        error = CRUISE.position(to_seconds(stamp)) - odometry.position
        spread = np.linalg.solve(odometry.pose_covariance[:3, :3], error)
        distances.append(float(np.sqrt(error @ spread)))
        assert np.linalg.norm(error) < 15.0
    assert max(distances) < 3.76
    assert np.abs(odometry.nu[:3] - CRUISE.velocity(50.0, np.zeros(3))).max() < 0.05
