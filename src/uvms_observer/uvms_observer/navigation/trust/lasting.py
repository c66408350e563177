"""What a sensor that has jumped away is off by, as a state beside the filter's own.

A sensor that begins to lie with a jump, as a DVL that loses the bottom and sees the water, mostly
goes on as before, off by something that lasts: its changes are still true. So from the first
sample that is rejected on it reads

    z = h(x) + o + n,   do = -H e - n at first, so that it tells nothing yet,

with the offset o in the sensor's own axes. o is known as well as the estimate was then, and a poor
inertial unit is held by the sensor's changes. It may change: of first order (Gauss-Markov), with a
std as large as the jump, correlated over `noise.LASTING_S`, and over a turn of the vehicle by a
radian, since it may last in the world or in the sensor. Hence the estimate is never more certain
than the sensor is off for long, and nothing is averaged away.

The state is kept as the last of the targets (`target.py`), whose errors the filter carries along;
o is its place. Schmidt, *Application of state-space methods to navigation problems* (1966), for
errors that count and are not told; here this one is told by the jump itself.
"""

from enum import Enum
from functools import cache
from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.rotations import quat_conjugate, quat_multiply
from uvms_observer.navigation.correction import add_error
from uvms_observer.navigation.measurements.base import Linear
from uvms_observer.navigation.measurements.noise import LASTING_S
from uvms_observer.navigation.state import MOUNTING, SIZE, NavigationState
from uvms_observer.navigation.target import (
    MOST_TARGETS,
    POSE,
    TARGET_SIZE,
    move_targets,
    with_target,
)
from uvms_observer.navigation.trust.innovation_gate import (
    FEW,
    JUMP,
    READMITTED,
    RETURNED,
    quantile,
)

LEAST = 1.0 / 3.0
"""Part of what it is off by now by which a sensor jumps back at least."""
AGAIN = 2
"""Samples that must agree after such a jump."""
KNOWN = 10.0
"""Standard deviations of the estimate in the first jump, from which on agreeing says something: a
lie of that size is as near by chance once in a thousand times."""
AXES = 3
"""Dimension of a measurement whose offset is carried."""
PLACE = slice(-POSE, -POSE + AXES)
OWN = slice(-TARGET_SIZE, -TARGET_SIZE + AXES)
NO_TURN = np.array([0.0, 0.0, 0.0, 1.0])


class Lasting(NamedTuple):
    """What is kept of an offset."""

    name: str  # of the sensor that is off
    by: float  # size of the jump, in the unit of the measurement; std of the offset in the end
    attitude: Array  # (4,) of the vehicle at the jump
    stamp: int  # ns, of its last sample
    turned: float = 0.0  # rad, greatest angle from that attitude so far
    lasts: float = LASTING_S  # s
    added: float = 0.0  # variance by which the offset has become uncertain since the last sample
    carried: bool = True  # whether it is part of the state: not where the sensor says nothing
    rests: bool = False  # whether it has read zero since the jump
    returns: bool = False  # whether it has jumped to where it agrees
    agreeing: int = 0  # samples in a row since then, or with a well known estimate
    misfit: float = 0.0  # sum of the squared distances of its changes, less their dimension


class Verdict(Enum):
    """What a sample of a sensor that is off says."""

    BACK = "it is right again"
    GONE = "it has jumped to something else"
    ON = "it goes on as before"


def has_room(state: NavigationState) -> bool:
    """Whether the filter can carry one more."""
    return len(state.cross) < TARGET_SIZE * MOST_TARGETS


def with_offset(state: NavigationState, sample: Linear) -> NavigationState:
    """The state with the offset that this sample has if the estimate is right."""
    wider = with_target(state, np.zeros(3), NO_TURN, np.zeros(TARGET_SIZE))
    P, H = state.covariance, sample.H
    wider.target[PLACE] = sample.residual
    wider.cross[OWN] = -H @ P
    shared = -H @ state.cross.T
    wider.target_covariance[OWN, : len(state.cross)] = shared
    wider.target_covariance[: len(state.cross), OWN] = shared.T
    wider.target_covariance[OWN, OWN] = H @ P @ H.T + sample.N
    return wider


def without_offset(state: NavigationState) -> NavigationState:
    """The state without it; all else is as it was."""
    rest = len(state.cross) - TARGET_SIZE
    return state._replace(
        target=state.target[:-POSE].copy(),
        cross=state.cross[:rest].copy(),
        target_covariance=state.target_covariance[:rest, :rest].copy(),
    )


