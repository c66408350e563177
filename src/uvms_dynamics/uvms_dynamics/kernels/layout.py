"""Columns of the two tables that the kernels work on: the model and the workspace.

All parameters of a vehicle are one table, because numba unpacks every array that it is called with:
seven of them in a tuple took longer than the dynamics. Row i belongs to body i (0: the hull) and
to the joint that moves it. An inertia is a symmetric 6x6 matrix [A, B; B^T, C] in 21 numbers: the
upper triangle of A row by row, B row by row, the upper triangle of C.

The numbers are np.int64 because numba compiles a function anew for every literal int it is called
with: a third of the time to compile.
"""

import numpy as np

FIRST = np.int64(0)

# Model (rows, 48): bodies 0..n, fixtures, then drag cylinders and coefficients, counted by item.
# Bodies, in rows 0..n: rigid body and added mass in one inertia about the frame's origin
INERTIA = np.int64(0)  # 21
NET_WEIGHT = np.int64(21)  # m g - rho V g
NET_MOMENT = np.int64(22)  # 3: m g r_g - rho V g r_b

# The joint that moves the body, in rows 1..n
PLACE = np.int64(25)  # 3: joint frame's origin in the parent's
COS_TWIST, SIN_TWIST = np.int64(28), np.int64(29)  # Rx(twist) comes before the joint's Rz
OFFSET = np.int64(30)  # added to the joint angle
ROTOR = np.int64(31)  # rotor inertia
VISCOUS, COULOMB = np.int64(32), np.int64(33)  # friction
PER_WIDTH = np.int64(34)  # 1 / the rate at which sliding friction sets in
LOWER, UPPER, STIFFNESS, DISSIPATION = np.arange(35, 39, dtype=np.int64)  # end stops
EFFORT = np.int64(39)  # greatest torque
DRAG_BEGIN, DRAG_END = np.int64(40), np.int64(41)  # its drag cylinders

# The hull, in row 0 instead
HULL = np.int64(0)
DAMPING, QUADRATIC = np.int64(25), np.int64(31)  # 6 each, body axes
COS_TURN, SIN_TURN = np.int64(37), np.int64(38)  # hull frame in the body frame: Rz(turn)
JOINTS = np.int64(39)  # n
CYLINDERS = np.int64(40)  # first item of the drag cylinders
GROUPS, STRIPS = np.int64(41), np.int64(42)  # how many of eight cylinders; strips on each
CROSS_FLOW, AXIAL = np.int64(43), np.int64(44)  # first items of the drag coefficients

# Fixtures, in row n + 1
TOOL_ROTATION, TOOL_POSITION = np.int64(0), np.int64(9)  # in the last link's frame
ADDED_MASS = np.int64(12)  # 21: of the hull alone, about the body origin, body axes
TETHER_DEPTH = np.int64(33)  # reference depth; only the simulation reads these
TETHER_WEIGHT, TETHER_MOMENT = np.int64(34), np.int64(35)  # 1 and 3, per metre of depth

# Drag cylinders, in groups of eight: each of these numbers of all eight, then the next
CENTER, AXIS = np.int64(0), np.int64(3)
CROSS_REYNOLDS, AXIAL_REYNOLDS = np.int64(6), np.int64(7)  # Reynolds number of 1 m/s
AXIAL_AREA = np.int64(8)  # 1/2 rho x wetted surface
STRIP = np.int64(9)  # pairs: place along the axis, 1/2 rho x diameter x length

# Coefficients of drag: pairs (a, b) of C(Re) = a + b Re in the cells of `drag_table`

MODEL_COLUMNS = np.int64(48)

# Workspace (rows, 21). Row i: joint i and the link that it moves, in its frame; behind row n there
# are slots for the drag cylinders, see `drag`.
COS, SIN = np.int64(0), np.int64(1)  # of the joint angle with its offset
RATE = np.int64(2)  # of the joint; in the end its acceleration
TORQUE = np.int64(3)  # of the joint; what is left of it for the joint's own acceleration
VELOCITY_PRODUCT = np.int64(4)  # 4: V x S q_dot without its two zeros
FORCE = np.int64(8)  # 6: force on, or bias force of, the body
AXIS_FORCE = np.int64(14)  # 6: U = I S of the articulated body
INVERSE = np.int64(20)  # 1 / D of the articulated body
WORK_COLUMNS = np.int64(21)
