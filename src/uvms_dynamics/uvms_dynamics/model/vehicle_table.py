"""The vehicle as one flat float64 table, which numba kernels read.

Link frames here are proximal: frame i has its origin on the axis of joint i and turns with it, so
that the joint's motion is always a turn about the frame's own z axis. The link's frame i of the
vehicle file lies in it at a constant pose: Tz(d) Tx(a) Rx(alpha) for a Denavit-Hartenberg frame,
none for a joint with an `origin`. Body 0 is the hull.

Moreover each frame is turned about its z axis such that the next joint lies in it at Tr(p)
Rx(twist), without a third angle: Rz(a) Rx(twist) Rz(c) is any rotation, Rz(a) goes into the parent
frame and Rz(c) into the joint angle. So the kernels turn inertias in two planes.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Environment, Hull, Joint, Link, Vehicle
from uvms_core.vehicle.arm import Arm, DragCoefficient, DragCylinder
from uvms_core.vehicle.damping import linear_matrix, quadratic_matrix
from uvms_core.vehicle.frames import (
    IDENTITY,
    Pose,
    compose,
    distal_pose,
    joint_placements,
    mounting_pose,
)
from uvms_core.vehicle.shapes import cylinder_surface, end_effect, move_to_origin
from uvms_dynamics.kernels import layout
from uvms_dynamics.kernels.drag_table import cell_lines
from uvms_dynamics.kernels.numba_internals.lanes import LANES
from uvms_dynamics.kernels.rotations import skew
from uvms_dynamics.model.resistance_table import damping_matrices, fin_numbers

Model = Array
"""Table (rows, 48), C-contiguous, SI and rad; columns: `uvms_dynamics.kernels.layout`."""


class _Mount(NamedTuple):
    """A joint in its parent's frame: Rz(turn), then Tr(place) Rx(twist), then Rz(offset + q)."""

    turn: float  # of the parent's frame, so that
    place: Array  # (3,) and
    twist: float  # are seen in the turned frame
    offset: float


def build_model(vehicle: Vehicle) -> Model:
    """Table of a vehicle for the kernels."""
    arm, environment = vehicle.arm, vehicle.environment
    mounts, turns = _mounts(arm)
    poses = body_poses(arm)[1:]
    n = vehicle.n_joints
    rows = np.zeros((n + 2, layout.MODEL_COLUMNS))
    _set_body(rows[0], vehicle.hull, body_poses(arm)[0], environment)
    _set_hull(rows[0], vehicle.hull, turns[0])
    groups, strips, ends = _drag_groups(arm, poses, environment)
    matrices, fins = damping_matrices(vehicle.hull), fin_numbers(vehicle.hull, environment)
    blocks = (groups, *map(cell_lines, _coefficients(arm)), matrices, fins)
    tables = [rows, *map(_as_rows, blocks)]
    starts = np.cumsum([table.size for table in tables])
    _put(rows[0], layout.JOINTS, [n])
    _put(rows[0], layout.CYLINDERS, [starts[0], len(groups), strips])
    _put(rows[0], layout.CROSS_FLOW, starts[1:3])
    _put(rows[0], layout.MATRICES, [starts[3] if matrices.size else 0])
    _put(rows[0], layout.FINS, [starts[4], len(fins)])
    for i, (link, joint, mount, pose) in enumerate(
        zip(arm.links, arm.joints, mounts, poses, strict=True), start=1
    ):
        _set_body(rows[i], link, pose, environment)
        _set_joint(rows[i], joint, mount, turns[i])
        rows[i, [layout.DRAG_BEGIN, layout.DRAG_END]] = ends[i - 1 : i + 1]
    _set_fixtures(rows[n + 1], vehicle, compose(poses[-1], mounting_pose(arm.tool)))
    return np.ascontiguousarray(np.vstack(tables))


def body_poses(arm: Arm) -> list[Pose]:
    """The vehicle file's frame of each body 0..n in the kernels' frame of it."""
    _, turns = _mounts(arm)
    poses = [IDENTITY, *map(distal_pose, arm.joints)]
    return [_turned(turn, pose) for turn, pose in zip(turns, poses, strict=True)]


