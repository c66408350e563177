"""Planner method `vehicle_only`: the arm keeps its posture and the vehicle carries the tool."""

from uvms_core.signals import Array
from uvms_planner.methods.least_norm import LeastNorm
from uvms_planner.problem import VEHICLE


class VehicleOnly(LeastNorm):
    """`least_norm` with the joints frozen, so that the posture of the start is kept.

    Position, yaw included, is exact where the vehicle is fast enough; of an orientation only what
    yaw alone can give is possible. It plans no motion of the arm and so no reaction to it: what is
    left is the baseline that a planner of vehicle and arm must beat.
    """

    def bounds(self, lower: Array, upper: Array) -> tuple[Array, Array]:
        """The same bounds with no increment of the joints."""
        return _without_arm(lower), _without_arm(upper)

    def readiness(self, readiness: Array) -> Array:
        """The same weights with none for the joints."""
        return _without_arm(readiness)


def _without_arm(values: Array) -> Array:
    kept = values.copy()
    kept[VEHICLE:] = 0.0
    return kept
