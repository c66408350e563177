"""A load in the gripper, and the last link with it as one rigid body."""

import math

import numpy as np
from pydantic import Field

from uvms_core.config import Config
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.frames import mounting_pose
from uvms_core.vehicle.parts import Inertia, Vector3
from uvms_core.vehicle.shapes import move_to_origin

SPHERE_ADDED_MASS = 0.5
"""Added mass of a sphere over the water that it displaces (Lamb, Hydrodynamics, sec. 92)."""


class Load(Config):
    """A rigid body in the gripper; a homogeneous sphere unless more is given."""

    mass_kg: float = Field(gt=0.0, le=1e4, description="mass, kg")
    volume_m3: float = Field(ge=0.0, le=10.0, description="displaced volume, m^3")
    at_m: Vector3 = Field(
        (0.0, 0.0, 0.0), description="its centre of mass and of buoyancy in the tool frame, m"
    )
    inertia_kg_m2: Inertia | None = Field(
        None,
        description="inertia about its centre, axes of the tool frame, kg m^2: 3 diagonal values"
        " or 3 rows; none: of a homogeneous sphere of its volume",
    )
    added_mass_kg: float | None = Field(
        None,
        ge=0.0,
        le=1e5,
        description="added mass, the same along all axes, kg; none: of a sphere of its volume, half"
        " the water that it displaces",
    )

    @property
    def own_inertia(self) -> Array:
        """Inertia (3, 3) about its centre, axes of the tool frame, kg m^2."""
        if self.inertia_kg_m2 is not None:
            return np.array(self.inertia_kg_m2)
        radius = (0.75 * self.volume_m3 / math.pi) ** (1.0 / 3.0)
        return 0.4 * self.mass_kg * radius**2 * np.eye(3)

    def text(self) -> str:
        """In words."""
        return f"{self.mass_kg:g} kg, {1e3 * self.volume_m3:g} l"


def loaded(vehicle: Vehicle, load: Load) -> Vehicle:
    """The vehicle with the load as a part of its last link: one rigid body.

    Mass, centres, inertia (parallel axes), displaced volume and added mass are those of both. The
    drag of the load is not counted.
    """
    link = vehicle.arm.links[-1]
    origin, rotation = mounting_pose(vehicle.arm.tool)
    place = origin + rotation @ load.at_m
    masses = np.array([link.mass_kg, load.mass_kg])
    volumes = np.array([link.volume_m3, load.volume_m3])
    centres = np.array([link.cg_m, place])
    cg = masses @ centres / masses.sum()
    inertia = np.array(link.inertia_kg_m2) + rotation @ load.own_inertia @ rotation.T
    for mass, lever in zip(masses, centres - cg, strict=True):
        inertia += mass * (lever @ lever * np.eye(3) - np.outer(lever, lever))
    cb = volumes @ np.array([link.cb_m, place]) / volumes.sum()
    changes = {
        "mass_kg": float(masses.sum()),
        "volume_m3": float(volumes.sum()),
        "cg_m": tuple(cg.tolist()),
        "cb_m": tuple(cb.tolist()),
        "inertia_kg_m2": (0.5 * (inertia + inertia.T)).tolist(),
        "added_mass": (np.array(link.added_mass) + _added_mass(vehicle, load, place)).tolist(),
    }
    links = (*vehicle.arm.links[:-1], link.model_copy(update=changes))
    return vehicle.model_copy(update={"arm": vehicle.arm.model_copy(update={"links": links})})


def _added_mass(vehicle: Vehicle, load: Load, place: Array) -> Array:
    """That of the load (6, 6) about the origin of the last link's frame."""
    mass = load.added_mass_kg
    if mass is None:
        mass = SPHERE_ADDED_MASS * vehicle.environment.water_density_kg_m3 * load.volume_m3
    return move_to_origin(mass * np.eye(3), np.zeros((3, 3)), place)
