"""Which sensor gives the heading where the inertial unit gives no attitude."""

from typing import Any

import numpy as np

from uvms_core.errors import ConfigError
from uvms_core.sensors import mounted_sensors
from uvms_core.sensors.heading import Heading
from uvms_core.vehicle import Vehicle

KINDS = ("heading", "magnetometer")


def heading_sections(vehicle: Vehicle) -> list[Any]:
    """Sections of the vehicle's sensors of the heading, in the order of its file."""
    return [each.section for each in mounted_sensors(vehicle) if each.type.name in KINDS]


def carries_the_heading(vehicle: Vehicle, section: Any) -> bool:
    """Whether the bias of this sensor is that of the filter's heading: a state."""
    if vehicle.sensors.imu.orientation:
        return False
    found = heading_sections(vehicle)
    return bool(found) and found[0] is section


def heading_bias(vehicle: Vehicle) -> float:
    """Std of the bias of the heading where the inertial unit has no attitude, rad.

    Raises:
        ConfigError: nothing on the vehicle measures the heading.
    """
    for section in heading_sections(vehicle):
        if isinstance(section, Heading):
            return float(np.radians(section.bias_deg))
        earth = vehicle.environment.magnetic_field_ut or (1.0, 0.0, 0.0)
        return float(section.bias_ut / np.hypot(*earth[:2]))
    raise ConfigError(
        "sensors.imu.orientation is false and no sensor measures the heading: mount one of type"
        f" {' or '.join(KINDS)}"
    )
