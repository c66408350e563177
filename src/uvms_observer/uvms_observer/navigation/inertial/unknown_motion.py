"""What the inertial unit did not tell: the state becomes less certain by it.

In a gap between its samples a vehicle may have done anything that vehicles do. Its acceleration is
taken to have been off by a constant of std a and its rate by one of std w, so that after the time t
without a sample the velocity is off by a t, the position by a t^2 / 2 and the attitude by w t; and
while the attitude is off by w t, gravity g leans into the velocity, g w t^2 / 2.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_kernel
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_observer.navigation.state import Fields, NavigationState

ACCELERATION_M_S2 = 0.3
"""Std a: a working vehicle at full thrust has about this much."""
RATE_RAD_S = 0.2
"""Std w: 11 deg/s, a fast turn of a working vehicle."""
GAP = 1.5
"""Periods of the unit from one sample on after which one is missing."""


def gap_spread(begin: float, end: float, gravity: float) -> tuple[Array, Array]:
    """Std of turn (3,) rad and change of velocity (3,) m/s from `begin` to `end` s of a gap.

    Their squares add up over the pieces of a gap to those of the whole.
    """
    lean = gravity * RATE_RAD_S / 2.0
    turn = RATE_RAD_S * np.sqrt(end**2 - begin**2)
    speed = [ACCELERATION_M_S2 * t + lean * t**2 for t in (begin, end)]
    return np.full(3, turn), np.full(3, np.sqrt(speed[1] ** 2 - speed[0] ** 2))


@exact_kernel
def spread(fields: Fields, turn: Array, change: Array, dt: float) -> None:
    """Add to the covariance a turn and a change of velocity over dt that are not known.

    Args:
        fields: of the state.
        turn: (3,) rad, std about the body axes.
        change: (3,) m/s, std along the body axes; the position is off by half of it times dt.
        dt: s.
    """
    state = NavigationState(*fields)
    R, P = quat_to_matrix(state.quaternion), state.covariance
    for i in range(3):
        for j in range(3):
            turned, moved = 0.0, 0.0
            for k in range(3):
                turned += R[i, k] * R[j, k] * turn[k] ** 2
                moved += R[i, k] * R[j, k] * change[k] ** 2
            P[6 + i, 6 + j] += turned
            P[3 + i, 3 + j] += moved
            P[i, j] += 0.25 * dt**2 * moved
            P[i, 3 + j] += 0.5 * dt * moved
            P[3 + i, j] += 0.5 * dt * moved


@exact_kernel
def change_velocity(fields: Fields, change: Array) -> None:
    """Change the velocity by `change` (3,) m/s, body axes."""
    state = NavigationState(*fields)
    R = quat_to_matrix(state.quaternion)
    for i in range(3):
        for k in range(3):
            state.velocity[i] += R[i, k] * change[k]
