"""The navigation node on an inertial unit as ROS has it (REP-103), rotated, on a vehicle without
DVL: best effort, since 1970, with jitter. The messages are made without the project's own turning.
"""

import numpy as np
import pytest
from in_process import Peer, graph_of, parameters, spin_until
from rclpy.qos import qos_profile_sensor_data
from scipy.spatial.transform import Rotation
from sensor_msgs.msg import FluidPressure, Imu

from uvms_core import topics
from uvms_core.vehicle import dump_vehicle, load_vehicle
from uvms_observer.nodes.navigation import NavigationNode

SINCE_1970 = 1_795_000_000_013_000_000
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
SPEED, RATE, DEPTH = 0.3, 0.2, 10.0  # a level circle
ENU = Rotation.from_matrix([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
FLU = Rotation.from_euler("x", 180.0, degrees=True)
SENSOR = Rotation.from_euler("ZYX", MOUNTING[::-1], degrees=True) * FLU  # its axes to the body's


class Driver(Peer):
    """An attitude sensor and a pressure sensor on a vehicle that goes round in a circle."""

    def __init__(self, vehicle, frame="ahrs", sensor=SENSOR):
        super().__init__(heard=[topics.ODOMETRY])
        best_effort = qos_profile_sensor_data
        self.imu = self.create_publisher(Imu, "/ahrs/data", best_effort)
        self.pressure = self.create_publisher(FluidPressure, "sensors/pressure", best_effort)
        self.vehicle, self.frame = vehicle, frame
        self.sensor = sensor
        self.rng, self.samples, self.last = np.random.default_rng(1), 0, SINCE_1970

    @property
    def odometry(self):
        return self.heard[topics.ODOMETRY.name]

    def publish(self):
        jitter = round(1e6 * np.clip(self.rng.standard_normal(), -2, 2))
        self.last = SINCE_1970 + round(self.samples * 1e9 / 97.0) + jitter
        self.imu.publish(self._attitude(1e-9 * (self.last - SINCE_1970)))
        if self.samples % 10 == 0:
            self.pressure.publish(self._depth())
        self.samples += 1

    def _stamped(self, message, frame):
        message.header.frame_id = frame
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(self.last, 10**9)
        return message

    def _attitude(self, t):
        imu, g = self.vehicle.sensors.imu, self.vehicle.environment.gravity_m_s2
        omega, lever = np.array([0.0, 0.0, RATE]), np.array(imu.position_m)
        inwards = np.cross(omega, [SPEED, 0.0, 0.0]) + np.cross(omega, np.cross(omega, lever))
        noise = self.rng.standard_normal((2, 3))
        rate = omega + np.radians(imu.gyro_noise_deg_s) * noise[0]
        force = inwards - [0.0, 0.0, g] + imu.accelerometer_noise_m_s2 * noise[1]
        message = self._stamped(Imu(), self.frame)
        attitude = ENU * Rotation.from_euler("z", RATE * t) * self.sensor
        x, y, z, w = attitude.as_quat()
        message.orientation.x, message.orientation.y = x, y
        message.orientation.z, message.orientation.w = z, w
        for field, value in (("angular_velocity", rate), ("linear_acceleration", force)):
            seen = self.sensor.inv().apply(value)
            vector = getattr(message, field)
            vector.x, vector.y, vector.z = map(float, seen)
        return message

    def _depth(self):
        sea = self.vehicle.environment
        depth = DEPTH + self.vehicle.sensors.pressure.position_m[2]
        message = self._stamped(FluidPressure(), "pressure_link_fsd")
        head = sea.water_density_kg_m3 * sea.gravity_m_s2 * depth
        message.fluid_pressure = sea.atmospheric_pressure_pa + head
        return message


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
    with graph_of(navigation_of(vehicle_file), lambda: Driver(vehicle)) as (spinner, (_, driver)):
        spin_until(spinner, lambda: driver.imu.get_subscription_count() > 0, rounds=600)
        heard = driver.last

        def answered():
            driver.publish()
            return len(driver.odometry) >= 60

        spin_until(spinner, answered, rounds=1500)
        begin, radius = driver.odometry[0].stamp, SPEED / RATE
        assert begin - heard < 10**9
        for each in driver.odometry[5:]:
            t = 1e-9 * (each.stamp - SINCE_1970)
            turn = Rotation.from_euler("z", RATE * t) * Rotation.from_quat(each.quaternion).inv()
            e, P = turn.as_rotvec(), each.pose_covariance[3:, 3:]
            assert np.sqrt(e @ np.linalg.solve(P, e)) < 4.1
            angles = RATE * t, RATE * 1e-9 * (begin - SINCE_1970)
            now, then = (radius * np.array([np.sin(a), -np.cos(a), 0.0]) for a in angles)
            e, P = each.position - (now - then) - [0.0, 0.0, DEPTH], each.pose_covariance[:3, :3]
            assert np.sqrt(e @ np.linalg.solve(P, e)) < 4.1


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
        return Driver(vehicle, frame, FLU if declared else SENSOR)

    with graph_of(navigation_of(vehicle_file), driver_of) as (spinner, (_, driver)):

        def told():
            driver.publish()
            said.append(capfd.readouterr().err)
            return text in "".join(said)

        spin_until(spinner, told, rounds=600)
        assert not driver.odometry
