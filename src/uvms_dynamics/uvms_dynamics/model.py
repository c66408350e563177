"""The vehicle as flat float64 tables, which numba kernels read.

Link frames here are proximal: frame i has its origin on the axis of joint i and turns with it, so
that the joint's motion is always a turn about the frame's own z axis. The link's frame i of the
vehicle file lies in it at a constant pose: Tz(d) Tx(a) Rx(alpha) for a Denavit-Hartenberg frame,
none for a joint with an `origin`. Body 0 is the hull.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvms_dynamics.drag_table import resample
from uvms_dynamics.kernels import layout
from uvms_dynamics.rotations import skew
from uvms_dynamics.signals import Array
from uvms_dynamics.vehicle import Environment, Hull, Joint, Link, Vehicle
from uvms_dynamics.vehicle.arm import Arm, DragCylinder
from uvms_dynamics.vehicle.frames import (
    IDENTITY,
    Pose,
    compose,
    distal_pose,
    mounting_pose,
    placement_pose,
)
from uvms_dynamics.vehicle.shapes import move_to_origin


class Model(NamedTuple):
    """Tables of n joints, n + 1 bodies, s drag strips and k drag coefficients; SI and rad.

    Columns: `uvms_dynamics.kernels.layout`.
    """

    bodies: Array  # (n+1, 40) inertia with added mass, net weight and its moment
    joints: Array  # (n+1, 22) placement, rotor, friction, stops, effort; row 0 is not used
    hull: Array  # (8, 6) linear damping, quadratic damping, added mass
    strips: Array  # (s, 8) drag strips, sorted by link
    strip_start: NDArray[np.int64]  # (n+1,) strips of link i: strip_start[i-1] .. strip_start[i]
    drag_coefficient: Array  # (k,) C_D at the Reynolds numbers of `drag_table`
    tool: Array  # (4, 3) tool in the last link's frame: rotation, then position


def build_model(vehicle: Vehicle) -> Model:
    """Tables of a vehicle for the kernels; all arrays are C-contiguous."""
    arm, environment = vehicle.arm, vehicle.environment
    poses = [distal_pose(joint) for joint in arm.joints]
    bodies = [_body_row(vehicle.hull, IDENTITY, environment)]
    bodies += [_body_row(k, pose, environment) for k, pose in zip(arm.links, poses, strict=True)]
    placements = joint_placements(arm)
    joints = [np.zeros(layout.JOINT_COLUMNS)]
    joints += [_joint_row(j, pose) for j, pose in zip(arm.joints, placements, strict=True)]
    position, rotation = compose(poses[-1], mounting_pose(arm.tool))
    hull = vehicle.hull
    strips, start = _strip_table(arm, poses, environment)
    return Model(
        bodies=_table(bodies),
        joints=_table(joints),
        hull=_table([hull.linear_damping, hull.quadratic_damping, *hull.added_mass]),
        strips=strips,
        strip_start=start,
        drag_coefficient=_table(resample(arm.drag_coefficient)[1]),
        tool=_table([*rotation, position]),
    )


def joint_placements(arm: Arm) -> list[Pose]:
    """Each joint's frame at angle and offset zero in the frame of the joint before it."""
    parents = [mounting_pose(arm.base), *(distal_pose(joint) for joint in arm.joints[:-1])]
    return [compose(p, placement_pose(j)) for p, j in zip(parents, arm.joints, strict=True)]


def _table(rows) -> Array:
    return np.ascontiguousarray(rows, dtype=np.float64)


def _body_row(body: Hull | Link, pose: Pose, environment: Environment) -> Array:
    """Inertia with added mass, wet weight and its first moment, in the joint's frame."""
    rigid = move_to_origin(
        body.mass_kg * np.eye(3), np.array(body.inertia_kg_m2), np.array(body.cg_m)
    )
    inertia = _moved(rigid + np.array(body.added_mass), pose)
    position, rotation = pose
    weight = body.mass_kg * environment.gravity_m_s2
    buoyancy = environment.water_density_kg_m3 * body.volume_m3 * environment.gravity_m_s2
    moment = weight * (position + rotation @ body.cg_m)
    moment -= buoyancy * (position + rotation @ body.cb_m)
    return np.array([*inertia.ravel(), weight - buoyancy, *moment])


def _moved(inertia: Array, pose: Pose) -> Array:
    """6x6 inertia of a frame at `pose`, about the outer frame's origin: X^T I X."""
    position, rotation = pose
    motion = np.zeros((6, 6))
    motion[:3, :3] = motion[3:, 3:] = rotation.T
    motion[:3, 3:] = -rotation.T @ skew(position)
    moved = motion.T @ inertia @ motion
    return 0.5 * (moved + moved.T)


def _joint_row(joint: Joint, placement: Pose) -> Array:
    position, rotation = placement
    return np.array(
        [
            *rotation.ravel(),
            *position,
            math.radians(joint.offset_deg),
            joint.rotor_inertia_kg_m2,
            joint.viscous_friction_nm_s,
            joint.coulomb_friction_nm,
            math.radians(joint.coulomb_width_deg_s),
            math.radians(joint.lower_deg),
            math.radians(joint.upper_deg),
            joint.stop_stiffness_nm_rad,
            joint.stop_dissipation_s_rad,
            joint.effort_limit_nm,
        ]
    )


def _strip_table(
    arm: Arm, poses: list[Pose], environment: Environment
) -> tuple[Array, NDArray[np.int64]]:
    rows: list[Array] = []
    start = [0]
    for link, pose in zip(arm.links, poses, strict=True):
        for cylinder in link.drag:
            rows.extend(_strips(cylinder, pose, environment))
        start.append(len(rows))
    return _table(rows).reshape(-1, 8), np.array(start, dtype=np.int64)


def _strips(cylinder: DragCylinder, pose: Pose, environment: Environment) -> list[Array]:
    """Rows place, axis, 1/2 rho D dl, D / viscosity; stations and dl are Gauss-Legendre's."""
    position, rotation = pose
    nodes, weights = np.polynomial.legendre.leggauss(cylinder.stations)
    axis, diameter = np.array(cylinder.axis), 2.0 * cylinder.radius_m
    scale = diameter / environment.kinematic_viscosity_m2_s
    rows = []
    for node, weight in zip(nodes, weights, strict=True):
        place = np.array(cylinder.center_m) + 0.5 * cylinder.length_m * node * axis
        area = 0.5 * environment.water_density_kg_m3 * diameter * 0.5 * cylinder.length_m * weight
        rows.append(np.array([*(position + rotation @ place), *(rotation @ axis), area, scale]))
    return rows
