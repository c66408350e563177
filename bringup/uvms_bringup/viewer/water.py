"""The velocity of the water in a run, as its configuration says."""

from collections.abc import Callable

import numpy as np

from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_core.config import validated
from uvms_core.signals import Array
from uvms_core.vehicle.vehicle import Vehicle
from uvms_dynamics.simulation.plant.config import PlantConfig
from uvms_dynamics.simulation.water import build_water
from uvms_dynamics.simulation.water.stream import stream_at


def current_of(log: RunLog) -> Callable[[float], Array] | None:
    """Velocity (3,) of the uniform flow in m/s, map_ned, by time in s; None where nobody says.

    Waves, which differ from place to place, and currents of events are not in it.

    Raises:
        LogError: the configuration is damaged.
    """
    if "config.yaml" not in log.attachments:
        return None
    given = log.configuration().get("plant", {})
    plant = validated(PlantConfig, given, f"log {log.path}: config.yaml: plant", LogError)
    return current_by(plant, log.vehicle)


def current_by(plant: PlantConfig, vehicle: Vehicle) -> Callable[[float], Array]:
    """The same of a plant with this configuration."""
    constant = np.array(plant.flow.constant_ned_m_s)
    water = build_water(vehicle, plant.flow)
    if water is None:
        return lambda time: constant
    return lambda time: constant + stream_at(water, np.array([time]))[0, :3]
