"""What the filter takes from the vehicle file: lever arms from the IMU, and the sensors' errors."""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.propagation import ProcessNoise


class Installation(NamedTuple):
    """Sensors as the filter needs them: SI units, variances instead of deviations."""

    body: Array  # (3,) m, from the IMU to the body origin, body axes; so are the next three
    dvl: Array
    pressure: Array
    gps: Array
    gravity: float  # m/s^2
    process: ProcessNoise
    attitude_variance: Array  # (3,) rad^2, gyrocompass's white noise about the body axes
    rate_variance: float  # rad^2/s^2, white noise of one gyro sample
    velocity_variance: float  # m^2/s^2
    depth_variance: float  # m^2
    position_variance: Array  # (3,) m^2, north, east, down
    instrument_variance: Array  # (2,) of the DVL's scale, and of the depth's bias in m^2
    surface_pressure: float  # Pa
    pressure_gradient: float  # Pa/m
    datum: tuple[float, float]  # deg, latitude and longitude of map_ned's origin


def installation(vehicle: Vehicle, config: NavigationConfig) -> Installation:
    """The sensors of this vehicle, with the configuration's factors and floors on their noise."""
    sensors, sea, floor = vehicle.sensors, vehicle.environment, config.noise_floor
    imu, dvl, pressure, gps = sensors.imu, sensors.dvl, sensors.pressure, sensors.gps
    gradient = sea.water_density_kg_m3 * sea.gravity_m_s2
    tilt = max(imu.roll_pitch_noise_deg, floor.attitude_deg)
    heading = max(imu.heading_noise_deg, floor.attitude_deg)
    horizontal = max(gps.horizontal_noise_m, floor.position_m)
    vertical = max(gps.vertical_noise_m, floor.position_m)
    return Installation(
        body=-np.array(imu.position_m),
        dvl=np.subtract(dvl.position_m, imu.position_m),
        pressure=np.subtract(pressure.position_m, imu.position_m),
        gps=np.subtract(gps.position_m, imu.position_m),
        gravity=sea.gravity_m_s2,
        process=_process_noise(vehicle, config),
        attitude_variance=np.radians([tilt, tilt, heading]) ** 2,
        rate_variance=float(np.radians(imu.gyro_noise_deg_s)) ** 2,
        velocity_variance=max(dvl.noise_m_s, floor.velocity_m_s) ** 2,
        depth_variance=max(pressure.noise_pa / gradient, floor.depth_m) ** 2,
        position_variance=np.array([horizontal, horizontal, vertical]) ** 2,
        instrument_variance=np.array([dvl.scale_error, pressure.bias_pa / gradient]) ** 2,
        surface_pressure=sea.atmospheric_pressure_pa,
        pressure_gradient=gradient,
        datum=(sea.datum_latitude_deg, sea.datum_longitude_deg),
    )


def _process_noise(vehicle: Vehicle, config: NavigationConfig) -> ProcessNoise:
    """White noise of one sample at rate f has the spectral density variance / f."""
    imu = vehicle.sensors.imu
    gyro = np.radians(imu.gyro_noise_deg_s) * config.gyro_noise_scale
    accelerometer = imu.accelerometer_noise_m_s2 * config.accelerometer_noise_scale
    biases = [
        *np.radians([imu.gyro_bias_deg_s] * 3),
        *[imu.accelerometer_bias_m_s2] * 3,
        *np.radians([imu.roll_pitch_bias_deg, imu.roll_pitch_bias_deg, imu.heading_bias_deg]),
    ]
    return ProcessNoise(
        gyro=float(gyro**2 / imu.rate_hz),
        accelerometer=float(accelerometer**2 / imu.rate_hz),
        bias_variance=np.array(biases) ** 2,
        bias_time_constant=float(imu.bias_time_constant_s),
    )
