"""What filter and observer refuse, their messages, and that nothing is lost by it."""

from dataclasses import replace

import numpy as np
import pytest
from sensor_truth import Motion, Rig, Waves
from small_plant import SmallPlant

from uvms_core.config import validated
from uvms_core.errors import ConfigError, SignalError
from uvms_core.signals import Wrench
from uvms_core.vehicle import load_vehicle
from uvms_observer import DisturbanceObserver, NavigationConfig, NavigationFilter, ObserverConfig

VEHICLE = load_vehicle()
MOTION = Motion(Waves((0.0, 0.0, 5.0)))
NOT_A_NUMBER = float("nan")


@pytest.fixture(scope="module")
def frames():
    return list(Rig(VEHICLE, MOTION, surface=True).frames(1.0))


def with_entry(array, index, value):
    changed = array.copy()
    changed[index] = value
    return changed


IMU, DVL, PRESSURE, GPS = 1, 2, 3, 4
BAD = {
    "nan": (
        IMU,
        lambda s: replace(s, angular_velocity=with_entry(s.angular_velocity, 1, NOT_A_NUMBER)),
        "imu.angular_velocity[1] is nan; it must be finite",
    ),
    "infinite": (
        IMU,
        lambda s: replace(s, linear_acceleration=with_entry(s.linear_acceleration, 2, np.inf)),
        "imu.linear_acceleration[2] is inf; it must be finite",
    ),
    "quaternion": (
        IMU,
        lambda s: replace(s, quaternion=2.0 * s.quaternion),
        "imu.quaternion has length 2; it must be 1",
    ),
    "shape": (
        DVL,
        lambda s: replace(s, velocity=s.velocity[:2]),
        "dvl.velocity has shape (2,); it must have (3,)",
    ),
    "list": (
        DVL,
        lambda s: replace(s, velocity=[0.0, 0.0, 0.0]),
        "dvl.velocity has type list; it must be an array of float64",
    ),
    "pressure": (
        PRESSURE,
        lambda s: replace(s, pressure=NOT_A_NUMBER),
        "pressure.pressure is nan; it must be finite",
    ),
    "gps": (
        GPS,
        lambda s: replace(s, latitude_deg=NOT_A_NUMBER),
        "gps.latitude_deg is nan; it must be finite",
    ),
    "future": (
        DVL,
        lambda s: replace(s, stamp=s.stamp + 10**9),
        "dvl.stamp is 2000000000 ns; it must not be after the step's, 1000000000 ns",
    ),
    "twice": (
        DVL,
        lambda s: replace(s, stamp=875_000_000),
        "dvl.stamp is 875000000 ns; it must be after the last one's, 875000000 ns",
    ),
}


@pytest.mark.parametrize("fault", BAD)
def test_a_bad_sample_is_named_and_the_filter_goes_on_without_it(frames, fault):
    kind, spoil, message = BAD[fault]
    navigation, untouched = (NavigationFilter(VEHICLE, NavigationConfig()) for _ in range(2))
    for frame in frames[:-1]:
        navigation.step(*frame)
        untouched.step(*frame)
    last = frames[-1]
    spoilt = list(last)
    spoilt[kind] = [spoil(sample) for sample in last[kind]]
    with pytest.raises(SignalError) as caught:
        navigation.step(*spoilt)
    assert str(caught.value) == message
    assert navigation.status()["refused"] == len(last[kind])
    after, expected = navigation.step(*last), untouched.step(*last)
    np.testing.assert_array_equal(after.position, expected.position)
    np.testing.assert_array_equal(after.pose_covariance, expected.pose_covariance)


def test_a_screened_step_uses_the_good_samples(frames):
    navigation, untouched = (NavigationFilter(VEHICLE, NavigationConfig()) for _ in range(2))
    for frame in frames[:-1]:
        navigation.step(*frame)
        untouched.step(*frame)
    stamp, imu, dvl, pressure, gps = frames[-1]
    spoilt = replace(pressure[0], pressure=NOT_A_NUMBER)
    samples = {"imu": imu, "dvl": dvl, "pressure": [spoilt], "gps": gps}
    after, faults = navigation.step_screened(stamp, samples)
    assert [str(fault) for fault in faults] == ["pressure.pressure is nan; it must be finite"]
    assert navigation.status()["refused"] == 1
    expected = untouched.step(stamp, imu, dvl, (), gps)
    np.testing.assert_array_equal(after.position, expected.position)
    np.testing.assert_array_equal(after.pose_covariance, expected.pose_covariance)


