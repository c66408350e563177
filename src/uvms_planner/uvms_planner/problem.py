"""One planner step in the form that the kernels take: state, bounds, target and weights.

The planned configuration is c = (x, y, z, psi, q): the vehicle's position in map_ned (m), its yaw
(rad; roll = pitch = 0 for the planned vehicle) and the joints (rad); m = 4 + n numbers. A candidate
is the increment of c over one step.
"""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import inner

VEHICLE = 4  # x, y, z, psi stand before the joints


class StepProblem(NamedTuple):
    """Everything that decides how good a candidate is (a named tuple, which numba accepts)."""

    configuration: Array  # (m,) c at the start of the step
    previous: Array  # (m,) increment of the step before
    lower: Array  # (m,) least increment
    upper: Array  # (m,) greatest increment
    reach: Array  # (m,) increment that the cost counts as one, no bound
    jump: Array  # (m,) change of the increment that the cost counts as one
    readiness: Array  # (m,) inverse weights of the projection
    motion_weights: Array  # (m,) cost of an increment of one reach
    position: Array  # (3,) m, target of the end effector at the end of the step
    rotation: Array  # (3, 3) tool to map_ned at that time
    oriented: bool  # whether `rotation` counts
    position_tolerance: float  # m, e of eq. (17)
    orientation_tolerance: float  # rad
    iterations: int  # Newton steps of the projection
    damping: float
    step: float  # s
    lookahead: float  # s
    combined: bool  # whether restoring and coupling wrench are judged by their sum
    smoothness_weight: float
    roll_max: float  # rad
    pitch_max: float  # rad


@inner
def configuration_after(configuration, increment):
    """The configuration c (m,) at the end of a step.

    numba counts the references of all arrays of a tuple that it hands on; functions that are called
    for every candidate, as this one, take what they need of a `StepProblem` instead.
    """
    end = np.empty(increment.shape[0])
    for i in range(increment.shape[0]):
        end[i] = configuration[i] + increment[i]
    return end


@inner
def yaw_quaternion(yaw):
    """Quaternion (4,), body to world, of a level vehicle with this yaw in rad."""
    quaternion = np.zeros(4)
    quaternion[2] = np.sin(0.5 * yaw)
    quaternion[3] = np.cos(0.5 * yaw)
    return quaternion
