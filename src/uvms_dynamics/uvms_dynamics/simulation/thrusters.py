"""Thrusters: their wrench on the vehicle and how they follow a command."""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels.arithmetic import bounded
from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.kernels.numba_internals.primitives import maximum, minimum
from uvms_dynamics.model.thruster_matrix import thruster_matrix

Thrusters = Array
"""Table (m, 12) of m thrusters for the kernels, SI: wrench per newton (6), greatest thrust astern
(negative) and ahead, 1 / time constant, slew limit, and what a fault makes of a command: share of
it that is realised, and a thrust that does not depend on it."""

ASTERN, AHEAD, PER_TIME_CONSTANT, SLEW, SHARE, STUCK = np.arange(6, 12)


def build_thrusters(vehicle: Vehicle) -> Thrusters:
    """Thruster tables of a vehicle."""
    parts = vehicle.thrusters
    drives = [
        [part.astern_n, part.ahead_n, 1.0 / part.time_constant_s, part.slew_limit_n_s, 1.0, 0.0]
        for part in parts
    ]
    return np.hstack([thruster_matrix(vehicle).T, drives])


@inner
def thrust_rate(thrusters, i, thrust, command):
    """Rate of change of thrust i, N/s: (s u + u_0 - T) / tau within the slew limit.

    The command u is cut at the thruster's limits. A whole thruster has s = 1 and u_0 = 0, a stuck
    one s = 0.
    """
    slew = thrusters[i, SLEW]
    command = minimum(maximum(command, thrusters[i, ASTERN]), thrusters[i, AHEAD])
    target = command * thrusters[i, SHARE] + thrusters[i, STUCK]
    return bounded((target - thrust) * thrusters[i, PER_TIME_CONSTANT], slew)
