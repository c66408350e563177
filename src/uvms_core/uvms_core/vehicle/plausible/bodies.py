"""Mass, volume, inertia and centres of each body, against one another and its size."""

from collections.abc import Iterator

import numpy as np

from uvms_core.vehicle import shapes
from uvms_core.vehicle.arm import Link
from uvms_core.vehicle.hull import Hull
from uvms_core.vehicle.plausible.extents import (
    Extent,
    bare_hull_extent,
    hull_extent,
    link_extent,
    radii_of_gyration,
    sphere_radius,
)
from uvms_core.vehicle.plausible.finding import Finding, graded
from uvms_core.vehicle.plausible.water import NONE
from uvms_core.vehicle.vehicle import Vehicle

DENSEST, LIGHTEST = 22_600.0, 5.0
"""No solid is denser than osmium, kg/m^3; none that holds a shape under water is lighter than
the lightest plastic foams (10)."""

HEAVY, LIGHT = 12_000.0, 50.0
"""Lead has 11,340 kg/m^3, the foam of pool noodles 30."""

SHAPE_ODD, SHAPE_IMPOSSIBLE = 1.5, 30.0
"""Ratio of the volume to that of the shape in the file, either way: fins and a flooded hull make
some; a thousand is litres for cubic metres."""

OUTSIDE_ODD, OUTSIDE_IMPOSSIBLE = 1.0, 1.5
"""How many half lengths of its shape a body's centre may be off: inside its hull by geometry, with
half as much again for what the shape leaves out."""

OUTSIDE_LOOSE = 2.0
"""The same bounds are so many times wider where there is no shape, only an estimated size."""

GYRATION_ODD, GYRATION_IMPOSSIBLE = 1.0, 2.0
"""Radius of gyration over the half diagonal of the body's box: one is all mass at the corners."""

SPREAD_ODD, SPREAD_IMPOSSIBLE = 8.0, 30.0
"""The same over the radius of the sphere of its volume, without a shape: a solid rod 40 times as
long as thick has 6."""

COMPACT_ODD = 0.05
"""Largest moment of inertia over that of the homogeneous sphere of its volume: the mass would be
within a fifth of that radius."""


MOST_WATER = 8.0
"""Added mass over displaced mass: an open frame with plates has up to four."""

BESIDE_LINK_ODD, BESIDE_LINK_IMPOSSIBLE = 2.0, 6.0
"""How many radii of its cylinder a link's centre may be off the axis: a motor beside the tube."""


def check_bodies(vehicle: Vehicle) -> Iterator[Finding]:
    """The hull and each link."""
    hull, extent = vehicle.hull, hull_extent(vehicle)
    yield from _density("hull", hull)
    yield from _volume_of_shape(vehicle)
    yield from _inertia("hull", hull, _hull_size(hull))
    for name in ("cg_m", "cb_m"):
        yield from _centre_in_hull(f"hull.{name}", np.array(getattr(hull, name)), extent)
    for number, link in enumerate(vehicle.arm.links):
        path = f"arm.links.{number}"
        yield from _density(path, link)
        yield from _inertia(path, link, _link_size(link))
        yield from _centres_in_link(vehicle, number, path)


def _density(path: str, body: Hull | Link) -> Iterator[Finding]:
    density = body.mass_kg / body.volume_m3
    text = f"{body.mass_kg:.5g} kg in {body.volume_m3:.4g} m^3 are {density:.4g} kg/m^3"
    if density > DENSEST:
        why = f"more than {DENSEST:g}: no solid is as dense"
    elif density < LIGHTEST:
        why = (
            f"less than {LIGHTEST:g}: no body is as light; are these"
            f" {body.volume_m3:.4g} litres, or is the mass in tonnes?"
        )
    elif density > HEAVY:
        why = f"more than {HEAVY:g}, denser than lead"
    elif density < LIGHT:
        why = f"less than {LIGHT:g}, lighter than foam"
    else:
        return
    field = "volume_m3" if density < LIGHT else "mass_kg"
    yield Finding(f"{path}.{field}", f"{text}, {why}", density > DENSEST or density < LIGHTEST)


def _volume_of_shape(vehicle: Vehicle) -> Iterator[Finding]:
    shape = vehicle.hull.spheroid
    if shape is None:
        return
    own, volume = shapes.spheroid_volume(shape), vehicle.hull.volume_m3
    yield from graded(
        "hull.volume_m3",
        max(volume / own, own / volume),
        SHAPE_ODD,
        SHAPE_IMPOSSIBLE,
        f"{volume:.4g} m^3 are {volume / own:.3g} times those of hull.spheroid ({own:.4g} m^3), a"
        " factor of more than {bound}",
        "is the volume in litres, or are the lengths in another unit?",
    )


