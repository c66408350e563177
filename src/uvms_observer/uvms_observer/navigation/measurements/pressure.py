"""The pressure sensor: its depth."""

import numpy as np

from uvms_core.signals import Array, PressureSample
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Pressure
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.kernels.products import product
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_observer.navigation.correction import correct
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.measurements.noise import as_white
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import DEPTH_BIAS, FURTHER, SIZE, Fields, NavigationState

ABOVE_M = 2.0
"""Depth above the surface that no vehicle has, whatever the weather has done to the air."""
DEEPEST_M = 12_000.0
"""Deeper than any sea."""


class PressureDepth(Measurement):
    """(p + R d)_z + b_p + n, with the bias b_p in the state; pressure grows by rho g with depth."""

    size = 1

    def __init__(self, vehicle: Vehicle, section: Pressure, config: NavigationConfig) -> None:
        super().__init__(vehicle, section, config)
        sea = vehicle.environment
        self._surface = sea.atmospheric_pressure_pa
        self._gradient = sea.water_density_kg_m3 * sea.gravity_m_s2
        self._variance = max(section.noise_pa / self._gradient, config.noise_floor.depth_m) ** 2
        self._known = section.noise_pa**2 + section.bias_pa**2
        self._has_bias_state = section is vehicle.sensors.pressure
        if self._has_bias_state:
            self.initial_variance = {DEPTH_BIAS: float(np.square(section.bias_pa / self._gradient))}
        else:
            self._variance += as_white(section.bias_pa / self._gradient, section.rate_hz)

    def fault(self, sample: PressureSample) -> str:
        """As `Measurement.fault`."""
        depth = (sample.pressure - self._surface) / self._gradient
        if -ABOVE_M <= depth <= DEEPEST_M:
            return ""
        return (
            f"pressure is {sample.pressure:.6g} Pa, a depth of {depth:.3g} m; it must be between"
            f" {-ABOVE_M:g} and {DEEPEST_M:g} m: the absolute pressure in Pa, with that of the air"
        )

    def correct(
        self, state: NavigationState, sample: PressureSample, rate: Array, gate: float
    ) -> float:
        """As `Measurement.correct`."""
        measured = (sample.pressure - self._surface) / self._gradient
        excess = max(sample.variance - self._known, 0.0) / self._gradient**2
        take = correct_depth if self._has_bias_state else correct_level
        return take(tuple(state), measured, self._variance + excess, self.lever, gate)


@exact_inner
def depth(state: NavigationState, lever: Array) -> tuple[Array, Array]:
    """Depth that the pressure should show (1,) m, and H."""
    offset = product(quat_to_matrix(state.quaternion), lever)
    H = np.zeros((1, SIZE))
    H[0, 2] = 1.0
    H[0, 6] = offset[1]
    H[0, 7] = -offset[0]
    H[0, DEPTH_BIAS] = 1.0
    reading = np.empty(1)
    reading[0] = state.position[2] + offset[2] + state.further[DEPTH_BIAS - FURTHER]
    return reading, H


@exact_kernel
def correct_depth(
    fields: Fields, measured: float, variance: float, lever: Array, gate: float
) -> float:
    """Pressure sensor: its depth in m."""
    state = NavigationState(*fields)
    residual, H = depth(state, lever)
    residual[0] = measured - residual[0]
    N = np.empty((1, 1))
    N[0, 0] = variance
    return correct(state, H, residual, N, gate)


@exact_kernel
def correct_level(
    fields: Fields, measured: float, variance: float, lever: Array, gate: float
) -> float:
    """Another gauge's depth in m: the bias of the state is not its own."""
    state = NavigationState(*fields)
    residual, H = depth(state, lever)
    residual[0] = measured - (residual[0] - state.further[DEPTH_BIAS - FURTHER])
    H[0, DEPTH_BIAS] = 0.0
    N = np.empty((1, 1))
    N[0, 0] = variance
    return correct(state, H, residual, N, gate)
