"""Lines through the hull, as its spheroid has it, or the sphere of its volume without one."""

import numpy as np

from uvms_core.description.solids import THRUSTER_LENGTH_M, hull_solids
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.hull import Hull

MOUTH_M = 0.006
"""How far the mouth of a tunnel thruster stands out of the hull."""


def tunnel(vehicle: Vehicle, position: Array, along: Array) -> tuple[float, float]:
    """Where the thruster's cylinder begins and ends along its axis, m from its position."""
    half = 0.5 * THRUSTER_LENGTH_M
    through = chord(vehicle.hull, position, along)
    form = vehicle.hull.spheroid
    if through is None or form is None or np.ptp(through) > 1.01 * form.diameter_m:
        return -half, half  # outside, or along the hull
    return min(through[0] - MOUTH_M, -half), max(through[1] + MOUTH_M, half)


def chord(hull: Hull, position: Array, along: Array) -> tuple[float, float] | None:
    """Where a line through a point enters and leaves the hull, m along a unit vector."""
    scale, centre = 1.0 / half_axes(hull), middle(hull)
    o, d = (position - centre) * scale, along * scale
    under = (o @ d) ** 2 - (d @ d) * (o @ o - 1.0)
    if under <= 0.0:
        return None
    root = float(np.sqrt(under))
    return float((-(o @ d) - root) / (d @ d)), float((-(o @ d) + root) / (d @ d))


def half_axes(hull: Hull) -> Array:
    """Half axes (3,) of the spheroid, or of the sphere of the hull's volume."""
    if hull.spheroid is None:
        return np.full(3, hull_solids(hull)[0].radius)
    length, diameter = hull.spheroid.length_m, hull.spheroid.diameter_m
    return 0.5 * np.array([length, diameter, diameter])


def middle(hull: Hull) -> Array:
    """Centre (3,) of the same, m, body frame."""
    return np.zeros(3) if hull.spheroid is not None else np.array(hull.cb_m)