def _hull_size(hull: Hull) -> tuple[float, bool]:
    """Half diagonal of the shape's box, m, or the radius of its volume; whether it is a shape."""
    if hull.spheroid is None:
        return sphere_radius(hull.volume_m3), False
    return float(np.linalg.norm(bare_hull_extent(hull).half_m)), True


def _link_size(link: Link) -> tuple[float, bool]:
    if (shape := link.cylinder) is None:
        return sphere_radius(link.volume_m3), False
    return float(np.hypot(0.5 * shape.length_m, shape.radius_m)), True


def _inertia(path: str, body: Hull | Link, size: tuple[float, bool]) -> Iterator[Finding]:
    """Spread of the mass against the body's size."""
    inertia, mass = np.array(body.inertia_kg_m2), body.mass_kg
    moments = np.linalg.eigvalsh(inertia)
    spread = float(radii_of_gyration(mass, np.diag(moments)).max())
    length, is_shape = size
    bounds = (GYRATION_ODD, GYRATION_IMPOSSIBLE) if is_shape else (SPREAD_ODD, SPREAD_IMPOSSIBLE)
    what = "from corner to centre of its shape" if is_shape else "of radius, as a sphere"
    yield from graded(
        f"{path}.inertia_kg_m2",
        spread / length,
        *bounds,
        f"{moments[-1]:.4g} kg m^2 put {mass:.4g} kg {spread:.4g} m from their centre, more than"
        f" {{bound}} times the body's {length:.3g} m {what}",
        "mass is inside its body",
    )
    yield from _compact(path, body, float(moments[-1]))


def _compact(path: str, body: Hull | Link, moment: float) -> Iterator[Finding]:
    def of_sphere(density: float) -> float:
        return 0.4 * body.mass_kg * sphere_radius(body.mass_kg / density) ** 2

    densest, own = of_sphere(DENSEST), of_sphere(body.mass_kg / body.volume_m3)
    if moment < densest:
        text = f"below {densest:.3g}, that of as much osmium in a ball: no solid is as dense"
    elif moment < COMPACT_ODD * own:
        text = f"below {COMPACT_ODD:g} of the {own:.3g} of a ball of its volume"
    else:
        return
    field = f"{path}.inertia_kg_m2"
    yield Finding(field, f"its greatest moment is {moment:.3g} kg m^2, {text}", moment < densest)


def _centre_in_hull(field: str, centre: np.ndarray, extent: Extent) -> Iterator[Finding]:
    """A centre of mass or volume is inside the convex hull of its body."""
    off = np.abs(centre) / extent.half_m
    k = int(np.argmax(off))
    wider = 1.0 if extent.from_shape else OUTSIDE_LOOSE
    yield from graded(
        field,
        float(off[k]),
        OUTSIDE_ODD * wider,
        OUTSIDE_IMPOSSIBLE * wider,
        f"{centre[k]:g} m along {'xyz'[k]} is more than {{bound}} times the hull's half length of"
        f" {extent.half_m[k]:.3g} m (from {extent.source})",
        "a body's centre is within its bounds, here those about the body origin",
    )


def _centres_in_link(vehicle: Vehicle, number: int, path: str) -> Iterator[Finding]:
    link, extent = vehicle.arm.links[number], link_extent(vehicle.arm, number)
    wider = 1.0 if link.cylinder is not None else OUTSIDE_LOOSE
    for name in ("cg_m", "cb_m"):
        distance = extent.distance(np.array(getattr(link, name)))
        yield from graded(
            f"{path}.{name}",
            distance / extent.reach_m,
            BESIDE_LINK_ODD * wider,
            BESIDE_LINK_IMPOSSIBLE * wider,
            f"{distance:.3g} m from the link's axis are more than {{bound}} times its"
            f" {extent.reach_m:.3g} m (from {extent.source})",
            "a body's centre is within its bounds",
        )


def check_added_mass(vehicle: Vehicle) -> Iterator[Finding]:
    """Water that a body carries, against the water that it displaces."""
    density = vehicle.environment.water_density_kg_m3
    if density <= NONE:
        return
    greatest = float(np.linalg.eigvalsh(np.array(vehicle.hull.added_mass)[:3, :3])[-1])
    displaced = density * vehicle.hull.volume_m3
    yield from graded(
        "hull.added_mass",
        greatest / displaced,
        MOST_WATER,
        np.inf,
        f"{greatest:.4g} kg along one axis are more than {{bound}} times the {displaced:.4g} kg"
        " that the hull displaces",
        "spheres have half of it, cylinders as much, and only plates many times it",
    )
