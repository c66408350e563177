"""What no thruster's drive and no instrument does is warned of, with field, value and bound."""

import pytest

from uvms_core.errors import VehicleFileError
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.plausible import vehicle_warnings


def warnings(**overrides):
    changes = {path.replace("__", "."): value for path, value in overrides.items()}
    return [
        line
        for line in vehicle_warnings(load_vehicle(overrides=changes))
        if line not in vehicle_warnings(load_vehicle())
    ]


@pytest.mark.parametrize(
    ("field", "value", "words"),
    [
        ("thrusters__main__dead_zone", 0.35, "no thrust up to 35% of its command, more than 30%"),
        ("sensors__imu__latency_s", 3.0, "sensors.imu.latency_s: 3 s, more than 2 s"),
        ("sensors__dvl__drop_out_rate", 0.6, "sensors.dvl.drop_out_rate: 0.6 is more than 0.5"),
        ("sensors__encoders__outlier_rate", 0.9, "sensors.encoders.outlier_rate: 0.9 is more"),
        ("sensors__dvl__misalignment_deg", 25.0, "sensors.dvl.misalignment_deg: 25 is more than"),
        ("sensors__pressure__scale_error", 0.3, "sensors.pressure.scale_error: 0.3 is more than"),
        ("sensors__gps__resolution_m", 200.0, "sensors.gps.resolution_m: 200 is more than 100"),
    ],
)
def test_what_is_odd_is_warned_of(field, value, words):
    found = warnings(**{field: value})
    assert any(words in line for line in found), found


def test_a_least_thrust_of_a_quarter_is_warned_of():
    found = warnings(thrusters__main__dead_zone=0.25)
    assert any("gives none or 24.5 N, more than 20% of its 98 N" in line for line in found), found


def test_what_is_mild_is_not():
    mild = {
        "thrusters__main__dead_zone": 0.07,
        "sensors__imu__latency_s": 0.02,
        "sensors__dvl__drop_out_rate": 0.05,
        "sensors__dvl__misalignment_deg": 1.0,
        "environment__seabed_depth_m": 30.0,
    }
    assert not warnings(**mild)


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        ("sensors.imu.drop_out_rate", 1.5, "less than or equal to 1"),
        ("sensors.dvl.latency_s", -0.1, "greater than or equal to 0"),
        ("sensors.dvl.max_altitude_m", 0.0, "greater than 0"),
        ("environment.seabed_depth_m", -5.0, "greater than 0"),
        ("sensors.encoders.latency_s", 0.1, "has no 'latency_s'"),
    ],
)
def test_what_cannot_be_is_refused(path, value, words):
    with pytest.raises(VehicleFileError, match=path) as fault:
        load_vehicle(overrides={path: value})
    assert words in str(fault.value)


def test_altitudes_that_leave_no_room_are_refused():
    changes = {"sensors.dvl.min_altitude_m": 5.0, "sensors.dvl.max_altitude_m": 4.0}
    with pytest.raises(VehicleFileError, match="4 m must be above min_altitude_m = 5 m"):
        load_vehicle(overrides=changes)
