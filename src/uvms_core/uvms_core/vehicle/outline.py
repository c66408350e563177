"""Outlines of hull and links, which clearances are measured from, by the best that the file says.

- hull: `hull.boxes` where given; else the spheroid; else the cuboid of the hull's inertia. A fin is
  a ball on it, with the half side of a square fin as radius.
- link: `capsules` where given; else one around the cylinder, or each drag cylinder: of its radius,
  and as long between the centres of its ends, so that the flat ends lie within; else one along the
  line through the link's joint, its frame and the next joint or the tool, of the link's volume.
"""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from uvms_core.rotations import quat_to_matrix, rpy_to_quat
from uvms_core.signals import Array
from uvms_core.vehicle.arm import Arm, DragCylinder, Link
from uvms_core.vehicle.box import Box
from uvms_core.vehicle.frames import distal_pose, placement_pose
from uvms_core.vehicle.hull import Hull

CUBOID = math.sqrt(3.0)
"""Half side of a homogeneous cuboid over its radius of gyration along that side."""


@dataclass(frozen=True)
class CapsuleOutline:
    """All points within `radius` m of a segment: from start (3,) to end (3,), m, its body's frame.

    A ball where both are the same.
    """

    start: Array
    end: Array
    radius: float


@dataclass(frozen=True)
class BoxOutline:
    """A cuboid: centre (3,), m, axes as columns (3, 3), half sides (3,), m, its body's frame."""

    centre: Array
    rotation: Array
    half: Array


@dataclass(frozen=True)
class SpheroidOutline:
    """A prolate spheroid about x, centred at the body origin; half axes in m."""

    along: float
    across: float


Outline = CapsuleOutline | BoxOutline | SpheroidOutline


def hull_outlines(hull: Hull) -> list[Outline]:
    """The hull with its fins, body frame."""
    return [*_hull_bodies(hull), *map(_ball_of_fin, hull.fins)]


def _hull_bodies(hull: Hull) -> list[Outline]:
    if hull.boxes:
        return [box_outline(box) for box in hull.boxes]
    if (shape := hull.spheroid) is not None:
        return [SpheroidOutline(0.5 * shape.length_m, 0.5 * shape.diameter_m)]
    return [_cuboid(hull)]


def box_outline(box: Box) -> BoxOutline:
    """A box of a file."""
    rotation = quat_to_matrix(rpy_to_quat(*np.radians(box.rpy_deg)))
    return BoxOutline(np.array(box.center_m), rotation, 0.5 * np.array(box.size_m))


def _cuboid(hull: Hull) -> BoxOutline:
    """The homogeneous cuboid that has the hull's inertia, about its principal axes."""
    moments, axes = np.linalg.eigh(np.array(hull.inertia_kg_m2))
    squared = np.maximum(0.5 * moments.sum() - moments, 0.0) / hull.mass_kg
    if np.linalg.det(axes) < 0.0:
        axes[:, 0] *= -1.0
    return BoxOutline(np.array(hull.cg_m), axes, CUBOID * np.sqrt(squared))


def _ball_of_fin(fin) -> CapsuleOutline:
    place = np.array(fin.position_m)
    return CapsuleOutline(place, place, 0.5 * math.sqrt(fin.area_m2))


def link_outlines(arm: Arm, number: int) -> list[CapsuleOutline]:
    """The body of a link, in the link's frame of the vehicle file."""
    link = arm.links[number]
    if link.capsules:
        return [
            CapsuleOutline(np.array(each.start_m), np.array(each.end_m), each.radius_m)
            for each in link.capsules
        ]
    cylinders = [link.cylinder] if link.cylinder is not None else list(link.drag)
    if cylinders:
        return [_around(cylinder) for cylinder in cylinders]
    return _along(link_line(arm, number), link)


def _around(cylinder: DragCylinder) -> CapsuleOutline:
    centre = np.array(cylinder.center_m)
    half = 0.5 * cylinder.length_m * np.array(cylinder.axis)
    return CapsuleOutline(centre - half, centre + half, cylinder.radius_m)


def _along(line: Array, link: Link) -> list[CapsuleOutline]:
    """Capsules along a line (3, 3) with the radius that gives them the link's volume.

    pi r^2 l + 4/3 pi r^3 = V, by Newton's method from the sphere of the volume, too large.
    """
    pieces = [(a, b) for a, b in pairwise(line) if (a != b).any()]
    length = float(sum(np.linalg.norm(b - a) for a, b in pieces))
    radius = math.cbrt(0.75 * link.volume_m3 / math.pi)
    for _ in range(50):  # convex and increasing: it converges from above
        volume = math.pi * radius**2 * (length + 4.0 / 3.0 * radius)
        radius -= (volume - link.volume_m3) / (2.0 * math.pi * radius * (length + 2.0 * radius))
    ends = pieces or [(line[0], line[0])]
    return [CapsuleOutline(a, b, radius) for a, b in ends]


def link_line(arm: Arm, number: int) -> Array:
    """The link's own joint, its frame, and the next joint or the tool, in its frame: (3, 3), m."""
    position, rotation = distal_pose(arm.joints[number])
    if number + 1 < len(arm.joints):
        after = placement_pose(arm.joints[number + 1])[0]
    else:
        after = np.array(arm.tool.position_m)
    return np.array([-rotation.T @ position, np.zeros(3), after])
