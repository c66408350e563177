"""The filter's state: the nominal state and the covariance of its error.

The error state e (SIZE,) is, with truth = estimate (+) error,

    e = (dp, dv, dtheta, db_g, db_a, db_c, ds, db_p, dm, dc):  R = Exp(dtheta) R_hat,
    all else additive.

dp, dv and dtheta are in the axes of map_ned. The point whose position and velocity are estimated is
the IMU, where its accelerometers measure, so that no angular acceleration is needed; the pose of
the body origin follows from the mounting position.

The biases are sensor errors that do not average out. Most of them cannot be distinguished from the
motion (a heading bias from a drift, for example); as states they are part of the covariance.

A further state is one more line below, and its starting variance (`begin/alignment.py`, or
`Measurement.initial_variance`); it is constant unless `propagation.py` says otherwise. Kernels take
places from here by name. SIZE is compiled into them.
"""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array

POSITION = slice(0, 3)
VELOCITY = slice(3, 6)
ATTITUDE = slice(6, 9)
GYRO_BIAS = slice(9, 12)
ACCELEROMETER_BIAS = slice(12, 15)
INERTIAL_BIASES = slice(9, 15)
COMPASS_BIAS = slice(15, 18)

FURTHER = COMPASS_BIAS.stop
"""First of the states that only single sensors read: `NavigationState.further`."""
DVL_SCALE = FURTHER
DEPTH_BIAS = DVL_SCALE + 1
DVL_MISALIGNMENT = DEPTH_BIAS + 1  # of three
MOUNTING = (DVL_SCALE, *range(DVL_MISALIGNMENT, DVL_MISALIGNMENT + 3))
CURRENT = DVL_MISALIGNMENT + 3  # of two
SIZE = CURRENT + 2
WIDEST = 6
"""Largest dimension of a measurement."""


class NavigationState(NamedTuple):
    """Nominal state and error covariance; the kernels change these arrays in place.

    Kernels that are called from Python take it as a plain tuple, `tuple(state)`: to take a named
    one apart costs numba as long as a small kernel runs.
    """

    position: Array  # (3,) m, of the IMU, map_ned
    velocity: Array  # (3,) m/s, of the IMU over ground, map_ned
    quaternion: Array  # (4,) body to map_ned
    gyro_bias: Array  # (3,) rad/s, body axes
    accelerometer_bias: Array  # (3,) m/s^2, body axes
    compass_bias: Array  # (3,) rad, of the gyrocompass, a turn about the body axes
    further: Array  # (SIZE - FURTHER,) as in the error state: scale error of the DVL; bias of the
    # depth, m; misalignment of the DVL, rad, a turn about the body axes; current, m/s, map_ned
    covariance: Array  # (SIZE, SIZE) of the error state
    innovation: Array  # (3, WIDEST) of the last measurement: residual, std of its noise, its own
    # std; zeros beyond its size
    reference: Array  # (3,) m/s, velocity after the last correction by the DVL, see `dvl.py`
    excess: Array  # (6,) variance of the white noise of the inertial unit's last sample beyond what
    # the vehicle file says: rates, rad^2/s^2, and forces, m^2/s^4, body axes; see `noise.py`
    target: Array = np.zeros(0)  # (7 k,) poses of k targets, see `target.py`
    cross: Array = np.zeros((0, SIZE))  # (6 k, SIZE) covariance of their errors with e
    target_covariance: Array = np.zeros((0, 0))  # (6 k, 6 k) of their errors

    def copied(self) -> "NavigationState":
        """The same values in arrays of their own."""
        return NavigationState(*[part.copy() for part in self])


Fields = tuple[Array, ...]
"""A `NavigationState` as a plain tuple."""


def empty_state() -> NavigationState:
    """At rest in the origin, level, facing north, sensors without bias, perfectly known."""
    return NavigationState(
        np.zeros(3),
        np.zeros(3),
        np.array([0.0, 0.0, 0.0, 1.0]),
        np.zeros(3),
        np.zeros(3),
        np.zeros(3),
        np.zeros(SIZE - FURTHER),
        np.zeros((SIZE, SIZE)),
        np.zeros((3, WIDEST)),
        np.zeros(3),
        np.zeros(6),
    )
