"""Where a sensor cannot be expected to give samples: geometry, by cases that can be seen."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from uvms_core.vehicle import load_vehicle
from uvms_observer import NavigationConfig
from uvms_observer.navigation.samples import Instruments
from uvms_observer.navigation.state import empty_state
from uvms_observer.navigation.trust.sensor_health import Health, excused, trouble_of

PLACE = {"rate_hz": 5.0, "position_m": [0.0, 0.0, 0.1]}
ADDED = {
    "environment.seabed_depth_m": 30.0,
    "sensors.dvl.min_altitude_m": 1.0,
    "sensors.dvl.max_altitude_m": 15.0,
    "sensors.dvl.max_tilt_deg": 40.0,
    "sensors.position_fix": {
        **PLACE, "noise_m": 0.1, "source_m": [0.0, 0.0, 20.0], "max_range_m": 12.0
    },
    "sensors.target_marker": {
        **PLACE, "rpy_deg": [0.0, -90.0, 0.0], "max_range_m": 4.0, "noise_m": 0.01,
        "angle_noise_deg": 1.0, "target_position_m": [0.0, 0.0, 22.0], "target_std_m": 0.01,
    },
    "sensors.unknown": {
        **PLACE, "type": "target_marker", "max_range_m": 4.0, "noise_m": 0.01,
        "angle_noise_deg": 1.0, "target_position_m": [5.0, 0.0, 22.0],
    },
}  # fmt: skip
ALL = {"gps": "", "dvl": "", "position_fix": "", "target_marker": ""}
WATER, BOTTOM = "under water", "no bottom within its range"
CASES = [
    ((0.0, 0.0, 0.0), (0, 0, 0), {"dvl": BOTTOM, "position_fix": "out of range"}),
    ((0.0, 0.0, 20.0), (0, 0, 0), {"gps": WATER, "target_marker": None}),
    ((0.0, 0.0, 20.0), (0, 50, 0), {"gps": WATER, "dvl": BOTTOM}),
    ((3.0, 0.0, 20.0), (0, 0, 0), {"gps": WATER}),
    ((0.0, 0.0, 10.0), (0, 0, 0), {"gps": WATER, "dvl": BOTTOM}),
    ((0.0, 0.0, 29.5), (0, 0, 0), {"gps": WATER, "dvl": BOTTOM}),
]


def measured():
    vehicle = load_vehicle(overrides=ADDED)
    return Instruments(vehicle, NavigationConfig()).measurements


@pytest.mark.parametrize(("place", "rpy_deg", "silent"), CASES)
def test_what_cannot_be_sensed_from_here(place, rpy_deg, silent):
    """The marker faces up and is 2 m below the origin at 20 m: nowhere else is it in view."""
    measurements, state = measured(), empty_state()
    for each in measurements.values():
        state = each.begin(state)
    state.position[:] = place
    state.quaternion[:] = Rotation.from_euler("ZYX", rpy_deg[::-1], degrees=True).as_quat()
    expected = {**ALL, "target_marker": "out of view", "unknown": "not seen yet"} | silent
    expected["target_marker"] = expected["target_marker"] or ""
    found = {name: measurements[name].out_of_reach(state) for name in expected}
    assert found == expected
    assert measurements["imu"].out_of_reach(state) == ""
    for name, why in expected.items():
        health = excused(Health.LOST, measurements[name], state)
        assert health is (Health.OUT_OF_REACH if why else Health.LOST)
        assert excused(Health.EXCLUDED, measurements[name], state) is Health.EXCLUDED


def test_what_is_out_of_reach_is_no_trouble():
    assert trouble_of({"gps": Health.OUT_OF_REACH, "imu": Health.GOOD}) is None
    trouble = trouble_of({"gps": Health.OUT_OF_REACH, "dvl": Health.LOST})
    assert trouble.text == "no samples: dvl"


def test_places_of_sensors_are_with_the_lever_from_the_inertial_unit():
    measurements, state = measured(), empty_state()
    state.position[:] = [1.0, 2.0, 3.0]
    state.quaternion[:] = Rotation.from_euler("z", 90.0, degrees=True).as_quat()
    sensors = load_vehicle().sensors
    lever = np.subtract(sensors.gps.position_m, sensors.imu.position_m)
    np.testing.assert_allclose(
        measurements["gps"].place(state), [1.0 - lever[1], 2.0 + lever[0], 3.0 + lever[2]]
    )
