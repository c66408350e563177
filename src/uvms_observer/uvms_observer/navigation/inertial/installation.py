"""What the filter takes of the inertial unit from the vehicle file: SI units, variances."""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array, ImuSample
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Imu
from uvms_observer.navigation.begin.heading_reference import heading_bias
from uvms_observer.navigation.inertial.screen import ImuScreen
from uvms_observer.navigation.measurements.noise import ByAxis, beyond
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.propagation import ProcessNoise
from uvms_observer.navigation.state import COMPASS_BIAS, CURRENT, INERTIAL_BIASES, SIZE
from uvms_observer.navigation.trust.hull_model import HullModel, hull_model
from uvms_observer.navigation.trust.top_speed import speed_std

FAULTY_GYRO_DEG_S = 1.0
"""Std of the bias of a gyro that something has happened to."""
FAULTY_ACCELEROMETER_M_S2 = 1.0
"""The same of an accelerometer."""


Stated = tuple[ByAxis, ByAxis, ByAxis]
"""Variances of attitude, rad^2, rates, rad^2/s^2, and forces, m^2/s^4, body axes."""


class Installation(NamedTuple):
    """The inertial unit as the filter needs it."""

    body: Array  # (3,) m, from the IMU to the body origin, body axes
    gravity: float  # m/s^2
    process: ProcessNoise
    attitude_variance: Array  # (3,) rad^2, gyrocompass's white noise about the body axes
    rate_variance: float  # rad^2/s^2, white noise of one gyro sample
    force_noise: float  # m/s^2, std of the white noise of one accelerometer sample
    period: float  # s, between two samples
    faulty_bias_variance: Array  # (6,) of a unit that something has happened to
    speed: float  # m/s, std of the vehicle's velocity over ground
    hull: HullModel  # what the thrusts make of it
    known_variance: Stated  # of all errors of attitude, rates and forces, by axis, that
    # the vehicle file knows of

    def excess_of(self, sample: ImuSample) -> Stated:
        """What a sample states beyond those."""
        attitude, rate, force = self.known_variance
        return (
            beyond(sample.orientation_covariance, attitude),
            beyond(sample.angular_velocity_covariance, rate),
            beyond(sample.linear_acceleration_covariance, force),
        )

    def screen(self, rate: float, force: float) -> ImuScreen:
        """For readings with so much more noise, variances."""
        return ImuScreen(
            (self.rate_variance + rate) ** 0.5, (self.force_noise**2 + force) ** 0.5, self.period
        )


def installation(vehicle: Vehicle, config: NavigationConfig) -> Installation:
    """The unit of this vehicle, with the configuration's factors and floors on its noise."""
    return Installation(
        body=-np.array(vehicle.sensors.imu.position_m),
        gravity=vehicle.environment.gravity_m_s2,
        process=_process_noise(vehicle, config),
        attitude_variance=attitude_variance(vehicle, config),
        rate_variance=rate_variance(vehicle),
        force_noise=vehicle.sensors.imu.accelerometer_noise_m_s2,
        period=1.0 / vehicle.sensors.imu.rate_hz,
        faulty_bias_variance=np.repeat(
            [np.radians(FAULTY_GYRO_DEG_S) ** 2, FAULTY_ACCELEROMETER_M_S2**2], 3
        ),
        known_variance=known_variance(vehicle.sensors.imu),
        speed=speed_std(vehicle, config.current_std_m_s),
        hull=hull_model(vehicle, config),
    )


def attitude_variance(vehicle: Vehicle, config: NavigationConfig) -> Array:
    """White noise of the gyrocompass about the body axes, (3,) rad^2."""
    imu, floor = vehicle.sensors.imu, config.noise_floor.attitude_deg
    tilt = max(imu.roll_pitch_noise_deg, floor)
    heading = max(imu.heading_noise_deg, floor)
    return np.radians([tilt, tilt, heading]) ** 2


def rate_variance(vehicle: Vehicle) -> float:
    """White noise of one gyro sample, rad^2/s^2."""
    return float(np.radians(vehicle.sensors.imu.gyro_noise_deg_s)) ** 2


def known_variance(imu: Imu) -> Stated:
    """Of noise and bias together, as the vehicle file has them."""
    tilt = _sum_of_squares(*np.radians([imu.roll_pitch_noise_deg, imu.roll_pitch_bias_deg]))
    heading = _sum_of_squares(*np.radians([imu.heading_noise_deg, imu.heading_bias_deg]))
    rate = _sum_of_squares(*np.radians([imu.gyro_noise_deg_s, imu.gyro_bias_deg_s]))
    force = _sum_of_squares(imu.accelerometer_noise_m_s2, imu.accelerometer_bias_m_s2)
    return (tilt, tilt, heading), (rate, rate, rate), (force, force, force)


def _sum_of_squares(noise: float, bias: float) -> float:
    return float(noise * noise + bias * bias)


def _process_noise(vehicle: Vehicle, config: NavigationConfig) -> ProcessNoise:
    """White noise of one sample at rate f has the spectral density variance / f."""
    imu = vehicle.sensors.imu
    gyro = np.radians(imu.gyro_noise_deg_s) * config.gyro_noise_scale
    accelerometer = imu.accelerometer_noise_m_s2 * config.accelerometer_noise_scale
    biases = np.zeros(SIZE)
    biases[INERTIAL_BIASES] = [
        *np.radians([imu.gyro_bias_deg_s] * 3),
        *[imu.accelerometer_bias_m_s2] * 3,
    ]
    tilt = imu.roll_pitch_bias_deg
    biases[COMPASS_BIAS] = np.radians([tilt, tilt, imu.heading_bias_deg])
    if not imu.orientation:
        biases[COMPASS_BIAS] = [0.0, 0.0, heading_bias(vehicle)]
    biases[CURRENT:] = config.current_std_m_s
    decay = np.zeros(SIZE)
    decay[INERTIAL_BIASES] = decay[COMPASS_BIAS] = 1.0 / imu.bias_time_constant_s
    decay[CURRENT:] = 1.0 / config.current_time_constant_s
    return ProcessNoise(
        gyro=float(gyro**2 / imu.rate_hz),
        accelerometer=float(accelerometer**2 / imu.rate_hz),
        period=1.0 / imu.rate_hz,
        variance=np.square(biases[9:]),
        decay=decay[9:].copy(),
    )
