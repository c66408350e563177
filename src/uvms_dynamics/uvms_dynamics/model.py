"""The vehicle as flat float64 tables, which numba kernels read.

Link frames here are proximal: frame i has its origin on the axis of joint i and turns with it, so
that the joint's motion is always a turn about the frame's own z axis. The vehicle file's distal
Denavit-Hartenberg frame i lies in it at Tz(d) Tx(a) Rx(alpha), a constant. Body 0 is the hull.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from uvms_dynamics.drag_table import PER_OCTAVE, resample
from uvms_dynamics.rotations import skew
from uvms_dynamics.signals import Array
from uvms_dynamics.vehicle.arm import Arm, DragCylinder, Joint
from uvms_dynamics.vehicle.frames import Pose, compose, mounting_pose
from uvms_dynamics.vehicle.shapes import move_to_origin
from uvms_dynamics.vehicle.vehicle import Vehicle


class Model(NamedTuple):
    """Tables of n joints, n + 1 bodies, s drag strips, k drag coefficients; SI and rad."""

    # placement of joint i in the frame of body i (body 0: the hull), at joint angle zero
    tree_rotation: Array  # (n, 3, 3) joint frame to parent
    tree_position: Array  # (n, 3)
    joint_offset: Array  # (n,) added to the joint angle
    tool_rotation: Array  # (3, 3) tool to the frame of link n
    tool_position: Array  # (3,)
    # bodies, in their own frame
    inertia: Array  # (n+1, 6, 6) rigid body and added mass about the frame's origin
    added_mass: Array  # (n+1, 6, 6) the added mass alone
    net_weight: Array  # (n+1,) m g - rho V g
    net_moment: Array  # (n+1, 3) m g r_g - rho V g r_b
    # hull damping
    linear_damping: Array  # (6,)
    quadratic_damping: Array  # (6,)
    # drag strips of the links, sorted by link
    strip_start: Array  # (n+1,) int64: strips of link i are strip_start[i-1] .. strip_start[i]
    strip_position: Array  # (s, 3)
    strip_axis: Array  # (s, 3)
    strip_area: Array  # (s, 2): 1/2 rho x diameter x length, diameter / kinematic viscosity
    drag_coefficient: Array  # (k,) C_D at the Reynolds numbers of `drag_table`
    drag_first: int  # exponent and top mantissa bits of the first of them
    # joints
    rotor_inertia: Array  # (n,)
    friction: Array  # (n, 3): viscous, Coulomb, width of its tanh (rad/s)
    stops: Array  # (n, 4): lower, upper, stiffness, dissipation
    effort_limit: Array  # (n,)
    rate_limit: Array  # (n,)
    acceleration_limit: Array  # (n,)


def build_model(vehicle: Vehicle) -> Model:
    """Tables of a vehicle for the kernels; all arrays are float64 and C-contiguous."""
    arm, hull, environment = vehicle.arm, vehicle.hull, vehicle.environment
    tree = _joint_placements(arm)
    tool = compose(_distal_pose(arm.joints[-1]), mounting_pose(arm.tool))
    bodies = [(hull, _IDENTITY)]
    bodies += [(k, _distal_pose(j)) for k, j in zip(arm.links, arm.joints, strict=True)]
    weights = [_weights(body, pose, environment) for body, pose in bodies]
    added = [_moved(np.array(body.added_mass), pose) for body, pose in bodies]
    rigid = [_moved(_rigid_inertia(body), pose) for body, pose in bodies]
    return Model(
        tree_rotation=_table([rotation for _, rotation in tree]),
        tree_position=_table([position for position, _ in tree]),
        joint_offset=_table(np.radians([joint.offset_deg for joint in arm.joints])),
        tool_rotation=_table(tool[1]),
        tool_position=_table(tool[0]),
        inertia=_table(np.array(rigid) + np.array(added)),
        added_mass=_table(added),
        net_weight=_table([weight for weight, _ in weights]),
        net_moment=_table([moment for _, moment in weights]),
        linear_damping=_table(hull.linear_damping),
        quadratic_damping=_table(hull.quadratic_damping),
        **_strip_tables(vehicle),
        **_joint_tables(arm),
    )


_EXPONENT_BIAS = 1023  # of a float64
_IDENTITY: Pose = (np.zeros(3), np.eye(3))


def _table(values) -> Array:
    return np.ascontiguousarray(values, dtype=np.float64)


def _distal_pose(joint: Joint) -> Pose:
    """The DH frame in the joint's own frame: Tz(d) Tx(a) Rx(alpha)."""
    c, s = math.cos(math.radians(joint.alpha_deg)), math.sin(math.radians(joint.alpha_deg))
    rotation = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    return np.array([joint.a_m, 0.0, joint.d_m]), rotation


