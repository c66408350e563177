"""Closed forms for the keywords `spheroid` and `cylinder` of the vehicle file."""

import math

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle.arm import DragCylinder
from uvms_core.vehicle.hull import Spheroid


def spheroid_volume(shape: Spheroid) -> float:
    """V = 4/3 pi a b^2, in m^3, with half axes a and b."""
    return math.pi / 6.0 * shape.length_m * shape.diameter_m**2


def spheroid_inertia(shape: Spheroid, mass: float) -> Array:
    """Inertia (3, 3) about the centre, homogeneous: m/5 diag(2b^2, a^2+b^2, a^2+b^2)."""
    a, b = shape.length_m / 2.0, shape.diameter_m / 2.0
    across = mass / 5.0 * (a**2 + b**2)
    return np.diag([0.4 * mass * b**2, across, across])


def spheroid_added_mass(shape: Spheroid, density: float) -> Array:
    """Added mass (6, 6) of a prolate spheroid about its centre, written positive.

    M_A = rho V diag(k1, k2, k2, .., k' (a^2+b^2)/5, same) after Lamb, Hydrodynamics (1932), art.
    114-115; Imlay (1961), DTMB report 1528. The roll term is zero for a bare spheroid; fins and
    fairings are counted as a fraction of the displaced water's inertia.
    """
    a, b = shape.length_m / 2.0, shape.diameter_m / 2.0
    k1, k2, k_rot = _lamb_factors(math.sqrt(1.0 - (b / a) ** 2))
    water = density * spheroid_volume(shape)
    roll = shape.roll_added_inertia_fraction * 0.4 * water * b**2
    pitch = k_rot * water * (a**2 + b**2) / 5.0
    return np.diag([water * k1, water * k2, water * k2, roll, pitch, pitch])


def _lamb_factors(e: float) -> tuple[float, float, float]:
    """Lamb's k1 (axial), k2 (lateral) and k' (rotation) for the eccentricity e."""
    log = math.log((1.0 + e) / (1.0 - e))
    alpha = 2.0 * (1.0 - e**2) / e**3 * (0.5 * log - e)
    beta = 1.0 / e**2 - (1.0 - e**2) / (2.0 * e**3) * log
    k_rot = e**4 * (beta - alpha) / ((2.0 - e**2) * (2.0 * e**2 - (2.0 - e**2) * (beta - alpha)))
    return alpha / (2.0 - alpha), beta / (2.0 - beta), k_rot


def cylinder_volume(shape: DragCylinder) -> float:
    """V = pi r^2 l, in m^3."""
    return math.pi * shape.radius_m**2 * shape.length_m


def cylinder_surface(shape: DragCylinder) -> float:
    """Side 2 pi r l, in m^2."""
    return 2.0 * math.pi * shape.radius_m * shape.length_m


SLENDERNESS = (1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 50.0, 100.0)
END_EFFECT = (0.53, 0.58, 0.62, 0.68, 0.74, 0.82, 0.87, 0.98)
"""Cross-flow drag of a cylinder with two free ends over that of an endless one, by its length over
diameter, below the drag crisis: DNV-RP-C205 (2010), table 6-2; at 1: Hoerner, Fluid-Dynamic Drag
(1965), ch. 3, 0.63 over 1.2."""


def end_effect(shape: DragCylinder) -> float:
    """Factor on the cross-flow drag for the water that flows around the cylinder's ends.

    An end that abuts on another body mirrors the flow, so that the length counts twice with one
    free end; with none the cylinder is an endless one (DNV-RP-C205, sec. 6.7.3). Between the points
    of the table linear in the logarithm of the slenderness, beyond 100 towards 1 at 200.
    """
    if shape.end_effect is not None:
        return shape.end_effect
    if shape.free_ends == 0:
        return 1.0
    slenderness = shape.length_m / (2.0 * shape.radius_m) * (2.0 if shape.free_ends == 1 else 1.0)
    points = np.log([*SLENDERNESS, 200.0])
    return float(np.interp(math.log(slenderness), points, [*END_EFFECT, 1.0]))


def cylinder_inertia(shape: DragCylinder, mass: float) -> Array:
    """Inertia (3, 3) about the centre: m(3r^2+l^2)/12 across the axis, m r^2/2 along it."""
    r, length = shape.radius_m, shape.length_m
    return _about_axis(shape, 0.5 * mass * r**2, mass * (3.0 * r**2 + length**2) / 12.0)


def cylinder_added_mass(shape: DragCylinder, density: float, axial: float) -> Array:
    """Added mass (6, 6) about the link frame's origin; `axial` is the part along the axis, kg.

    Strip theory: rho pi r^2 l across, rho pi r^2 l^3/12 in rotation across the axis, none about
    it (Fossen 2011, sec. 6.4; Antonelli 2014, sec. 2.6).
    """
    displaced = density * cylinder_volume(shape)
    linear = _about_axis(shape, axial, displaced)
    angular = _about_axis(shape, 0.0, displaced * shape.length_m**2 / 12.0)
    return move_to_origin(linear, angular, np.array(shape.center_m))


def _about_axis(shape: DragCylinder, along: float, across: float) -> Array:
    axis = np.array(shape.axis)
    return across * np.eye(3) + (along - across) * np.outer(axis, axis)


def move_to_origin(linear: Array, angular: Array, center: Array) -> Array:
    """6x6 inertia about the origin from its blocks (3, 3) about `center` (3,), m.

    With v_c = v - [c]x w: M = H^T diag(linear, angular) H, H = [E, -[c]x; 0, E].
    """
    x, y, z = center
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    matrix = np.zeros((6, 6))
    matrix[:3, :3] = linear
    matrix[:3, 3:] = -linear @ skew
    matrix[3:, :3] = skew @ linear
    matrix[3:, 3:] = angular - skew @ linear @ skew
    return 0.5 * (matrix + matrix.T)
