"""The navigation node on an inertial unit as ROS has it (REP-103), rotated, on a vehicle without
DVL: best effort, since 1970, with jitter. The messages are made without the project's own turning.
"""

import numpy as np
import pytest
from drivers import FLU, Driver, Habits
from in_process import graph_of, parameters, spin_until
from scipy.spatial.transform import Rotation

from uvms_core.vehicle import dump_vehicle, load_vehicle
from uvms_observer.nodes.navigation import NavigationNode

MOUNTING = [5.0, -10.0, 120.0]
DECLARED = {
    "sensors.imu.axes": "flu",
    "sensors.imu.world": "enu",
    "sensors.imu.rpy_deg": MOUNTING,
    "sensors.imu.topic": "/ahrs/data",
    "sensors.imu.frame_id": "ahrs",
    "sensors.imu.rate_hz": 97.0,
    "sensors.dvl": None,
    "sensors.gps": None,
}
SENSOR = Rotation.from_euler("ZYX", MOUNTING[::-1], degrees=True) * FLU  # its axes to the body's


def file_of(tmp_path, **declared):
    path = tmp_path / "vehicle.yaml"
    path.write_text(dump_vehicle(load_vehicle(overrides=DECLARED | declared)), encoding="utf-8")
    return str(path)


def navigation_of(vehicle_file):
    return lambda: NavigationNode(
        parameter_overrides=parameters(pace="realtime", vehicle_file=vehicle_file)
    )


def test_an_enu_driver_without_dvl_is_answered_within_a_second_and_rightly(tmp_path):
    vehicle_file = file_of(tmp_path)
    vehicle = load_vehicle(vehicle_file)

    def driver_of():
        return Driver(vehicle, Habits(sensor=SENSOR))

    with graph_of(navigation_of(vehicle_file), driver_of) as (spinner, (_, driver)):
        spin_until(spinner, lambda: driver.imu.get_subscription_count() > 0, rounds=600)
        heard = driver.last

        def answered():
            driver.publish()
            return len(driver.odometry) >= 60

        spin_until(spinner, answered, rounds=1500)
        assert driver.odometry[0].stamp - heard < 10**9
        assert np.abs(driver.errors(since=5)).max() < 3.0


AS_THE_BODY = {
    "sensors.imu.axes": "frd",
    "sensors.imu.world": "ned",
    "sensors.imu.rpy_deg": [0.0, 0.0, 0.0],
}


@pytest.mark.parametrize(
    ("declared", "frame", "text"),
    [
        ({}, "imu_link", "sensors.imu.frame_id"),
        (AS_THE_BODY, "ahrs", "sensors.imu.axes: flu and sensors.imu.world: enu"),
    ],
)
def test_a_driver_that_is_not_as_declared_is_told_why(tmp_path, capfd, declared, frame, text):
    vehicle_file = file_of(tmp_path, **declared)
    vehicle, said = load_vehicle(vehicle_file), []

    def driver_of():
        return Driver(vehicle, Habits(frame=frame, sensor=FLU if declared else SENSOR))

    with graph_of(navigation_of(vehicle_file), driver_of) as (spinner, (_, driver)):

        def told():
            driver.publish()
            said.append(capfd.readouterr().err)
            return text in "".join(said)

        spin_until(spinner, told, rounds=600)
        assert not driver.odometry
