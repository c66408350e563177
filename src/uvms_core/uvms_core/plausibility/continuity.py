"""Plans against the ones before: a reference begins where the last one ended, and has no steps."""

from collections.abc import Mapping

import numpy as np

from uvms_core.signals import Array, Reference, to_nanoseconds

GAP = to_nanoseconds(0.5)
"""After this time without a plan, ns, the next one may begin anywhere: the planner was restarted,
or the vehicle has drifted."""
STEP_M = 2.0
"""A planner that is restarted holds the measured pose, which is off the old plan by the tracking
error."""
STEP_RAD = 0.5
"""The same for a joint's angle."""
STEP_M_S = 2.0
"""Step of a planned velocity, m/s and rad/s: a plan is cut off at once."""
STEP_M_S2 = 4.0
"""Step of a planned acceleration, m/s^2 and rad/s^2: plans may have corners in their speed."""
STEP_LIMITS = 4.0
"""Step of a joint's planned rate and acceleration in its limits: from full one way to full the
other is 2, and twice that for plans that are scaled beyond the limits."""


class Continuity:
    """Largest step of each field of a reference from one of its samples to the next.

    Args:
        steps: by field, for every column of it or for all.
    """

    def __init__(self, steps: Mapping[str, Array | float]) -> None:
        self._steps = dict(steps)

    def fault(self, last: Reference, now: Reference) -> str | None:
        """The first step that is too large, in words; None where there is none."""
        if now.stamp - last.end > GAP:
            return None
        for field, allowed in self._steps.items():
            values = np.vstack([_at(last, field, now.stamp), getattr(now, field)])
            if field == "quaternion":
                values = _in_one_half(values)
            steps = np.abs(np.diff(values, axis=0)).max(axis=0)
            wrong = np.flatnonzero(~(steps <= allowed))
            if wrong.size:
                column = int(wrong[0])
                limit = np.broadcast_to(allowed, steps.shape)[column]
                return (
                    f"{field} of column {column} steps by {steps[column]:.3g};"
                    f" possible for this vehicle is {limit:.3g}"
                )
        return None


def _in_one_half(quaternions: Array) -> Array:
    """The same rotations with signs such that neighbours are near each other."""
    agree = np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1]) >= 0.0
    signs = np.concatenate([[1.0], np.cumprod(np.where(agree, 1.0, -1.0))])
    return quaternions * signs[:, None]


def _at(last: Reference, field: str, stamp: int) -> Array:
    """The sample of the last plan that is nearest to a stamp, one row."""
    values: Array = getattr(last, field)
    if stamp >= last.end:
        return values[-1]
    index = np.searchsorted(last.times, 1e-9 * (stamp - last.stamp))
    return np.asarray(values[min(int(index), len(values) - 1)])
