"""Drivers of sensors on a vehicle that goes round in a level circle, without the project's turning.

Stamps, rates, jitter, axes and quality of service are those of real drivers, by choice.
"""

from dataclasses import dataclass, field

import numpy as np
from geometry_msgs.msg import TwistWithCovarianceStamped
from in_process import Peer
from rclpy.qos import qos_profile_sensor_data
from scipy.spatial.transform import Rotation
from sensor_msgs.msg import FluidPressure, Imu

from uvms_core import topics

SPEED, RATE, DEPTH = 0.3, 0.2, 10.0  # m/s, rad/s, m
RADIUS = SPEED / RATE
ENU = Rotation.from_matrix([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
FLU = Rotation.from_euler("x", 180.0, degrees=True)
SINCE_1970 = 1_795_000_000_013_000_000


@dataclass
class Habits:
    """How drivers publish: clock, jitter, rates, quality of service, axes of the inertial unit."""

    since: int = SINCE_1970  # ns, stamp of the first sample
    jitter_s: float = 1e-3
    rate_hz: float = 97.0
    qos: object = field(default_factory=lambda: qos_profile_sensor_data)
    topic: str = "/ahrs/data"
    frame: str = "ahrs"
    sensor: Rotation = field(default_factory=Rotation.identity)  # its axes to the body's
    is_enu: bool = True


class Driver(Peer):
    """An attitude sensor, and the vehicle's pressure sensors and DVLs.

    Args:
        vehicle: its sensors, with their levers and noise.
        habits: of the drivers.
    """

    def __init__(self, vehicle, habits):
        super().__init__(heard=[topics.ODOMETRY, topics.DIAGNOSTICS])
        self.vehicle, self.habits = vehicle, habits
        self.imu = self.create_publisher(Imu, habits.topic, habits.qos)
        kinds = {"pressure": FluidPressure, "dvl": TwistWithCovarianceStamped}
        self.others = {
            name: self.create_publisher(kinds[kind], f"sensors/{name}", habits.qos)
            for name, section in vehicle.sensors.mounted.items()
            if (kind := section.type or name) in kinds
        }
        self.silent = set()  # names of those that have failed
        self.rng, self.samples, self.last = np.random.default_rng(1), 0, habits.since

    @property
    def odometry(self):
        return self.heard[topics.ODOMETRY.name]

    def publish(self):
        jitter = self.habits.jitter_s * np.clip(self.rng.standard_normal(), -2, 2)
        elapsed = self.samples / self.habits.rate_hz + jitter
        self.last = self.habits.since + max(round(1e9 * elapsed), 0)
        self.imu.publish(self._attitude(self._now))
        for k, (name, publisher) in enumerate(self.others.items()):
            if self.samples % 12 == k and name not in self.silent:
                publisher.publish(self._other(name))
        self.samples += 1

    @property
    def _now(self):
        return 1e-9 * (self.last - self.habits.since)

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
        message = self._stamped(Imu(), self.habits.frame)
        world = ENU if self.habits.is_enu else Rotation.identity()
        attitude = world * Rotation.from_euler("z", RATE * t) * self.habits.sensor
        x, y, z, w = attitude.as_quat()
        message.orientation.x, message.orientation.y = x, y
        message.orientation.z, message.orientation.w = z, w
        for name, value in (("angular_velocity", rate), ("linear_acceleration", force)):
            seen = self.habits.sensor.inv().apply(value)
            vector = getattr(message, name)
            vector.x, vector.y, vector.z = map(float, seen)
        return message

    def _other(self, name):
        section = self.vehicle.sensors.mounted[name]
        frame = f"{name}_link_fsd"
        if hasattr(section, "noise_pa"):
            return self._depth(section, self._stamped(FluidPressure(), frame))
        return self._velocity(section, self._stamped(TwistWithCovarianceStamped(), frame))

    def _depth(self, section, message):
        sea, noise = self.vehicle.environment, section.noise_pa * self.rng.standard_normal()
        head = sea.water_density_kg_m3 * sea.gravity_m_s2 * (DEPTH + section.position_m[2])
        message.fluid_pressure = sea.atmospheric_pressure_pa + head + noise
        return message

    def _velocity(self, section, message):
        over = np.array([SPEED, 0.0, 0.0]) + np.cross([0.0, 0.0, RATE], section.position_m)
        linear = message.twist.twist.linear
        noisy = over + section.noise_m_s * self.rng.standard_normal(3)
        linear.x, linear.y, linear.z = map(float, noisy)
        return message

    def errors(self, since=0):
        """Errors of position, attitude and velocity (k, 9) in sigma, axis by axis.

        Nobody measures the position north and east: it counts from the first odometry on.
        """
        begin, rows = self.odometry[0].stamp, []
        for each in self.odometry[since:]:
            now, then = (RATE * 1e-9 * (s - self.habits.since) for s in (each.stamp, begin))
            there, start = (RADIUS * np.array([np.sin(a), -np.cos(a), 0.0]) for a in (now, then))
            turn = Rotation.from_quat(each.quaternion) * Rotation.from_euler("z", now).inv()
            off = each.position - (there - start) - [0.0, 0.0, DEPTH]
            speed = each.nu[:3] - [SPEED, 0.0, 0.0]
            pose, twist = np.diagonal(each.pose_covariance), np.diagonal(each.twist_covariance)
            error = np.concatenate([off, turn.as_rotvec(), speed])
            rows.append(error / np.sqrt(np.concatenate([pose, twist[:3]])))
        return np.array(rows)
