"""Noise of the estimated pose and velocity that is left when the navigation has settled.

Each axis by itself, as a filter of one state x that is driven by the integral of a noisy rate of
variance q in the time between two measurements of variance r: after a measurement its variance is
P = (sqrt(q^2 + 4 q r) - q) / 2, the steady state of the scalar Riccati equation (Bar-Shalom, Li and
Kirubarajan, Estimation with Applications to Tracking and Navigation, sec. 5.2.5).

Biases and drift are left out: they move the vehicle, and cost no thrust from tick to tick.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle


def sensor_noise(vehicle: Vehicle) -> tuple[Array, Array]:
    """Standard deviations of pose (6,) m and rad and velocity (6,) m/s and rad/s, body axes.

    North and east are integrated from the velocity and have a drift alone, no noise of their own.
    Attitude is the gyro's integral, corrected by the compass; velocity that of the accelerometer,
    corrected by the DVL; depth that of the velocity, corrected by the pressure. Rates are the
    gyro's.
    """
    imu = vehicle.sensors.imu
    tick = 1.0 / imu.rate_hz
    gyro = np.radians(imu.gyro_noise_deg_s)
    tilt = settled(gyro * tick, np.radians(imu.roll_pitch_noise_deg))
    heading = settled(gyro * tick, np.radians(imu.heading_noise_deg))
    velocity = _velocity_noise(vehicle)
    depth = _depth_noise(vehicle, velocity)
    pose = np.array([0.0, 0.0, depth, tilt, tilt, heading])
    return pose, np.array([velocity] * 3 + [gyro] * 3)


def _velocity_noise(vehicle: Vehicle) -> float:
    """Without a DVL it is integrated, and has what one tick of the accelerometer adds."""
    imu, dvl = vehicle.sensors.imu, vehicle.sensors.dvl
    if dvl is None:
        return imu.accelerometer_noise_m_s2 / imu.rate_hz
    tick = 1.0 / imu.rate_hz
    return settled(imu.accelerometer_noise_m_s2 * np.sqrt(tick / dvl.rate_hz), dvl.noise_m_s)


def _depth_noise(vehicle: Vehicle, velocity: float) -> float:
    """Without a pressure sensor it is integrated, as north and east are."""
    pressure = vehicle.sensors.pressure
    if pressure is None:
        return 0.0
    return settled(velocity / pressure.rate_hz, pressure.noise_pa / _pascals_per_metre(vehicle))


def settled(drive: float, measurement: float) -> float:
    """Std of a filtered state from the std that a step adds and that of its measurement."""
    q, r = drive**2, measurement**2
    return float(np.sqrt(0.5 * (np.sqrt(q**2 + 4.0 * q * r) - q)))


def _pascals_per_metre(vehicle: Vehicle) -> float:
    water = vehicle.environment
    return max(water.water_density_kg_m3 * water.gravity_m_s2, 1.0)
