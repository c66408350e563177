"""Bringing a candidate onto the end effector's path: precision comes first.

The differential kinematics of eq. (12), with roll = pitch = 0, read y_dot = J(c) c_dot; bounded,
damped, weighted Newton steps solve y(c) = y_d for the increment of c next to the one given.
"""

import numpy as np

from uvms_dynamics import end_effector, end_effector_jacobian
from uvms_dynamics.kernels.jit import inner, kernel, shared
from uvms_dynamics.kernels.rotations import matrix_to_quat, quat_to_rotation_vector
from uvms_planner.linear import solve_in_place
from uvms_planner.problem import VEHICLE, configuration_after, yaw_quaternion

CONVERGED_M = 1e-8
CONVERGED_RAD = 1e-8


@kernel
def configuration_jacobian(model, configuration):
    """J (6, m): velocity and angular velocity of the tool, world axes, per rate of c.

    The columns of eq. (12) for a level vehicle: x, y, z are world axes already, and psi turns about
    the body z axis, which is the world's.
    """
    q = configuration[VEHICLE:]
    full = end_effector_jacobian(model, yaw_quaternion(configuration[3]), q)
    jacobian = np.zeros((6, configuration.shape[0]))
    for row in range(6):
        jacobian[row, 3] = full[row, 5]
        for i in range(q.shape[0]):
            jacobian[row, VEHICLE + i] = full[row, 6 + i]
    for i in range(3):
        jacobian[i, i] = 1.0
    return jacobian


@inner
def tool_pose(model, configuration):
    """Position (3,) and rotation (3, 3) of the tool in the world for c (m,), eq. (1)."""
    return end_effector(
        model,
        configuration[:3],
        yaw_quaternion(configuration[3]),
        configuration[VEHICLE:],
    )


@inner
def rotation_error(desired, actual):
    """Rotation vector (3,), world axes, that turns `actual` (3, 3) into `desired` (3, 3)."""
    turn = np.zeros((3, 3))
    for row in range(3):
        for column in range(3):
            for k in range(3):
                turn[row, column] += desired[row, k] * actual[column, k]
    return quat_to_rotation_vector(matrix_to_quat(turn))


@inner
def tool_error(model, configuration, desired, desired_rotation, oriented, error):
    """Fill `error` (6,) with desired minus actual pose at c (m,); return (m, rad) distances."""
    position, rotation = tool_pose(model, configuration)
    for i in range(3):
        error[i] = desired[i] - position[i]
    distance = np.sqrt(error[0] ** 2 + error[1] ** 2 + error[2] ** 2)
    if not oriented:
        return distance, 0.0
    turn = rotation_error(desired_rotation, rotation)
    for i in range(3):
        error[3 + i] = turn[i]
    return distance, np.sqrt(error[3] ** 2 + error[4] ** 2 + error[5] ** 2)


@inner
def within_tolerance(problem, distance, angle):
    """Whether an end-effector error is below e, eq. (17)."""
    return distance < problem.position_tolerance and angle < problem.orientation_tolerance


@shared
def weighted_step(jacobian, error, readiness, free, damping, equations, step):
    """Fill `step` (m,) with W J^T (J W J^T + lambda^2 tr I)^-1 error over the free variables."""
    gram = np.zeros((6, 6))
    force = np.zeros(6)
    trace = 0.0
    for a in range(equations):
        force[a] = error[a]
        for b in range(equations):
            for i in range(readiness.shape[0]):
                if free[i]:
                    gram[a, b] += jacobian[a, i] * readiness[i] * jacobian[b, i]
        trace += gram[a, a]
    for a in range(equations):
        gram[a, a] += damping**2 * trace + 1e-30
    for i in range(readiness.shape[0]):
        step[i] = 0.0
    if not solve_in_place(gram, force, equations):
        return
    for i in range(readiness.shape[0]):
        if free[i]:
            for a in range(equations):
                step[i] += readiness[i] * jacobian[a, i] * force[a]


@kernel
def project(model, problem, increment):
    """Move `increment` (m,) within its bounds onto the path, in place; return (m, rad) errors."""
    lower, upper, readiness = problem.lower, problem.upper, problem.readiness
    start, oriented, damping = problem.configuration, problem.oriented, problem.damping
    size = increment.shape[0]
    equations = 6 if oriented else 3
    error, step = np.zeros(6), np.zeros(size)
    free = np.zeros(size, dtype=np.bool_)
    for i in range(size):
        increment[i] = min(max(increment[i], lower[i]), upper[i])
    end = configuration_after(start, increment)
    distance, angle = tool_error(model, end, problem.position, problem.rotation, oriented, error)
    for _ in range(problem.iterations):
        if distance < CONVERGED_M and angle < CONVERGED_RAD:
            break
        jacobian = configuration_jacobian(model, end)
        for i in range(size):
            free[i] = readiness[i] > 0.0
        for _pass in range(size):
            weighted_step(jacobian, error, readiness, free, damping, equations, step)
            if not _release_blocked(increment, step, free, lower, upper):
                break
        for i in range(size):
            moved = increment[i] + step[i]
            increment[i] = min(max(moved, lower[i]), upper[i])
        end = configuration_after(start, increment)
        distance, angle = tool_error(
            model, end, problem.position, problem.rotation, oriented, error
        )
        if not oriented and _shift(increment, error, readiness, lower, upper):
            return 0.0, 0.0
    return distance, angle


@inner
def _shift(increment, error, readiness, lower, upper):
    """Take what a Newton step left of a position error by moving the vehicle, where it may.

    The tool's position is linear in x, y, z, so that this removes the second-order rest exactly.
    """
    for i in range(3):
        moved = increment[i] + error[i]
        if readiness[i] <= 0.0 or not lower[i] <= moved <= upper[i]:
            return False
    for i in range(3):
        increment[i] += error[i]
    return True


@inner
def _release_blocked(increment, step, free, lower, upper):
    """Take variables out of `free` that sit at a bound and would be pushed beyond it."""
    changed = False
    for i in range(increment.shape[0]):
        if not free[i]:
            continue
        beyond_upper = step[i] > 0.0 and increment[i] >= upper[i]
        beyond_lower = step[i] < 0.0 and increment[i] <= lower[i]
        if beyond_upper or beyond_lower:
            free[i] = False
            changed = True
    return changed
