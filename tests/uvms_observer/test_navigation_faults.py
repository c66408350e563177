"""What the filter makes of sensors that lie, fall silent or jump, at half a metre a second."""

from dataclasses import replace

import numpy as np
import pytest
from navigation_cases import BEGIN, CRUISE, FAULTS, VEHICLE, off, outcome_of, turned
from sensor_truth import Rig

from uvms_core.signals import to_nanoseconds, to_seconds
from uvms_core.vehicle import load_vehicle
from uvms_observer import NavigationConfig, NavigationFilter
from uvms_observer.navigation.trust.sensor_health import Health


@pytest.mark.parametrize("name", FAULTS)
def test_the_estimate_stays_right_and_says_how_right(name):
    """Within 3.76 sigma, 99.9 % of a right filter's errors in space, in 99 % of the ticks."""
    fault = FAULTS[name]
    outcome = outcome_of(fault)
    assert outcome.errors.max() < fault.bound
    assert (outcome.distances < 3.76).mean() > 0.99
    assert outcome.jumps.max() < 3.0
    if fault.seconds > 1.0:
        assert outcome.health is fault.health
    P = outcome.navigation.state.covariance
    np.testing.assert_array_equal(P, P.T)
    assert np.linalg.eigvalsh(P).min() > -1e-12


def test_a_sensor_that_jumped_away_does_not_slip_in_where_the_estimate_has_become_uncertain():
    """A unit between the two classes alone is after some seconds less certain than the DVL is
    wrong; that of the BlueROV2 is worse (`test_lying_velocity.py`).
    """
    vehicle = load_vehicle("bluerov2_alpha5")
    better = {"accelerometer_noise_m_s2": 0.02, "accelerometer_bias_m_s2": 0.05}
    better |= {"gyro_bias_deg_s": 0.02, "bias_time_constant_s": 600.0}
    imu = vehicle.sensors.imu.model_copy(update=better)
    sensors = vehicle.sensors.model_copy(update={"imu": imu})
    vehicle = vehicle.model_copy(update={"sensors": sensors})
    outcome = outcome_of(FAULTS["dvl has water lock in a current"], 1, vehicle)
    status = outcome.navigation.status()
    assert 15 * 8 <= status["dvl_gated"] <= 15 * 8 + 2  # two more, until it is sure to be back
    assert outcome.errors.max() < 2.0  # what such a unit makes of 15 s by itself
    assert outcome.distances.max() < 3.0


def test_while_it_is_open_who_is_wrong_the_covariance_says_so():
    """The accelerometer steps: until that is found, the DVL seems to lie."""
    fault = FAULTS["accelerometer steps by 2 m/s2"]
    outcome = outcome_of(fault)
    assert outcome.errors.max() > 0.1
    assert outcome.distances.max() < 3.0
    assert outcome.navigation.status()["corrected"] == 1


def test_water_lock_tells_the_current():
    rig, current = Rig(VEHICLE, CRUISE), np.array([0.2, -0.1, 0.0])
    navigation = NavigationFilter(VEHICLE, NavigationConfig(initial_position_m=(0, 0, 10)))
    for stamp, imu, dvl_samples, pressure, gps in rig.frames(60.0):
        t = to_seconds(stamp)
        if t > BEGIN:  # bottom lock is lost now and then, and for good at the end
            through = CRUISE.rotation(t).inv().apply(current)
            dvl_samples = [
                replace(sample, velocity=sample.velocity - through, lock="water")
                if t % 2.0 < 1.0 or t > 40.0
                else sample
                for sample in dvl_samples
            ]
        odometry = navigation.step(stamp, imu, dvl_samples, pressure, gps)
    found, sigma = navigation.state.further[-2:], np.sqrt(np.diag(navigation.state.covariance)[-2:])
    assert np.abs(found - current[:2]).max() < 0.02
    assert np.abs((found - current[:2]) / sigma).max() < 3.0
    assert np.linalg.norm(odometry.position - CRUISE.position(60.0)) < 0.3
    assert navigation.health()["dvl"] is Health.GOOD


def test_a_filter_whose_sensors_are_noisier_than_stated_says_so():
    rig = Rig(VEHICLE, CRUISE, noise=2.0)
    navigation = NavigationFilter(VEHICLE, NavigationConfig(initial_position_m=(0, 0, 10)))
    for frame in rig.frames(30.0):
        odometry = navigation.step(*frame)
    assert "residuals are larger than stated noise explains" in navigation.trouble().text
    inside = navigation.state.covariance
    scale = odometry.pose_covariance[3, 3] / inside[6, 6]
    assert 1.2 < scale < 3.0  # a level of four, of which two are left alone


def test_where_two_sensors_contradict_the_estimate_it_is_begun_anew_and_counted():
    """Compass and DVL step at once, for good: more likely than not they know better."""
    rig, offset = Rig(VEHICLE, CRUISE), np.array([0.5, 0.0, 0.0])
    navigation = NavigationFilter(VEHICLE, NavigationConfig(initial_position_m=(0, 0, 10)))
    for stamp, imu_samples, dvl_samples, pressure, gps in rig.frames(40.0):
        if stamp > to_nanoseconds(BEGIN):
            imu_samples = [turned(40.0)(sample) for sample in imu_samples]
            dvl_samples = [off("velocity", offset)(sample) for sample in dvl_samples]
        odometry = navigation.step(stamp, imu_samples, dvl_samples, pressure, gps)
    assert navigation.status()["resets"] == 1
    assert "begun anew" in navigation.trouble().text
    told = CRUISE.velocity(40.0, np.zeros(3)) + offset
    assert np.abs(odometry.nu[:3] - told).max() < 0.05
    assert np.sqrt(odometry.pose_covariance[0, 0]) > 10.0


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
