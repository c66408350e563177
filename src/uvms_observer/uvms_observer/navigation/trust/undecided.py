"""How far off the estimate may be while it is open whether a sensor lies or the estimate is wrong.

From the first sample that a gate rejects until `suspicion.py` has found the cause, the covariance
alone claims that the sensor lies. Until then what the sample would have changed is part of what is
said to be uncertain: a filter that may be wrong says so. Not where it is beyond what an inertial
unit could have made of the time since the last sample that fitted: then the sensor lies.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array, to_nanoseconds, to_seconds
from uvms_dynamics.kernels.rotations import quat_conjugate, quat_multiply, quat_to_rotation_vector
from uvms_observer.navigation.state import NavigationState
from uvms_observer.navigation.trust.innovation_gate import Tally

DECIDED = to_nanoseconds(2.0)
"""Time by which a cause is found, or is the sensor itself."""
ACCELERATION_M_S2 = 10.0
"""No accelerometer that has not failed altogether is off by more."""
RATE_RAD_S = 1.0
"""The same of a gyro."""
SIGMAS = 5.0
"""Of the estimate, beyond these."""
LOOSE = 1e4
"""Factor on the covariance with which a sample is believed."""


class Doubt(NamedTuple):
    """What the last sample that was rejected would have changed; nothing where the sensor lies."""

    change: Array  # (9,) of position, velocity and attitude, as in the error state
    is_open: bool


def believed(state: NavigationState) -> NavigationState:
    """A copy that believes the next sample rather than itself."""
    other = state.copied()
    other.covariance[:] *= LOOSE
    return other


def doubt(
    state: NavigationState, other: NavigationState, tally: Tally, before: Doubt | None, stamp: int
) -> Doubt:
    """After a sample that was rejected at `stamp`, ns, and that `other` has believed."""
    turn = quat_multiply(other.quaternion, quat_conjugate(state.quaternion))
    change = np.concatenate((
        other.position - state.position,
        other.velocity - state.velocity,
        quat_to_rotation_vector(turn),
    ))  # fmt: skip
    if before is not None and tally.row > 1:
        return Doubt(change, before.is_open)
    return Doubt(change, _is_possible(change, state.covariance, tally, stamp))


def _is_possible(change: Array, P: Array, tally: Tally, stamp: int) -> bool:
    """Whether inertial readings may have gone wrong by so much since the last sample."""
    if tally.used is None:
        return False
    dt = to_seconds(stamp - tally.used)
    limits = np.repeat(
        [0.5 * ACCELERATION_M_S2 * dt**2, ACCELERATION_M_S2 * dt, RATE_RAD_S * dt], 3
    )
    return bool((np.abs(change) <= limits + SIGMAS * np.sqrt(np.diag(P)[:9])).all())


def widened(
    P: Array, doubts: Mapping[str, Doubt], tallies: Mapping[str, Tally], stamp: int
) -> Array | None:
    """The covariance with all that is undecided at `stamp`, ns; None where nothing is.

    Both by the name of the sensor.

    An error that grows with the square of time has grown by ((n + 1) / n)^2 until the sample after
    the n-th.
    """
    wider = None
    for name, each in doubts.items():
        tally = tallies[name]
        if each.is_open and tally.since is not None and stamp - tally.since < DECIDED:
            wider = P.copy() if wider is None else wider
            growth = ((tally.row + 1) / tally.row) ** 2
            wider[:9, :9] += growth**2 * np.outer(each.change, each.change)
    return wider
