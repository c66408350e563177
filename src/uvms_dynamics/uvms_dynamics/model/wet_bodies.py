"""What hull and links are to the water around them, as a table that the kernels of waves read."""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Hull, Link, Vehicle
from uvms_dynamics.kernels import waves
from uvms_dynamics.model.vehicle_table import body_poses, moved, packed


def build_wet_bodies(vehicle: Vehicle) -> Array:
    """Table (n + 1, 31): added mass, displaced mass and its centre in the kernels' frames.

    The columns for the flow at each body are zero.
    """
    bodies: list[Hull | Link] = [vehicle.hull, *vehicle.arm.links]
    density = vehicle.environment.water_density_kg_m3
    table = np.zeros((len(bodies), int(waves.WET_COLUMNS)))
    for row, body, pose in zip(table, bodies, body_poses(vehicle.arm), strict=True):
        position, rotation = pose
        row[waves.ADDED : waves.DISPLACED] = packed(moved(np.array(body.added_mass), pose))
        row[waves.DISPLACED] = density * body.volume_m3
        row[waves.CENTRE : waves.FLOW] = position + rotation @ body.cb_m
    return table
