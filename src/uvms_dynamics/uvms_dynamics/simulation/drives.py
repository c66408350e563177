"""The drives of the thrusters: from commanded to realised thrust, before lag and slew."""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle


class ThrusterDrives:
    """What the drives make of commanded thrusts, before lag and slew.

    A drive turns the commanded thrust into its own command by the curve that is known of it, that
    of the vehicle file, and gives the thrust that its real curve has there. Where the two are the
    same it gives what was commanded, or the nearest to it that it can give.

    Args:
        known: the vehicle as its file describes it.
        real: the vehicle that is simulated, with as many thrusters.
    """

    def __init__(self, known: Vehicle, real: Vehicle) -> None:
        self._pairs = [
            (i, a, b)
            for i, (a, b) in enumerate(zip(known.thrusters, real.thrusters, strict=True))
            if not (a.is_ideal and b.is_ideal)
        ]

    def realised(self, thrust: Array) -> Array:
        """Thrust (m,) N that the drives head for when these thrusts (m,) N are commanded.

        Ideal drives have theirs cut at their limits by the kernel.
        """
        if not self._pairs:
            return thrust
        result = np.array(thrust, dtype=float)
        for i, known, real in self._pairs:
            same = known is real
            result[i] = (
                known.reachable(thrust[i]) if same else real.thrust(known.command(thrust[i]))
            )
        return result