def _mounts(arm: Arm) -> tuple[list[_Mount], list[float]]:
    """Of the joints (n,), and the turn of each body's frame (n + 1,)."""
    mounts = [_mount(p, j) for p, j in zip(joint_placements(arm), arm.joints, strict=True)]
    return mounts, [mount.turn for mount in mounts] + [0.0]


_NO_TILT = 1e-15  # sine of a twist below which only the sum of the two other angles counts


def _mount(pose: Pose, joint: Joint) -> _Mount:
    """The joint's place in its parent's frame, its rotation as Rz(turn) Rx(twist) Rz(offset)."""
    place, rotation = pose
    across = math.hypot(rotation[0, 2], rotation[1, 2])
    turn = math.atan2(rotation[0, 2], -rotation[1, 2]) if across > _NO_TILT else 0.0
    place, rotation = _turned(turn, pose)
    twist = math.atan2(-rotation[1, 2], rotation[2, 2])
    rest = _about_x(twist).T @ rotation
    offset = math.atan2(rest[1, 0], rest[0, 0]) + math.radians(joint.offset_deg)
    return _Mount(turn, place, twist, offset)


def _turned(turn: float, pose: Pose) -> Pose:
    """A pose seen from a frame that is turned about z."""
    return compose((np.zeros(3), _about_z(turn).T), pose)