def _joint_placements(arm: Arm) -> list[Pose]:
    return [mounting_pose(arm.base)] + [_distal_pose(joint) for joint in arm.joints[:-1]]


def _rigid_inertia(body) -> Array:
    """Rigid-body inertia (6, 6) about the origin of the body's own frame."""
    return move_to_origin(
        body.mass_kg * np.eye(3), np.array(body.inertia_kg_m2), np.array(body.cg_m)
    )


def _moved(inertia: Array, pose: Pose) -> Array:
    """6x6 inertia of a frame at `pose`, about the outer frame's origin: X^T I X."""
    position, rotation = pose
    motion = np.zeros((6, 6))
    motion[:3, :3] = motion[3:, 3:] = rotation.T
    motion[:3, 3:] = -rotation.T @ skew(position)
    moved = motion.T @ inertia @ motion
    return 0.5 * (moved + moved.T)


def _weights(body, pose: Pose, environment) -> tuple[float, Array]:
    """Wet weight and its first moment, the force pointing along the down direction."""
    position, rotation = pose
    weight = body.mass_kg * environment.gravity_m_s2
    buoyancy = environment.water_density_kg_m3 * body.volume_m3 * environment.gravity_m_s2
    cg, cb = position + rotation @ body.cg_m, position + rotation @ body.cb_m
    return weight - buoyancy, weight * cg - buoyancy * cb


def _strip_tables(vehicle: Vehicle) -> dict[str, Any]:
    environment, arm = vehicle.environment, vehicle.arm
    rows: list[Array] = []
    start = [0]
    for link, joint in zip(arm.links, arm.joints, strict=True):
        for cylinder in link.drag:
            rows.extend(_strips(cylinder, _distal_pose(joint), environment))
        start.append(len(rows))
    table = _table(rows).reshape(-1, 8)
    first, _, values = resample(arm.drag_coefficient)
    return {
        "strip_start": np.array(start, dtype=np.int64),
        "strip_position": _table(table[:, 0:3]),
        "strip_axis": _table(table[:, 3:6]),
        "strip_area": _table(table[:, 6:8]),
        "drag_coefficient": _table(values),
        "drag_first": (_EXPONENT_BIAS + first) * PER_OCTAVE,
    }


def _strips(cylinder: DragCylinder, pose: Pose, environment) -> list[Array]:
    """Rows position, axis, 1/2 rho D dl, D/nu; the stations and dl are Gauss-Legendre's."""
    position, rotation = pose
    nodes, weights = np.polynomial.legendre.leggauss(cylinder.stations)
    axis, diameter = np.array(cylinder.axis), 2.0 * cylinder.radius_m
    rows = []
    for node, weight in zip(nodes, weights, strict=True):
        place = np.array(cylinder.center_m) + 0.5 * cylinder.length_m * node * axis
        area = 0.5 * environment.water_density_kg_m3 * diameter * 0.5 * cylinder.length_m * weight
        scale = diameter / environment.kinematic_viscosity_m2_s
        rows.append(np.array([*(position + rotation @ place), *(rotation @ axis), area, scale]))
    return rows


def _joint_tables(arm: Arm) -> dict[str, Array]:
    joints = arm.joints
    radians = math.radians
    return {
        "rotor_inertia": _table([j.rotor_inertia_kg_m2 for j in joints]),
        "friction": _table(
            [
                (j.viscous_friction_nm_s, j.coulomb_friction_nm, radians(j.coulomb_width_deg_s))
                for j in joints
            ]
        ),
        "stops": _table(
            [
                (
                    radians(j.lower_deg),
                    radians(j.upper_deg),
                    j.stop_stiffness_nm_rad,
                    j.stop_dissipation_s_rad,
                )
                for j in joints
            ]
        ),
        "effort_limit": _table([j.effort_limit_nm for j in joints]),
        "rate_limit": _table([radians(j.rate_limit_deg_s) for j in joints]),
        "acceleration_limit": _table([radians(j.acceleration_limit_deg_s2) for j in joints]),
    }
