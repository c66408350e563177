"""Planner method `arm_only`: the smallest motion of the joints while the vehicle holds still."""

from uvms_core.signals import Array
from uvms_planner.methods.least_norm import LeastNorm
from uvms_planner.problem import VEHICLE


class ArmOnly(LeastNorm):
    """`least_norm` with the vehicle's variables frozen."""

    def bounds(self, lower: Array, upper: Array) -> tuple[Array, Array]:
        """The same bounds with no increment of the vehicle."""
        return _without_vehicle(lower), _without_vehicle(upper)

    def readiness(self, readiness: Array) -> Array:
        """The same weights with none for the vehicle."""
        return _without_vehicle(readiness)


def _without_vehicle(values: Array) -> Array:
    kept = values.copy()
    kept[:VEHICLE] = 0.0
    return kept
