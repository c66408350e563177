"""Coriolis matrix C(q, nu) of vehicle and arm in plain numpy, body by body.

C = sum over the bodies of J^T (M J_dot + C_K(J zeta) J), zeta = (nu_r, q_dot), with the body's
rigid and added mass M and Kirchhoff's skew C_K. With it M_dot - 2 C is skew-symmetric, as passivity
proofs need it (Fossen 2011, sec. 6.3; From, Gravdahl and Pettersen 2014, sec. 8.3).
"""

from collections.abc import Iterator

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Hull, Link, Vehicle
from uvms_core.vehicle.arm import Arm
from uvms_core.vehicle.frames import Pose, joint_pose, mounting_pose, placement_pose
from uvms_core.vehicle.shapes import move_to_origin
from uvms_dynamics.kernels.rotations import skew


def coriolis_matrix(vehicle: Vehicle, nu_r: Array, q: Array, q_dot: Array) -> Array:
    """C (6+n, 6+n), so that C zeta with zeta = (nu_r, q_dot) are all Coriolis forces.

    nu_r (6,) relative to the water, body frame, m/s and rad/s; q, q_dot (n,) rad, rad/s.
    """
    zeta = np.concatenate([nu_r, q_dot])
    total = np.zeros((len(zeta), len(zeta)))
    total[:6, :6] = kirchhoff_coriolis(body_inertia(vehicle.hull), nu_r)
    motions = link_jacobians(vehicle.arm, q, q_dot)
    for link, (jacobian, slope) in zip(vehicle.arm.links, motions, strict=True):
        inertia = body_inertia(link)
        gyroscopic = kirchhoff_coriolis(inertia, jacobian @ zeta)
        total += jacobian.T @ (inertia @ slope + gyroscopic @ jacobian)
    return total


def body_inertia(body: Hull | Link) -> Array:
    """Rigid and added mass (6, 6) about the origin of the body's own frame."""
    linear, angular = body.mass_kg * np.eye(3), np.array(body.inertia_kg_m2)
    return move_to_origin(linear, angular, np.array(body.cg_m)) + np.array(body.added_mass)


def kirchhoff_coriolis(inertia: Array, twist: Array) -> Array:
    """C_K (6, 6) = -[0, [p]x; [p]x, [h]x], skew, with the momentum (p, h) = M twist."""
    momentum = inertia @ twist
    matrix = np.zeros((6, 6))
    matrix[:3, 3:] = matrix[3:, :3] = -skew(momentum[:3])
    matrix[3:, 3:] = -skew(momentum[3:])
    return matrix


def link_jacobians(arm: Arm, q: Array, q_dot: Array) -> Iterator[tuple[Array, Array]]:
    """J (6, 6+n), from zeta to the twist of each link in its own frame, and its derivative."""
    jacobian = np.zeros((6, 6 + len(q)))
    jacobian[:, :6] = _to_inner_frame(*_inverse(mounting_pose(arm.base)))
    slope = np.zeros_like(jacobian)
    for i, (joint, angle, rate) in enumerate(zip(arm.joints, q, q_dot, strict=True)):
        place = _to_inner_frame(*_inverse(placement_pose(joint)))
        jacobian, slope = place @ jacobian, place @ slope
        offset, turn = _inverse(joint_pose(joint, angle))
        # the frame turns about the outer z axis: d/dt R^T = -R^T [z]x q_dot, and r is constant
        turning = -rate * turn @ skew(np.array([0.0, 0.0, 1.0]))
        step = _to_inner_frame(offset, turn)
        slope = _to_inner_frame(offset, turning) @ jacobian + step @ slope
        jacobian = step @ jacobian
        jacobian[:, 6 + i] = _axis(offset, turn)
        yield jacobian, slope


def _inverse(pose: Pose) -> Pose:
    """The inner frame's origin in its own axes, r = R^T p, and R^T."""
    position, rotation = pose
    return rotation.T @ position, rotation.T


def _to_inner_frame(offset: Array, turn: Array) -> Array:
    """Twist of the outer frame -> of the inner one (6, 6): [R^T, -[r]x R^T; 0, R^T]."""
    matrix = np.zeros((6, 6))
    matrix[:3, :3] = matrix[3:, 3:] = turn
    matrix[:3, 3:] = -skew(offset) @ turn
    return matrix


def _axis(offset: Array, turn: Array) -> Array:
    """Twist (6,) of the inner frame for a unit rate about the outer z axis: (z x r, z)."""
    axis = turn[:, 2]
    return np.concatenate([np.cross(axis, offset), axis])