def aged(state: NavigationState, kept: Lasting, stamp: int) -> Lasting:
    """Carry the offset to the stamp (ns), in place."""
    turned = max(kept.turned, _angle(kept.attitude, state.quaternion))
    gone = 1e-9 * (stamp - kept.stamp) / kept.lasts + 0.5 * (turned**2 - kept.turned**2)
    phi = float(np.exp(-gone))
    state.target[PLACE] *= phi
    state.cross[OWN] *= phi
    state.target_covariance[OWN] *= phi
    state.target_covariance[:, OWN] *= phi
    added = (1.0 - phi**2) * kept.by**2
    state.target_covariance[OWN, OWN] += added * np.eye(AXES)
    return kept._replace(turned=turned, stamp=stamp, added=added)


def _angle(before: Array, after: Array) -> float:
    turn = quat_multiply(after, quat_conjugate(before))
    return 2.0 * float(np.arctan2(np.linalg.norm(turn[:3]), abs(turn[3])))


def expected(state: NavigationState, sample: Linear) -> tuple[Array, Array]:
    """Residual (3,) of a sample whose offset is known as it is, and its covariance (3, 3)."""
    H, P = _jointly(state, sample.H)
    return sample.residual - state.target[PLACE], H @ P @ H.T + sample.N


def correct_by_changes(state: NavigationState, sample: Linear) -> None:
    """Correct the state and the offset by a sample of the sensor that has it, in place.

    Scale and misalignment are left as they are, as by `correction.correct`.
    """
    H, P = _jointly(state, sample.H)
    S = H @ P @ H.T + sample.N
    K = np.linalg.solve(S, H @ P).T
    K[list(MOUNTING)] = 0.0
    kept = np.eye(len(P)) - K @ H
    P = kept @ P @ kept.T + K @ sample.N @ K.T
    P = 0.5 * (P + P.T)
    e = K @ (sample.residual - state.target[PLACE])
    state.covariance[:] = P[:SIZE, :SIZE]
    state.cross[:] = P[SIZE:, :SIZE]
    state.target_covariance[:] = P[SIZE:, SIZE:]
    add_error(state, e[:SIZE])
    move_targets(state, e[SIZE:])


def _jointly(state: NavigationState, H: Array) -> tuple[Array, Array]:
    """H and P of the state and all that is beside it."""
    more = np.zeros((AXES, len(state.cross)))
    more[:, OWN] = np.eye(AXES)
    P = np.block([[state.covariance, state.cross.T], [state.cross, state.target_covariance]])
    return np.hstack([H, more]), P


def judged(state: NavigationState, kept: Lasting, sample: Linear) -> tuple[Verdict, Lasting]:
    """Whether the sensor is right again, from a sample before it is used; what is kept after it.

    It is where it has jumped to where it agrees, and stays there; or where it goes on agreeing
    though the estimate is known so much better than what it jumped by that it would not if it were
    off. A jump is more than noise, whatever the offset may have done meanwhile.
    """
    change, spread = expected(state, sample)
    own = own_covariance(state, sample)
    distance = _squared(sample.residual, own)
    kept = kept._replace(misfit=kept.misfit + _squared(change, spread) - AXES)
    if _squared(change, spread - kept.added * np.eye(AXES)) > _limit(JUMP):
        far = np.linalg.norm(change) > LEAST * np.linalg.norm(state.target[PLACE])
        return Verdict.GONE, kept._replace(returns=bool(far) and distance <= _limit(RETURNED))
    is_known = bool(KNOWN**2 * own.diagonal().max() < kept.by**2)
    limit, needed = (RETURNED, AGAIN) if kept.returns else (READMITTED, FEW)
    is_good = (kept.returns or is_known) and distance <= _limit(limit)
    after = kept._replace(
        returns=kept.returns and is_good, agreeing=kept.agreeing + 1 if is_good else 0
    )
    return (Verdict.BACK if after.agreeing >= needed else Verdict.ON), after


def agrees(state: NavigationState, sample: Linear) -> bool:
    """Whether a sample may be right by itself."""
    return _squared(sample.residual, own_covariance(state, sample)) <= _limit(RETURNED)


def own_covariance(state: NavigationState, sample: Linear) -> Array:
    """Covariance (3, 3) of the residual of a sample that is right."""
    S: Array = sample.H @ state.covariance @ sample.H.T + sample.N
    return S


@cache
def _limit(probability: float) -> float:
    return quantile(AXES, probability)


def _squared(residual: Array, covariance: Array) -> float:
    return float(residual @ np.linalg.solve(covariance, residual))