def _about_x(angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def _about_z(angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _set_body(row: Array, body: Hull | Link, pose: Pose, environment: Environment) -> None:
    """Inertia with added mass, wet weight and its first moment, in the joint's frame."""
    rigid = move_to_origin(
        body.mass_kg * np.eye(3), np.array(body.inertia_kg_m2), np.array(body.cg_m)
    )
    position, rotation = pose
    weight = body.mass_kg * environment.gravity_m_s2
    buoyancy = environment.water_density_kg_m3 * body.volume_m3 * environment.gravity_m_s2
    moment = weight * (position + rotation @ body.cg_m)
    moment -= buoyancy * (position + rotation @ body.cb_m)
    inertia = packed(moved(rigid + np.array(body.added_mass), pose))
    _put(row, layout.INERTIA, inertia)
    _put(row, layout.NET_WEIGHT, [weight - buoyancy])
    _put(row, layout.NET_MOMENT, moment)


def _set_hull(row: Array, hull: Hull, turn: float) -> None:
    if not damping_matrices(hull).size:
        _put(row, layout.DAMPING, np.diag(linear_matrix(hull)))
        _put(row, layout.QUADRATIC, np.diag(quadratic_matrix(hull)))
    _put(row, layout.COS_TURN, [math.cos(turn)])
    _put(row, layout.SIN_TURN, [math.sin(turn)])


def _set_joint(row: Array, joint: Joint, mount: _Mount, turn: float) -> None:
    """What the joint is like; `turn` is that of its own frame."""
    _put(row, layout.PLACE, mount.place)
    _put(row, layout.COS_TWIST, [math.cos(mount.twist), math.sin(mount.twist)])
    _put(row, layout.OFFSET, [mount.offset + turn])
    _put(row, layout.ROTOR, [joint.rotor_inertia_kg_m2])
    _put(row, layout.VISCOUS, [joint.viscous_friction_nm_s, joint.coulomb_friction_nm])
    _put(row, layout.INVERSE_WIDTH, [1.0 / math.radians(joint.coulomb_width_deg_s)])
    _put(row, layout.LOWER, np.radians([joint.lower_deg, joint.upper_deg]))
    _put(row, layout.STIFFNESS, [joint.stop_stiffness_nm_rad, joint.stop_dissipation_s_rad])
    _put(row, layout.EFFORT, [joint.effort_limit_nm])


def _set_fixtures(row: Array, vehicle: Vehicle, tool: Pose) -> None:
    """The tool in the last link's frame, the hull's own added mass, and the tether."""
    _put(row, layout.TOOL_ROTATION, tool[1].ravel())
    _put(row, layout.TOOL_POSITION, tool[0])
    _put(row, layout.ADDED_MASS, packed(np.array(vehicle.hull.added_mass)))
    if (tether := vehicle.tether) is not None:
        _put(row, layout.TETHER_DEPTH, [tether.reference_depth_m])
        _put(row, layout.TETHER_REACH, [tether.linear_within_m])
        _put(row, layout.TETHER_WEIGHT, [tether.weight_per_m_n])
        _put(row, layout.TETHER_MOMENT, tether.moment_per_m_nm)


def _put(row: Array, column: Any, values: Any) -> None:
    """Write numbers to a row from a column on."""
    row[column : column + len(values)] = values


def packed(inertia: Array) -> Array:
    """The 21 numbers of a symmetric 6x6 matrix, in the order of the layout."""
    upper = np.triu_indices(3)
    return np.concatenate([inertia[:3, :3][upper], inertia[:3, 3:].ravel(), inertia[3:, 3:][upper]])


def moved(inertia: Array, pose: Pose) -> Array:
    """6x6 inertia of a frame at `pose`, about the outer frame's origin: X^T I X."""
    position, rotation = pose
    motion = np.zeros((6, 6))
    motion[:3, :3] = motion[3:, 3:] = rotation.T
    motion[:3, 3:] = -rotation.T @ skew(position)
    moved = motion.T @ inertia @ motion
    return 0.5 * (moved + moved.T)


def _drag_groups(
    arm: Arm, poses: list[Pose], environment: Environment
) -> tuple[Array, int, list[int]]:
    """Cylinders in groups of eight, strips on each, and where each link's cylinders begin.

    A group is (numbers, 8); where cylinders have fewer strips than others, the rest have no area.
    """
    cylinders: list[Array] = []
    ends = [0]
    for link, pose in zip(arm.links, poses, strict=True):
        cylinders += [_cylinder(cylinder, pose, environment) for cylinder in link.drag]
        ends.append(len(cylinders))
    length = max((len(each) for each in cylinders), default=int(layout.STRIP))
    table = np.zeros((-(-len(cylinders) // LANES) * LANES, length))
    for row, numbers in zip(table, cylinders, strict=False):
        row[: len(numbers)] = numbers
    groups = table.reshape(-1, LANES, length).transpose(0, 2, 1)
    return groups, (length - int(layout.STRIP)) // 2, ends


def _cylinder(cylinder: DragCylinder, pose: Pose, environment: Environment) -> Array:
    """Numbers of a cylinder; its strips are at Gauss-Legendre stations."""
    position, rotation = pose
    half, pressure = 0.5 * cylinder.length_m, 0.5 * environment.water_density_kg_m3
    viscosity, diameter = environment.kinematic_viscosity_m2_s, 2.0 * cylinder.radius_m
    nodes, weights = np.polynomial.legendre.leggauss(cylinder.stations)
    strips = np.column_stack(
        [half * nodes, end_effect(cylinder) * pressure * diameter * half * weights]
    )
    row = np.zeros(int(layout.STRIP) + strips.size)
    _put(row, layout.CENTER, position + rotation @ cylinder.center_m)
    _put(row, layout.AXIS, rotation @ cylinder.axis)
    _put(row, layout.CROSS_REYNOLDS, [diameter / viscosity, cylinder.length_m / viscosity])
    _put(row, layout.AXIAL_AREA, [pressure * cylinder_surface(cylinder)])
    _put(row, layout.STRIP, strips.ravel())
    return row


def _coefficients(arm: Arm) -> tuple[DragCoefficient, DragCoefficient]:
    return arm.drag_coefficient, arm.friction_coefficient


def _as_rows(values: Array) -> Array:
    """Any numbers one after the other as rows of the table."""
    rows = -(-values.size // layout.MODEL_COLUMNS)
    table = np.zeros((rows, layout.MODEL_COLUMNS))
    table.ravel()[: values.size] = values.ravel()
    return table
