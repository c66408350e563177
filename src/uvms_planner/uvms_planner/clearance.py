"""How far a plan keeps away: a margin for each pair of bodies that must not touch."""

import numpy as np
from pydantic import Field

from uvms_core.config import Config
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics.geometry import OWN, Geometry


class ClearanceConfig(Config):
    """Least distances that a plan keeps between bodies."""

    hull_m: float = Field(
        0.03,
        ge=0.0,
        le=10.0,
        description="m, links from the hull; where a path begins closer, almost that is enough",
    )
    arm_m: float = Field(
        0.03, ge=0.0, le=10.0, description="m, links from one another; the same holds"
    )
    obstacle_m: float = Field(0.1, ge=0.0, le=100.0, description="m, hull and links from obstacles")
    seabed_m: float = Field(0.1, ge=0.0, le=100.0, description="m, hull and links from the seabed")
    tool_m: float | None = Field(
        None,
        ge=-1.0,
        le=100.0,
        description="m, the last link from obstacles and seabed, below 0 where it works on them;"
        " none: as the other links",
    )


def clearance_margins(config: ClearanceConfig, vehicle: Vehicle, geometry: Geometry) -> Array:
    """Least distance (k,), m, of each pair of the geometry.

    What is closer where a path begins may stay almost as close (`StepSolver.around_from`), so that
    no start is refused, however coarse the shapes are.
    """
    of_kind = {
        "hull": config.hull_m,
        "arm": config.arm_m,
        "obstacle": config.obstacle_m,
        "seabed": config.seabed_m,
    }
    margins = np.array([of_kind[pair.kind] for pair in geometry.pairs])
    own = np.array([pair.kind in OWN for pair in geometry.pairs], dtype=bool)
    if config.tool_m is not None:
        last = vehicle.arm.links[-1].name
        tool = np.array([pair.body == last for pair in geometry.pairs], dtype=bool)
        margins[tool & ~own] = config.tool_m
    return margins
