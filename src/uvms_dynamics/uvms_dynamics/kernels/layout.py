"""Columns of the two tables that the kernels work on: the model and the workspace.

All parameters of a vehicle are one table, because numba unpacks every array that it is called with:
seven of them in a tuple took longer than the dynamics. Row i belongs to body i (0: the hull) and
to the joint that moves it. An inertia is a symmetric 6x6 matrix [A, B; B^T, C] in 21 numbers: the
upper triangle of A row by row, B row by row, the upper triangle of C.

Each group of columns is declared once, name -> width; where a column begins follows from the widths
before it. The numbers are np.int64 because numba compiles a kernel anew for every literal int that
it is called with.
"""

from collections.abc import Iterable

import numpy as np

FIRST = np.int64(0)


def _columns(widths: dict[str, int], begin: int = 0) -> Iterable[np.int64]:
    """Where each column of a group begins, the first one at `begin`."""
    ends = begin + np.cumsum(list(widths.values()))
    return np.concatenate([[begin], ends[:-1]]).astype(np.int64)


# Model (rows, 48): bodies 0..n, fixtures, then drag cylinders, coefficients, damping matrices and
# fins, counted by item.
MODEL_COLUMNS = np.int64(48)

# Bodies, in rows 0..n: rigid body and added mass in one inertia about the frame's origin; weight
# m g - rho V g and its first moment m g r_g - rho V g r_b
BODY = {"INERTIA": 21, "NET_WEIGHT": 1, "NET_MOMENT": 3}
INERTIA, NET_WEIGHT, NET_MOMENT = _columns(BODY)
_BODY_END = sum(BODY.values())

# The joint that moves the body, in rows 1..n
JOINT = {
    "PLACE": 3,  # joint frame's origin in the parent's
    "COS_TWIST": 1,  # Rx(twist) comes before the joint's Rz
    "SIN_TWIST": 1,
    "OFFSET": 1,  # added to the joint angle
    "ROTOR": 1,  # rotor inertia
    "VISCOUS": 1,  # friction
    "COULOMB": 1,
    "INVERSE_WIDTH": 1,  # 1 / the rate at which sliding friction sets in
    "LOWER": 1,  # end stops
    "UPPER": 1,
    "STIFFNESS": 1,
    "DISSIPATION": 1,
    "EFFORT": 1,  # greatest torque
    "DRAG_BEGIN": 1,  # its drag cylinders
    "DRAG_END": 1,
}
PLACE, COS_TWIST, SIN_TWIST, OFFSET, ROTOR, VISCOUS, COULOMB, INVERSE_WIDTH, *_rest = _columns(
    JOINT, _BODY_END
)
LOWER, UPPER, STIFFNESS, DISSIPATION, EFFORT, DRAG_BEGIN, DRAG_END = _rest

# The hull, in row 0 instead
HULL = np.int64(0)
HULL_ONLY = {
    "DAMPING": 6,  # body axes; the diagonals, where the matrices are diagonal
    "QUADRATIC": 6,
    "COS_TURN": 1,  # hull frame in the body frame: Rz(turn)
    "SIN_TURN": 1,
    "JOINTS": 1,  # n
    "CYLINDERS": 1,  # first item of the drag cylinders
    "GROUPS": 1,  # of eight cylinders
    "STRIPS": 1,  # on each cylinder
    "CROSS_FLOW": 1,  # first items of the drag coefficients
    "AXIAL": 1,
    "MATRICES": 1,  # first item of full damping matrices (6, 6): linear, quadratic, products; or 0
    "FINS": 1,  # first item of the fins
    "FIN_COUNT": 1,
}
DAMPING, QUADRATIC, COS_TURN, SIN_TURN, *_rest = _columns(HULL_ONLY, _BODY_END)
JOINTS, CYLINDERS, GROUPS, STRIPS, CROSS_FLOW, AXIAL, MATRICES, FINS, FIN_COUNT = _rest

# Fixtures, in row n + 1
FIXTURES = {
    "TOOL_ROTATION": 9,  # in the last link's frame
    "TOOL_POSITION": 3,
    "ADDED_MASS": 21,  # of the hull alone, about the body origin, body axes
    "TETHER_DEPTH": 1,  # reference depth; only the simulation reads the tether's
    "TETHER_REACH": 1,  # greatest distance from it that counts
    "TETHER_WEIGHT": 1,  # per metre of depth
    "TETHER_MOMENT": 3,  # per metre of depth
}
TOOL_ROTATION, TOOL_POSITION, ADDED_MASS, *_tether = _columns(FIXTURES)
TETHER_DEPTH, TETHER_REACH, TETHER_WEIGHT, TETHER_MOMENT = _tether

# Drag cylinders, in groups of eight: each of these numbers of all eight, then the next
CYLINDER = {
    "CENTER": 3,
    "AXIS": 3,
    "CROSS_REYNOLDS": 1,  # Reynolds number of 1 m/s
    "AXIAL_REYNOLDS": 1,
    "AXIAL_AREA": 1,  # 1/2 rho x wetted surface
    "STRIP": 2,  # of the first one: place along the axis, 1/2 rho x diameter x length; then others
}
CENTER, AXIS, CROSS_REYNOLDS, AXIAL_REYNOLDS, AXIAL_AREA, STRIP = _columns(CYLINDER)

# Fins, one after the other; body axes
FIN = {
    "FIN_POSITION": 3,
    "FIN_CHORD": 3,
    "FIN_NORMAL": 3,
    "FIN_PRESSURE": 1,  # 1/2 rho x area
    "FIN_SLOPE": 1,  # of the lift
    "FIN_STALL": 1,  # 1 / sin^2 of the stall angle
    "FIN_DRAG": 1,  # coefficient along the flow
    "FIN_INDUCED": 1,  # drag per lift^2
    "FIN_PLATE": 1,  # coefficient across the flow
}
FIN_POSITION, FIN_CHORD, FIN_NORMAL, FIN_PRESSURE, FIN_SLOPE, FIN_STALL, *_rest = _columns(FIN)
FIN_DRAG, FIN_INDUCED, FIN_PLATE = _rest
FIN_NUMBERS = np.int64(sum(FIN.values()))

# Coefficients of drag: pairs (a, b) of C(Re) = a + b Re in the cells of `drag_table`

# Workspace (rows, 21). Row i: joint i and the link that it moves, in its frame; behind row n there
# are slots for the drag cylinders, see `drag`.
WORKSPACE = {
    "COS": 1,  # of the joint angle with its offset
    "SIN": 1,
    "RATE": 1,  # of the joint; in the end its acceleration
    "TORQUE": 1,  # of the joint; what is left of it for the joint's own acceleration
    "VELOCITY_PRODUCT": 4,  # V x S q_dot without its two zeros
    "FORCE": 6,  # force on, or bias force of, the body
    "AXIS_FORCE": 6,  # U = I S of the articulated body
    "INVERSE": 1,  # 1 / D of the articulated body
}
COS, SIN, RATE, TORQUE, VELOCITY_PRODUCT, FORCE, AXIS_FORCE, INVERSE = _columns(WORKSPACE)
WORK_COLUMNS = np.int64(sum(WORKSPACE.values()))
