"""The vehicle's law: S-surface feedback, model dynamics and observed disturbance, eq. (22)."""

import numpy as np

from uvms_control.s_surface import SSurface
from uvms_control.tracking_error import TrackingError
from uvms_control.vehicle_config import VehicleControlConfig
from uvms_core.signals import Array, Odometry
from uvms_dynamics import hull_bias_wrench

# The integral rests while the S-surface's argument is beyond this: u is then above tanh(1) = 0.76.
INTEGRATION_RANGE = 2.0


class VehicleController:
    """Eq. (22), with the integral of the error as the Delta-u of eq. (19)."""

    def __init__(self, model, config: VehicleControlConfig):
        """`model` from `uvms_dynamics.build_model`."""
        self._model = model
        self.law = SSurface(
            k_error=np.array(config.k_error),
            k_rate=np.array(config.k_rate),
            error_scale=np.array(config.error_scale),
            rate_scale=np.array(config.rate_scale),
            amplitude=np.array(config.amplitude),
        )
        self._k_integral = np.array(config.k_integral)
        self._limit = config.integral_limit
        self.reset()

    def reset(self) -> None:
        """Empty the integral."""
        self.delta_u = np.zeros(6)

    def step(
        self,
        odometry: Odometry,
        inertia: Array,
        disturbance: Array,
        tracking: TrackingError,
        dt: float,
    ) -> Array:
        """Wrench (6,) for the vehicle in its body frame, eq. (22).

            tau = M(q) [nu_dot_d + A (S(e, e_dot) + Delta-u)] + C nu + D nu - F_dis

        `inertia` M (6, 6): vehicle block of the whole system's mass matrix, added mass and arm
        included. `disturbance` F_dis (6,): what acts ON the vehicle (zero to leave it out);
        corrected from the print, where F_dis has the sign of a load to carry.
        """
        argument = self.law.argument(tracking.error, tracking.rate)
        self._integrate(tracking.error, argument, dt)
        feedback = self.law.acceleration_of(argument, self.delta_u)
        acceleration = tracking.acceleration + feedback
        bias = hull_bias_wrench(self._model, odometry.nu)
        return inertia @ acceleration + bias - disturbance

    def _integrate(self, error: Array, argument: Array, dt: float) -> None:
        """Integrate where the law is not saturated, within the limit (anti-windup)."""
        change = self._k_integral * error / self.law.error_scale * dt
        moved = self.delta_u + change * (np.abs(argument) < INTEGRATION_RANGE)
        self.delta_u = np.minimum(np.maximum(moved, -self._limit), self._limit)
