"""Columns of the flat tables that the kernels read and write.

Few wide tables instead of many narrow ones: numba counts references of every array of a tuple at
every call, which cost more than the arithmetic. Row i belongs to body i (0: the hull) and to the
joint that moves it; rows of joints have an unused row 0, so that one index serves all tables.
"""

# Model.bodies (n+1, 40)
INERTIA = 0  # 36: 6x6 rigid body and added mass about the frame's origin, row by row
NET_WEIGHT = 36  # m g - rho V g
NET_MOMENT = 37  # 3: m g r_g - rho V g r_b
BODY_COLUMNS = 40

# Model.joints (n+1, 22)
TREE_ROTATION = 0  # 9: joint frame to parent at joint angle zero, row by row
TREE_POSITION = 9  # 3: joint frame's origin in the parent's
OFFSET = 12  # added to the joint angle
ROTOR = 13  # rotor inertia
VISCOUS, COULOMB, WIDTH = 14, 15, 16  # friction
LOWER, UPPER, STIFFNESS, DISSIPATION = 17, 18, 19, 20  # end stops
EFFORT = 21  # greatest torque
JOINT_COLUMNS = 22

# Model.hull (8, 6)
LINEAR, QUADRATIC = 0, 1  # rows of damping
ADDED_MASS = 2  # 6 rows

# Model.strips (s, 8): place, axis, then
STRIP_PLACE, STRIP_AXIS = 0, 3
STRIP_AREA = 6  # 1/2 rho x diameter x length
STRIP_REYNOLDS = 7  # diameter / kinematic viscosity

# Model.tool (4, 3): rows of the rotation, then the position
TOOL_POSITION = 3

# Workspace (n+1, 74); its first 36 columns are an articulated or composite inertia
ROTATION = 36  # 9: frame i to its parent
VELOCITY = 45  # 6
ACCELERATION = 51  # 6
FORCE = 57  # 6: force on, or bias force of, the body
DOWN = 63  # 3: unit vector downward in the frame
AXIS_FORCE = 66  # 6: U = I S of the articulated body
INVERSE, REST = 72, 73  # 1 / D and the torque that is left for the joint
WORK_COLUMNS = 74
