"""Forces that one body needs for its motion in the water, in plain numpy (section 2.2).

A motion or a force is (6,), linear part first, about the origin of the body's own frame. Rigid
inertia depends on the motion over ground, added mass and drag on the motion relative to the water.
"""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Environment, Hull, Link
from uvms_core.vehicle.arm import DragCoefficient, DragCylinder
from uvms_core.vehicle.damping import lift_matrix, linear_matrix, quadratic_matrix
from uvms_core.vehicle.fins import fin_wrench
from uvms_core.vehicle.shapes import cylinder_surface, end_effect
from uvms_dynamics.kernels.drag_table import resample


class Motion(NamedTuple):
    """Motion of a frame over ground, in its own axes; the current in the same axes."""

    omega: Array  # (3,) angular velocity
    omega_dot: Array  # (3,) its derivative
    velocity: Array  # (3,) of the origin
    acceleration: Array  # (3,) of the origin, as an accelerometer without gravity reads it
    current: Array  # (3,) velocity of the water
    down: Array  # (3,) unit vector downward

    def relative(self) -> tuple[Array, Array]:
        """nu_r (6,) and the derivative of its components.

        The current is constant in the world, so its components turn with -omega x v_c; with
        v_dot - omega x v of the body itself the linear part is v_dot - omega x v_r.
        """
        v_r = self.velocity - self.current
        rate = self.acceleration - np.cross(self.omega, v_r)
        return np.concatenate([v_r, self.omega]), np.concatenate([rate, self.omega_dot])


def rigid_body(body: Hull | Link, motion: Motion) -> Array:
    """M_RB nu_dot + C_RB nu: m v_c_dot, and I omega_dot + omega x (I omega) about the CG.

    The print of (14) has omega x (I omega_dot): corrected. v_c_dot holds both cross products,
    of which the print lacks one.
    """
    inertia, cg = np.array(body.inertia_kg_m2), np.array(body.cg_m)
    omega, omega_dot = motion.omega, motion.omega_dot
    cg_acceleration = (
        motion.acceleration + np.cross(omega_dot, cg) + np.cross(omega, np.cross(omega, cg))
    )
    force = body.mass_kg * cg_acceleration
    moment = inertia @ omega_dot + np.cross(omega, inertia @ omega)
    return np.concatenate([force, moment + np.cross(cg, force)])


def added_mass(body: Hull | Link, motion: Motion) -> Array:
    """M_A nu_r_dot + C_A nu_r, Kirchhoff: (omega x p, omega x h + v_r x p), (p, h) = M_A nu_r."""
    matrix = np.array(body.added_mass)
    nu_r, nu_r_dot = motion.relative()
    momentum = matrix @ nu_r
    turning = np.concatenate(
        [
            np.cross(nu_r[3:], momentum[:3]),
            np.cross(nu_r[3:], momentum[3:]) + np.cross(nu_r[:3], momentum[:3]),
        ]
    )
    return matrix @ nu_r_dot + turning


def weight_and_buoyancy(body: Hull | Link, down: Array, environment: Environment) -> Array:
    """Weight at the CG and buoyancy at the CB, eq. (13) with the sign of buoyancy corrected."""
    weight = body.mass_kg * environment.gravity_m_s2 * down
    buoyancy = -environment.water_density_kg_m3 * body.volume_m3 * environment.gravity_m_s2 * down
    moment = np.cross(body.cg_m, weight) + np.cross(body.cb_m, buoyancy)
    return np.concatenate([weight + buoyancy, moment])


def hull_damping(hull: Hull, nu_r: Array, environment: Environment) -> Array:
    """D(nu_r) nu_r (6,) with the fins: (L + Q diag(|nu_r|) + |u| P) nu_r less the fins' force.

    P: products with the surge speed, without what the added mass has of them.
    """
    matrix = linear_matrix(hull) + quadratic_matrix(hull) * abs(nu_r)
    matrix += abs(nu_r[0]) * lift_matrix(hull)
    fins = [fin_wrench(fin, nu_r, environment.water_density_kg_m3) for fin in hull.fins]
    return matrix @ nu_r - np.sum(fins, axis=0) if fins else matrix @ nu_r


def cylinder_drag(
    cylinder: DragCylinder,
    across: DragCoefficient,
    along: DragCoefficient,
    nu_r: Array,
    environment: Environment,
) -> Array:
    """Drag ON a link (6,) by one cylinder, about the link's origin.

    Across the axis by strips, df = -1/2 rho kappa C_D(Re) D |v_n| v_n dl with each strip's own Re
    and the end effect kappa of the whole cylinder, and
    skin friction along it, f = -1/2 rho C_f(Re) S |v_a| v_a, by the cylinder's length and side.
    """
    axis, diameter = np.array(cylinder.axis), 2.0 * cylinder.radius_m
    pressure, viscosity = (
        0.5 * environment.water_density_kg_m3,
        environment.kinematic_viscosity_m2_s,
    )
    nodes, weights = np.polynomial.legendre.leggauss(cylinder.stations)
    total = np.zeros(6)
    for node, weight in zip(nodes, weights, strict=True):
        place = np.array(cylinder.center_m) + 0.5 * cylinder.length_m * node * axis
        velocity = nu_r[:3] + np.cross(nu_r[3:], place)
        velocity -= axis * (axis @ velocity)
        speed = float(np.linalg.norm(velocity))
        area = diameter * 0.5 * cylinder.length_m * weight
        c_d = np.interp(speed * diameter / viscosity, *resample(across))
        total += _at(place, -pressure * end_effect(cylinder) * c_d * area * speed * velocity)
    center = np.array(cylinder.center_m)
    speed = float(axis @ (nu_r[:3] + np.cross(nu_r[3:], center)))
    c_f = np.interp(abs(speed) * cylinder.length_m / viscosity, *resample(along))
    return total + _at(
        center, -pressure * c_f * cylinder_surface(cylinder) * abs(speed) * speed * axis
    )


def _at(place: Array, force: Array) -> Array:
    """A force that acts at a place, as a wrench (6,)."""
    return np.concatenate([force, np.cross(place, force)])
