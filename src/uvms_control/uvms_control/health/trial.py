"""Trial thrusts of a thruster that is taken to be dead, to notice when it works again.

A thruster that is left out of the allocation gives no evidence. So it is told a small thrust now
and then, forward and back again: a dead one gives nothing, and of a whole one the vehicle feels a
push that is far below what it holds against, and that the observer tells from noise.
"""

import numpy as np
from numpy.typing import NDArray

from uvms_core.signals import Array, to_nanoseconds

EVERY_S = 4.0
"""From one test to the next."""
FOR_S = 1.2
"""Half of it forward and half of it back, several time constants of a thruster each."""
SHARE = 0.03
"""Of the greater limit: some standard deviations of what the motion of a tick tells of a thrust."""


class TrialThrust:
    """Thrusts (m,) to be added for thrusters that are not used.

    Args:
        limits: greatest thrusts astern and ahead (2, m), N; one that does not reverse is only
            tested ahead.
        least: smallest thrusts but none, astern and ahead (2, m), N.
    """

    def __init__(self, limits: Array, least: Array) -> None:
        small = SHARE * np.maximum(-limits[0], limits[1])
        self._ahead = np.minimum(np.maximum(small, least[1]), limits[1])
        self._astern = np.maximum(np.minimum(-small, least[0]), limits[0])
        self._every, self._half = to_nanoseconds(EVERY_S), to_nanoseconds(0.5 * FOR_S)

    def at(self, stamp: int, untried: NDArray[np.bool_]) -> Array | None:
        """Thrusts (m,) N at a stamp, None where there are none.

        Args:
            stamp: ns.
            untried: (m,) thrusters that are not used.
        """
        phase = stamp % self._every
        if phase >= 2 * self._half or not untried.any():
            return None
        return np.where(untried, self._ahead if phase < self._half else self._astern, 0.0)
