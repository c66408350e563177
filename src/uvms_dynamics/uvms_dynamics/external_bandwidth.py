"""The external wrench's bandwidth by rule: from noise, inertia, authority and lag.

The observer takes it, and the gains of the control law are laid out for it.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics import build_model, mass_matrix, thruster_matrix
from uvms_dynamics.joint_prediction import encoder_variances, loop_delay
from uvms_dynamics.sensor_noise import sensor_noise

NOISE_SHARE = 0.01
"""Share of an axis's thrust that the noise of the estimate may take, one standard deviation."""
PHASE_RAD = 1.0 / 3.0
"""Phase that the loop's delay costs at the bandwidth. What is fed forward follows the vehicle's own
motion where the model is wrong, and so acts as an integral; this leaves it 70 degrees of margin."""


def external_bandwidth(vehicle: Vehicle, period_s: float) -> Array:
    """Bandwidth K (6,) of the momentum residual, rad/s, axis by axis.

    The smaller of two bounds. Velocities with white noise of covariance S give the estimate noise
    of std K sqrt(diag M S M^T) (see `external`), which may take `NOISE_SHARE` of the axis's
    authority; the delay T of the loop may cost `PHASE_RAD` of phase, K T <= PHASE_RAD. Axes without
    thrust have the second alone: their estimate is not fed forward.

    Args:
        vehicle: inertia (arm stowed), thrusters, sensors.
        period_s: of the control loop.
    """
    fastest = PHASE_RAD / loop_delay(vehicle, period_s)
    q = np.radians(vehicle.arm.stowed_deg)
    inertia = mass_matrix(build_model(vehicle), q)[:6]
    rate = np.full(vehicle.n_joints, encoder_variances(vehicle)[1])
    momentum = np.sqrt(inertia**2 @ np.concatenate((sensor_noise(vehicle)[1] ** 2, rate)))
    authority = thrust_authority(vehicle)
    by_noise = NOISE_SHARE * authority / np.maximum(momentum, 1e-12)
    return np.where(authority > 0.0, np.minimum(by_noise, fastest), fastest)


def thrust_authority(vehicle: Vehicle) -> Array:
    """Greatest force or moment (6,) of all thrusters together about each body axis."""
    greatest = np.array([thruster.greatest_n for thruster in vehicle.thrusters])
    authority = np.abs(thruster_matrix(vehicle)) @ greatest
    authority[authority < 1e-9 * authority.max()] = 0.0  # rounding of directions
    return authority
