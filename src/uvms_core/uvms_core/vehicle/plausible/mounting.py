"""Sensors and arm on the hull."""

from collections.abc import Iterator

import numpy as np

from uvms_core.vehicle.frames import arm_length
from uvms_core.vehicle.plausible.extents import hull_extent
from uvms_core.vehicle.plausible.finding import Finding, graded
from uvms_core.vehicle.vehicle import Vehicle

OUTSIDE_ODD, OUTSIDE_IMPOSSIBLE = 2.0, 20.0
"""Distance from the body origin over the half diagonal of hull and thrusters: twice is a mast or a
boom, and a hundred is centimetres."""

ARM_ODD, ARM_IMPOSSIBLE = 10.0, 200.0
"""Length of the arm over the hull's: a thousand is millimetres."""


def check_mounting(vehicle: Vehicle) -> Iterator[Finding]:
    """Places of sensors and arm, and the arm's length."""
    size = float(np.linalg.norm(hull_extent(vehicle).half_m))
    places = {f"sensors.{name}": part.position_m for name, part in vehicle.sensors.mounted.items()}
    places["arm.base"] = vehicle.arm.base.position_m
    for path, position in places.items():
        distance = float(np.linalg.norm(position))
        yield from graded(
            f"{path}.position_m",
            distance / size,
            OUTSIDE_ODD,
            OUTSIDE_IMPOSSIBLE,
            f"{distance:.4g} m from the body origin, more than {{bound}} times the vehicle's"
            f" {size:.3g} m from centre to corner",
            "it is mounted on the vehicle",
        )
    length = arm_length(vehicle.arm)
    yield from graded(
        "arm.joints",
        length / (2.0 * size),
        ARM_ODD,
        ARM_IMPOSSIBLE,
        f"the arm is {length:.4g} m long, more than {{bound}} times the vehicle's"
        f" {2.0 * size:.3g} m",
        "are its lengths in another unit?",
    )
