"""The drives of the thrusters: from commanded to realised thrust, before lag and slew."""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.thrust_curve import nearest_reachable
from uvms_core.vehicle.thrusters import Thruster


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
        pairs = list(zip(known.thrusters, real.thrusters, strict=True))
        self._are_ideal = all(a.is_ideal and b.is_ideal for a, b in pairs)
        self._least = np.array([thruster.least_n for thruster in known.thrusters]).T
        self._other = [(i, a, b) for i, (a, b) in enumerate(pairs) if _curve(a) != _curve(b)]

    def realised(self, thrust: Array) -> Array:
        """Thrust (m,) N that the drives head for when these thrusts (m,) N are commanded.

        The kernel cuts them at the limits.
        """
        if self._are_ideal:
            return thrust
        result = nearest_reachable(thrust, *self._least)
        for i, known, real in self._other:
            result[i] = real.thrust(known.command(thrust[i]))
        return result


def _curve(thruster: Thruster) -> tuple[object, float]:
    return thruster.curve, thruster.dead_zone
