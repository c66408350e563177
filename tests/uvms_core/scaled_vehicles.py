"""Geometric copies of a vehicle, of which only the size differs."""

import math

from uvms_core.vehicle import Vehicle, vehicle_from_data
from uvms_core.vehicle.scaled import scaled_data


def by_mass(vehicle: Vehicle, factor: float) -> Vehicle:
    """The copy that is `factor` times as heavy."""
    data = scaled_data(vehicle.model_dump(mode="json"), math.cbrt(factor))
    return vehicle_from_data(data, f"{vehicle.name} times {factor:g}")