def test_a_sample_older_than_the_latency_is_refused(frames):
    navigation = NavigationFilter(VEHICLE, NavigationConfig(latency_s=0.1))
    for stamp, imu, _, pressure, gps in frames:
        navigation.step(stamp, imu, (), pressure, gps)
    old = next(frame[DVL][0] for frame in frames if frame[DVL] and frame[0] > 5 * 10**8)
    with pytest.raises(SignalError) as caught:
        navigation.step(stamp + 1, (), [old], (), ())
    assert str(caught.value) == (
        f"dvl.stamp is {old.stamp} ns; "
        "it must not be before the filter's time less latency, 900000000 ns"
    )


def test_steps_go_forward(frames):
    navigation = NavigationFilter(VEHICLE, NavigationConfig())
    navigation.step(*frames[0])
    with pytest.raises(SignalError) as caught:
        navigation.step(*frames[0])
    assert str(caught.value) == "stamp is 0 ns; it must be after the last step's, 0 ns"


def test_a_gps_without_fix_may_be_not_a_number(frames):
    navigation = NavigationFilter(VEHICLE, NavigationConfig())
    stamp, imu, dvl, pressure, gps = frames[0]
    blind = [replace(s, fix=False, latitude_deg=NOT_A_NUMBER) for s in gps]
    navigation.step(stamp, imu, dvl, pressure, blind)
    assert navigation.status()["gps_accepted"] == 0


@pytest.fixture
def signals():
    plant = SmallPlant(VEHICLE)
    return plant.odometry(), plant.joints(), Wrench(0, np.zeros(6))


WRONG = {
    "nu": (
        lambda o, j, w: (replace(o, nu=with_entry(o.nu, 4, NOT_A_NUMBER)), j, w),
        "odometry.nu[4] is nan; it must be finite",
    ),
    "joints": (
        lambda o, j, w: (o, replace(j, position=np.zeros(3)), w),
        "joint_states.position has shape (3,); it must have (4,) for swing, shoulder, elbow, wrist",
    ),
    "rates": (
        lambda o, j, w: (o, replace(j, velocity=with_entry(j.velocity, 0, np.inf)), w),
        "joint_states.velocity[swing] is inf; it must be finite",
    ),
    "wrench": (
        lambda o, j, w: (o, j, Wrench(0, with_entry(w.wrench, 5, NOT_A_NUMBER))),
        "wrench_achieved.wrench[5] is nan; it must be finite",
    ),
    "stamps": (
        lambda o, j, w: (o, replace(j, stamp=5), w),
        "joint_states: stamp 5 ns; it must lie within 0.5 s before the odometry's, 0 ns",
    ),
}


@pytest.mark.parametrize("fault", WRONG)
def test_a_bad_input_of_the_observer_is_named_and_changes_nothing(signals, fault):
    spoil, message = WRONG[fault]
    observer, untouched = (DisturbanceObserver(VEHICLE, ObserverConfig()) for _ in range(2))
    with pytest.raises(SignalError) as caught:
        observer.step(*spoil(*signals))
    assert str(caught.value) == message
    after, expected = observer.step(*signals)[1], untouched.step(*signals)[1]
    np.testing.assert_array_equal(after.wrench, expected.wrench)


def test_the_observer_goes_forward(signals):
    observer = DisturbanceObserver(VEHICLE, ObserverConfig())
    observer.step(*signals)
    with pytest.raises(SignalError) as caught:
        observer.step(*signals)
    assert str(caught.value) == "odometry.stamp is 0 ns; it must be after the last one's, 0 ns"


@pytest.mark.parametrize(
    ("model", "data", "message"),
    [
        (
            NavigationConfig,
            {"gate_probability": 1.5},
            "test: gate_probability: Input should be less than 1 (got 1.5)",
        ),
        (
            NavigationConfig,
            {"noise_floor": {"depth_m": 0.0}},
            "test: noise_floor.depth_m: Input should be greater than 0 (got 0.0)",
        ),
        (
            ObserverConfig,
            {"external_bandwidth_rad_s": -1.0},
            "test: external_bandwidth_rad_s: Input should be greater than 0 (got -1.0)",
        ),
    ],
)
def test_parameters_outside_their_bounds_are_named(model, data, message):
    with pytest.raises(ConfigError) as caught:
        validated(model, data, "test")
    assert str(caught.value) == message
