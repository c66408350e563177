"""How large the bodies of a vehicle are, by the best that its file says.

The file needs no shapes, so that the size of a hull or link may have to be told from other things:

- hull: the half axes of `spheroid`; without it, in every direction, the radius of the sphere of
  its volume or the longest half axis of the homogeneous ellipsoid of its inertia, whichever is
  greater: lumps of mass say little about the direction in which a hull is long. Thrusters belong to
  it: the box reaches to the outermost ones that are within reason. It lies about the body origin,
  which is the hull's geometric centre.
- link: `cylinder`; without it, what lies within the ellipsoid of its inertia and the sphere of its
  volume from the line through its joint, its frame and the next joint or the tool.
"""

import math
from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle.arm import Arm, Link
from uvms_core.vehicle.hull import Hull
from uvms_core.vehicle.outline import link_line
from uvms_core.vehicle.vehicle import Vehicle

ELLIPSOID = math.sqrt(5.0)
"""Half axis of a homogeneous ellipsoid over its radius of gyration along that axis."""

FARTHEST_PART = 3.0
"""A thruster farther out than so many sizes of the hull does not count as a part of the hull."""


@dataclass(frozen=True)
class Extent:
    """A box about the body origin: half lengths (3,), m, and what they follow from."""

    half_m: Array
    source: str
    from_shape: bool

    @property
    def largest_m(self) -> float:
        """The longest half length."""
        return float(self.half_m.max())


def bare_hull_extent(hull: Hull) -> Extent:
    """The hull without what is mounted on it."""
    if (half := _shape_half_axes(hull)) is not None:
        return Extent(half, "the spheroid", True)
    gyration = ELLIPSOID * radii_of_gyration(hull.mass_kg, np.array(hull.inertia_kg_m2))
    reach = max(float(gyration.max()), sphere_radius(hull.volume_m3))
    return Extent(np.full(3, reach), "volume and inertia", False)


def hull_extent(vehicle: Vehicle) -> Extent:
    """The hull with its thrusters."""
    bare = bare_hull_extent(vehicle.hull)
    places = np.abs([thruster.position_m for thruster in vehicle.thrusters])
    near = places[np.linalg.norm(places, axis=1) <= FARTHEST_PART * np.linalg.norm(bare.half_m)]
    if not len(near):
        return bare
    half = np.maximum(bare.half_m, near.max(axis=0))
    return Extent(half, f"{bare.source}, and thrusters", bare.from_shape)


def _shape_half_axes(hull: Hull) -> Array | None:
    if hull.spheroid is None:
        return None
    across = 0.5 * hull.spheroid.diameter_m
    return np.array([0.5 * hull.spheroid.length_m, across, across])


def radii_of_gyration(mass: float, inertia: Array) -> Array:
    """Root mean square distance (3,) of a body's mass from its centre along each axis, m.

    From the inertia (3, 3) about the centre: sum m x^2 = (I_yy + I_zz - I_xx) / 2.
    """
    moments = np.diag(inertia)
    return np.sqrt(np.maximum(0.5 * moments.sum() - moments, 0.0) / mass)


def sphere_radius(volume: float) -> float:
    """Radius of the sphere of a volume, m."""
    return float(np.cbrt(0.75 * volume / math.pi))


@dataclass(frozen=True)
class LinkExtent:
    """Points (k, 3) in the link's frame that span its line, and its reach from that line, m."""

    line_m: Array
    reach_m: float
    source: str

    def distance(self, point: Array) -> float:
        """Distance of a point (3,) from the line, m."""
        pieces = zip(self.line_m, self.line_m[1:], strict=False)
        return min(_distance(point, start, end) for start, end in pieces)


def link_extent(arm: Arm, number: int) -> LinkExtent:
    """Where the body of a link can be, in its frame."""
    link = arm.links[number]
    if (shape := link.cylinder) is not None:
        half = 0.5 * shape.length_m * np.array(shape.axis)
        center = np.array(shape.center_m)
        return LinkExtent(np.array([center - half, center + half]), shape.radius_m, "the cylinder")
    line = link_line(arm, number)
    length = float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())
    reach = max(length, sphere_radius(link.volume_m3), _gyration_reach(link))
    return LinkExtent(line, reach, "joints, volume and inertia")


def _gyration_reach(link: Link) -> float:
    inertia = np.array(link.inertia_kg_m2)
    return ELLIPSOID * float(radii_of_gyration(link.mass_kg, inertia).max())


def _distance(point: Array, start: Array, end: Array) -> float:
    along = end - start
    squared = float(along @ along)
    part = float(np.clip((point - start) @ along / squared, 0.0, 1.0)) if squared else 0.0
    return float(np.linalg.norm(point - start - part * along))
