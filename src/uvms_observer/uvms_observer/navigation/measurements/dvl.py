"""The Doppler velocity log: velocity of its transducer over ground."""

import numpy as np
from numba import njit

from uvms_core.signals import Array, DvlSample
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Dvl
from uvms_dynamics.kernels.rotations import quat_to_matrix, skew
from uvms_observer.navigation.correction import correct
from uvms_observer.navigation.installation import rate_variance
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import DVL_SCALE, SIZE, NavigationState


class DvlVelocity(Measurement):
    """(1 + s) (R^T v + w x d) + n, with the scale error s in the state."""

    size = 3

    def __init__(self, vehicle: Vehicle, section: Dvl, config: NavigationConfig) -> None:
        super().__init__(vehicle, section, config)
        self._variance = max(section.noise_m_s, config.noise_floor.velocity_m_s) ** 2
        self._rate_variance = rate_variance(vehicle)
        self.initial_variance = {DVL_SCALE: float(np.square(section.scale_error))}

    def correct(self, state: NavigationState, sample: DvlSample, rate: Array, gate: float) -> float:
        """As `Measurement.correct`."""
        return correct_velocity(
            state, sample.velocity, self._variance, self.lever, rate, self._rate_variance, gate
        )


@njit(cache=True)
def velocity(state: NavigationState, lever: Array, rate: Array) -> tuple[Array, Array]:
    """Velocity that the DVL should read (3,) m/s, body axes, and H."""
    R = quat_to_matrix(state.quaternion)
    arm = skew(lever)
    motion = R.T @ state.velocity - arm @ (rate - state.gyro_bias)
    scale = 1.0 + state.instrument_bias[0]
    H = np.zeros((3, SIZE))
    H[:, 3:6] = scale * R.T
    H[:, 6:9] = scale * (R.T @ skew(state.velocity))
    H[:, 9:12] = scale * arm
    H[:, 18] = motion
    return scale * motion, H


@njit(cache=True)
def correct_velocity(
    state: NavigationState,
    measured: Array,
    variance: float,
    lever: Array,
    rate: Array,
    rate_variance: float,
    gate: float,
) -> float:
    """DVL: velocity (3,) m/s in body axes; the gyro's noise enters by the lever arm."""
    expected, H = velocity(state, lever, rate)
    arm = skew(lever)
    N = variance * np.eye(3) + rate_variance * (arm @ np.ascontiguousarray(arm.T))
    return correct(state, H, measured - expected, N, gate)
