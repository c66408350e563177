"""Values that follow from others: the keywords `neutral`, `trim`, `spheroid` and `cylinder`.

The hull's attachments become part of its own mass, volume, centers and inertia.
"""

from typing import Any

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import shapes
from uvms_core.vehicle.arm import Arm, Link
from uvms_core.vehicle.attach import with_attachments
from uvms_core.vehicle.environment import Environment
from uvms_core.vehicle.frames import arm_frames
from uvms_core.vehicle.hull import Hull, Spheroid
from uvms_core.vehicle.vehicle import Vehicle

LINK_FIELDS = ("volume_m3", "cg_m", "cb_m", "inertia_kg_m2", "added_mass", "drag")


class MissingShapeError(Exception):
    """A keyword needs a shape that the section does not give; the text names the field."""


def with_derived_values(vehicle: Vehicle) -> dict[str, Any]:
    """The vehicle as plain data without keywords: links first, then what follows from them.

    neutral: m_hull = rho V_hull - sum (m_i - rho V_i); trim: x and y of the CG such that weight
    and buoyancy of the whole system have no moment at level with the arm stowed.
    """
    density = vehicle.environment.water_density_kg_m3
    links = tuple(
        _derive_link(link, density, f"arm.links.{i}") for i, link in enumerate(vehicle.arm.links)
    )
    arm = vehicle.arm.model_copy(update={"links": links})
    hull = _derive_hull(vehicle.hull, arm, vehicle.environment)
    return vehicle.model_copy(update={"arm": arm, "hull": hull}).model_dump(warnings=False)


def _derive_link(link: Link, density: float, path: str) -> Link:
    names = [name for name in LINK_FIELDS if _has_keyword(link, name, "cylinder")]
    if not names:
        return link
    shape = link.cylinder
    if shape is None:
        raise MissingShapeError(f"{path}.{names[0]}: 'cylinder' needs the section {path}.cylinder")
    axial = shape.axial_added_mass_fraction * link.mass_kg
    values = {
        "volume_m3": shapes.cylinder_volume(shape),
        "cg_m": shape.center_m,
        "cb_m": shape.center_m,
        "inertia_kg_m2": shapes.cylinder_inertia(shape, link.mass_kg).tolist(),
        "added_mass": shapes.cylinder_added_mass(shape, density, axial).tolist(),
        "drag": [shape.model_dump(exclude={"axial_added_mass_fraction"})],
    }
    return link.model_copy(update={name: values[name] for name in names})


def _derive_hull(hull: Hull, arm: Arm, environment: Environment) -> Hull:
    density = environment.water_density_kg_m3
    if _has_keyword(hull, "volume_m3", "spheroid"):
        volume = shapes.spheroid_volume(_spheroid(hull, "volume_m3"))
        hull = hull.model_copy(update={"volume_m3": volume})
    if _has_keyword(hull, "mass_kg", "neutral"):
        wet = sum(link.mass_kg - density * link.volume_m3 for link in arm.links)
        wet += sum(a.wet_weight_n / environment.gravity_m_s2 for a in hull.attachments)
        hull = hull.model_copy(update={"mass_kg": density * hull.volume_m3 - wet})
    if _has_keyword(hull, "inertia_kg_m2", "spheroid"):
        inertia = shapes.spheroid_inertia(_spheroid(hull, "inertia_kg_m2"), hull.mass_kg)
        hull = hull.model_copy(update={"inertia_kg_m2": inertia.tolist()})
    if _has_keyword(hull, "added_mass", "spheroid"):
        added = shapes.spheroid_added_mass(_spheroid(hull, "added_mass"), density)
        hull = hull.model_copy(update={"added_mass": added.tolist()})
    level = _level_cg(hull, arm, environment)
    cg = [level[i] if value == "trim" else value for i, value in enumerate(hull.cg_m)]
    return with_attachments(hull.model_copy(update={"cg_m": cg}), environment)


def _spheroid(hull: Hull, name: str) -> Spheroid:
    if hull.spheroid is None:
        raise MissingShapeError(f"hull.{name}: 'spheroid' needs the section hull.spheroid")
    return hull.spheroid


def _has_keyword(section: Hull | Link, name: str, keyword: str) -> bool:
    """Whether a field holds a keyword, although its type is a number or a table."""
    return bool(getattr(section, name) == keyword)


def _level_cg(hull: Hull, arm: Arm, environment: Environment) -> Array:
    """CG (3,) of the hull that leaves no moment with the arm stowed (only x and y are used)."""
    density = environment.water_density_kg_m3
    moment = density * hull.volume_m3 * np.array(hull.cb_m)
    for extra in hull.attachments:
        moment -= extra.wet_weight_n / environment.gravity_m_s2 * np.array(extra.position_m)
    frames = arm_frames(arm, np.radians(arm.stowed_deg))[1:]
    for link, (origin, rotation) in zip(arm.links, frames, strict=True):
        moment -= link.mass_kg * (origin + rotation @ link.cg_m)
        moment += density * link.volume_m3 * (origin + rotation @ link.cb_m)
    return moment / hull.mass_kg
