"""Dynamics in water that moves in time and space, in plain numpy, to compare the kernels with.

Over ground, body by body: each feels the flow at its own centre of buoyancy, with its material
acceleration Du/Dt in added mass and in the pressure on it (Froude-Krylov). The bodies' forces are
summed by their Jacobians.
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Hull, Link, Vehicle
from uvms_core.vehicle.frames import arm_frames
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.numpy_reference import body_forces
from uvms_dynamics.numpy_reference.coriolis import (
    body_inertia,
    kirchhoff_coriolis,
    link_jacobians,
)
from uvms_dynamics.numpy_reference.flow import Flow
from uvms_dynamics.numpy_reference.newton_euler import mass_matrix

FlowField = Callable[[Array], Flow]
"""The water at a place (3,) in the world, at one instant."""


class _Body(NamedTuple):
    body: Hull | Link
    jacobian: Array  # (6, 6+n) from (nu, q_dot) to its twist in its own frame
    slope: Array  # its derivative
    position: Array  # (3,) of its frame in the world
    rotation: Array  # (3, 3) of its frame to the world


def inverse_dynamics(
    vehicle: Vehicle,
    flow: FlowField,
    position: Array,
    quaternion: Array,
    nu: Array,
    nu_dot: Array,
    q: Array,
    q_dot: Array,
    q_ddot: Array,
) -> Array:
    """Generalized force (6+n,) that makes a motion over ground: body wrench, then joint torques.

    position (3,) m of the body origin; the rest as in `newton_euler.inverse_dynamics`.
    """
    zeta, zeta_dot = np.concatenate([nu, q_dot]), np.concatenate([nu_dot, q_ddot])
    total = np.zeros(len(zeta))
    for part in _bodies(vehicle, position, quaternion, q, q_dot):
        twist = part.jacobian @ zeta
        rate = part.jacobian @ zeta_dot + part.slope @ zeta
        total += part.jacobian.T @ _needed(vehicle, part, flow, twist, rate)
    rotors = [joint.rotor_inertia_kg_m2 for joint in vehicle.arm.joints]
    return total + np.concatenate([np.zeros(6), np.array(rotors) * q_ddot])


def forward_dynamics(
    vehicle: Vehicle,
    flow: FlowField,
    position: Array,
    quaternion: Array,
    nu: Array,
    q: Array,
    q_dot: Array,
    tau: Array,
) -> Array:
    """Accelerations (6+n,) = (nu_dot, q_ddot) over ground: M(q)^-1 (tau - bias)."""
    still = np.zeros(6), q, q_dot, np.zeros(len(q))
    bias = inverse_dynamics(vehicle, flow, position, quaternion, nu, *still)
    return np.asarray(np.linalg.solve(mass_matrix(vehicle, q), tau - bias), dtype=np.float64)


def _bodies(
    vehicle: Vehicle, position: Array, quaternion: Array, q: Array, q_dot: Array
) -> Iterator[_Body]:
    rotation, hull = quat_to_matrix(quaternion), np.eye(6, 6 + len(q))
    yield _Body(vehicle.hull, hull, np.zeros_like(hull), np.asarray(position), rotation)
    frames = arm_frames(vehicle.arm, q)[1:]
    motions = link_jacobians(vehicle.arm, q, q_dot)
    for link, motion, (origin, turn) in zip(vehicle.arm.links, motions, frames, strict=True):
        yield _Body(link, *motion, position + rotation @ origin, rotation @ turn)


def _needed(vehicle: Vehicle, part: _Body, flow: FlowField, twist: Array, rate: Array) -> Array:
    """Force (6,) that a body needs for its motion over ground, about its frame's origin."""
    body, environment, to_body = part.body, vehicle.environment, part.rotation.T
    water = flow(part.position + part.rotation @ body.cb_m)
    through, through_rate = twist.copy(), rate.copy()
    through[:3] -= to_body @ water.velocity
    through_rate[:3] -= to_body @ water.acceleration
    through_rate[:3] += np.cross(twist[3:], to_body @ water.velocity)
    added = np.array(body.added_mass)
    rigid = body_inertia(body) - added
    force = rigid @ rate + kirchhoff_coriolis(rigid, twist) @ twist
    force += added @ through_rate + kirchhoff_coriolis(added, through) @ through
    force -= body_forces.weight_and_buoyancy(body, to_body[:, 2], environment)
    pressure = environment.water_density_kg_m3 * body.volume_m3 * to_body @ water.acceleration
    force -= np.concatenate([pressure, np.cross(body.cb_m, pressure)])
    return force - _drag(vehicle, body, through)


def _drag(vehicle: Vehicle, body: Hull | Link, through: Array) -> Array:
    """Drag ON a body (6,)."""
    if isinstance(body, Hull):
        return -body_forces.hull_damping(body, through, vehicle.environment)
    across, along = vehicle.arm.drag_coefficient, vehicle.arm.friction_coefficient
    parts = [
        body_forces.cylinder_drag(each, across, along, through, vehicle.environment)
        for each in body.drag
    ]
    return np.sum([np.zeros(6), *parts], axis=0)
