"""Columns of the flat tables that the kernels read and write.

Few wide tables instead of many narrow ones: numba counts references of every array of a tuple at
every call, which cost more than the arithmetic. Row i belongs to body i (0: the hull) and to the
joint that moves it; rows of joints have an unused row 0, so that one index serves all tables.

The numbers are np.int64 because numba compiles a function anew for every literal int it is called
with: a third of the time to compile.
"""

import numpy as np

HULL = np.int64(0)  # row of the hull

# Model.bodies (n+1, 40)
INERTIA = np.int64(0)  # 36: 6x6 rigid body and added mass about the frame's origin, row by row
LINEAR_BLOCK, ANGULAR_BLOCK, LAST_ROW = np.int64(0), np.int64(21), np.int64(30)  # in it
NET_WEIGHT = np.int64(36)  # m g - rho V g
NET_MOMENT = np.int64(37)  # 3: m g r_g - rho V g r_b
BODY_COLUMNS = np.int64(40)

# Model.joints (n+1, 22)
TREE_ROTATION = np.int64(0)  # 9: joint frame to parent at joint angle zero, row by row
TREE_POSITION = np.int64(9)  # 3: joint frame's origin in the parent's
OFFSET = np.int64(12)  # added to the joint angle
ROTOR = np.int64(13)  # rotor inertia
VISCOUS, COULOMB, WIDTH = np.arange(14, 17, dtype=np.int64)  # friction
LOWER, UPPER, STIFFNESS, DISSIPATION = np.arange(17, 21, dtype=np.int64)  # end stops
EFFORT = np.int64(21)  # greatest torque
JOINT_COLUMNS = np.int64(22)

# Model.hull (8, 6)
LINEAR, QUADRATIC = np.int64(0), np.int64(1)  # rows of damping
ADDED_MASS = np.int64(2)  # 6 rows

# Model.strips (s, 8): place, axis, then
STRIP_PLACE, STRIP_AXIS = np.int64(0), np.int64(3)
STRIP_AREA = np.int64(6)  # 1/2 rho x diameter x length
STRIP_REYNOLDS = np.int64(7)  # diameter / kinematic viscosity

# Model.tool (4, 3): rows of the rotation, then the position
TOOL_POSITION = np.int64(3)

# Workspace (n+1, 74); its first 36 columns are an articulated or composite inertia
ROTATION = np.int64(36)  # 9: frame i to its parent
VELOCITY = np.int64(45)  # 6
ACCELERATION = np.int64(51)  # 6
FORCE = np.int64(57)  # 6: force on, or bias force of, the body
DOWN = np.int64(63)  # 3: unit vector downward in the frame
AXIS_FORCE = np.int64(66)  # 6: U = I S of the articulated body
INVERSE, REST = np.int64(72), np.int64(73)  # 1 / D and the torque that is left for the joint
WORK_COLUMNS = np.int64(74)
