"""Shapes of the bodies, built from those that URDF has: spheres and cylinders."""

import math
from dataclasses import dataclass

import numpy as np

from uvms_core.description.tree import basis
from uvms_core.vehicle.arm import DragCylinder, Link
from uvms_core.vehicle.frames import Pose
from uvms_core.vehicle.hull import Hull, Spheroid

HULL_SPACING = 0.45
"""Largest spacing of the hull's spheres in radii: dents stay below 0.45^2 / 8 of the radius."""
THRUSTER_RADIUS_M = 0.05
THRUSTER_LENGTH_M = 0.08


@dataclass(frozen=True)
class Solid:
    """A sphere (`length` 0), or a cylinder about z, at a pose in the body's frame."""

    pose: Pose
    radius: float
    length: float = 0.0


def hull_solids(hull: Hull) -> list[Solid]:
    """The hull's spheroid; without one, the sphere of its volume at its centre of buoyancy."""
    if hull.spheroid is not None:
        return spheroid_solids(hull.spheroid)
    return [_ball(hull.volume_m3, hull.cb_m)]


def spheroid_solids(shape: Spheroid) -> list[Solid]:
    """A spheroid as the spheres that touch it from inside, since URDF has no ellipsoid.

    The largest sphere in a prolate spheroid (half axes a, b, eccentricity e) around (c, 0, 0) has
    r = b sqrt(1 - (c / (a e))^2) for |c| <= a e^2; with c = a e^2 sin(t) that is
    r = b sqrt(1 - e^2 sin(t)^2). The surface is the envelope of them all.
    """
    a, b = 0.5 * shape.length_m, 0.5 * shape.diameter_m
    e2 = 1.0 - (b / a) ** 2
    count = 1 + math.ceil(math.pi * a * e2 / (HULL_SPACING * b))
    solids = []
    for sine in np.sin(np.linspace(-0.5 * math.pi, 0.5 * math.pi, max(count, 3))):
        centre = np.array([a * e2 * sine, 0.0, 0.0])
        solids.append(Solid((centre, np.eye(3)), b * math.sqrt(1.0 - e2 * sine**2)))
    return solids


def link_solids(link: Link) -> list[Solid]:
    """The link's cylinder in its distal frame; without one those of its drag, or else a sphere."""
    cylinders = [link.cylinder] if link.cylinder is not None else list(link.drag)
    return [_rod(cylinder) for cylinder in cylinders] or [_ball(link.volume_m3, link.cb_m)]


def thruster_solid() -> Solid:
    """A small cylinder along the thruster's x axis."""
    pose = np.zeros(3), basis(np.array([1.0, 0.0, 0.0]), 2)
    return Solid(pose, THRUSTER_RADIUS_M, THRUSTER_LENGTH_M)


def _rod(cylinder: DragCylinder) -> Solid:
    pose = np.array(cylinder.center_m), basis(np.array(cylinder.axis), 2)
    return Solid(pose, cylinder.radius_m, cylinder.length_m)


def _ball(volume: float, centre: tuple[float, float, float]) -> Solid:
    return Solid((np.array(centre), np.eye(3)), (0.75 * volume / math.pi) ** (1.0 / 3.0))
