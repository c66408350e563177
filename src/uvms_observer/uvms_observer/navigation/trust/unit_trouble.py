"""What there is to say of an inertial unit whose samples are used, though it is not as stated."""

import numpy as np

from uvms_core.diagnostics import WARN, Trouble
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_observer.navigation.inertial.condition import FORCE_FLOOR_M_S2, RATE_FLOOR_RAD_S
from uvms_observer.navigation.state import ACCELEROMETER_BIAS, GYRO_BIAS, NavigationState

NOISY = 5.0
"""Times the white noise of the vehicle file."""
BIASED = 10.0
"""Times the bias of the vehicle file."""
SURE = 3.0
"""Standard deviations of the estimate by which a bias is beyond that."""
LEAST_RATE_DEG_S, LEAST_FORCE_M_S2 = 0.02, 0.05
"""Biases that are nothing to speak of: the Earth turns, and gravity is not the same everywhere."""


class UnitTrouble:
    """Compares the estimate with what the vehicle file says of the unit.

    Args:
        vehicle: its inertial unit.
    """

    def __init__(self, vehicle: Vehicle) -> None:
        imu = vehicle.sensors.imu
        rate, force = np.radians(imu.gyro_noise_deg_s), imu.accelerometer_noise_m_s2
        self._noise = NOISY * max(rate, RATE_FLOOR_RAD_S), NOISY * max(force, FORCE_FLOOR_M_S2)
        self._rate = np.radians(max(BIASED * imu.gyro_bias_deg_s, LEAST_RATE_DEG_S))
        self._force = max(BIASED * imu.accelerometer_bias_m_s2, LEAST_FORCE_M_S2)

    def __call__(self, state: NavigationState, attitude_is_frozen: bool) -> Trouble | None:
        """None where all is as stated."""
        noise, std = np.sqrt(state.excess), np.sqrt(np.diag(state.covariance))
        rate, force = float(noise[:3].max()), float(noise[3:].max())
        texts = ["the imu's attitude has not changed"] if attitude_is_frozen else []
        if rate > self._noise[0]:
            texts.append(f"the imu's rates have noise of {np.degrees(rate):.2g} deg/s")
        if force > self._noise[1]:
            texts.append(f"the imu's forces have noise of {force:.2g} m/s^2")
        if _is_beyond(state.gyro_bias, std[GYRO_BIAS], self._rate):
            worst = np.degrees(np.abs(state.gyro_bias).max())
            texts.append(f"the imu's rates are off by {worst:.2g} deg/s against the attitude")
        if _is_beyond(state.accelerometer_bias, std[ACCELEROMETER_BIAS], self._force):
            worst = np.abs(state.accelerometer_bias).max()
            texts.append(f"the imu's forces are off by {worst:.2g} m/s^2 against other sensors")
        return Trouble(WARN, "; ".join(texts)) if texts else None


def _is_beyond(bias: Array, std: Array, limit: float) -> bool:
    return bool((np.abs(bias) - SURE * std > limit).any())
