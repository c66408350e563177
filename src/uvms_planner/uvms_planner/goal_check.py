"""Checks of a path goal before it is accepted: form, start, and whether it can be followed."""

import numpy as np
from numpy.typing import NDArray

from uvms_core.checks import is_unit
from uvms_core.end_effector_path import EndEffectorPath, PathSample
from uvms_core.signals import Array, PathGoal
from uvms_dynamics.kernels.jit import kernel
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_planner.config import PlannerConfig
from uvms_planner.errors import GoalRejected
from uvms_planner.joined_path import JoinedPath
from uvms_planner.linear import copy_into
from uvms_planner.problem import StepProblem
from uvms_planner.projection import project, rotation_error, tool_pose, within_tolerance
from uvms_planner.solver import StepSolver

SEARCH_ITERATIONS = 200
STILL = 1e-9  # m/s or rad/s


def check_path_goal(goal: PathGoal) -> None:
    """Raise GoalRejected if times, positions or orientations are malformed or above the water."""
    times, positions = np.asarray(goal.times), np.asarray(goal.positions)
    orientations = np.asarray(goal.orientations)
    _check_shapes(times, positions, orientations)
    for name, values in (
        ("times", times),
        ("positions", positions),
        ("orientations", orientations),
    ):
        if not np.all(np.isfinite(values)):
            row = int(np.argwhere(~np.isfinite(values))[0][0])
            raise GoalRejected(f"path: {name}[{row}] = {values[row]} is not finite")
    if times[0] != 0.0:
        raise GoalRejected(f"path: the first time is {times[0]:g} s, must be 0")
    if np.any(np.diff(times) <= 0.0):
        row = int(np.argmax(np.diff(times) <= 0.0)) + 1
        raise GoalRejected(
            f"path: times must increase; times[{row}] = {times[row]:g} s after {times[row - 1]:g} s"
        )
    if np.min(positions[:, 2]) < 0.0:
        row = int(np.argmax(positions[:, 2] < 0.0))
        raise GoalRejected(
            f"path: at t = {times[row]:g} s it is {-positions[row, 2]:g} m above the surface"
            " (z is down, must be >= 0)"
        )
    if len(orientations):
        norms = np.linalg.norm(orientations, axis=1)
        row = int(np.argmax(np.abs(norms - 1.0)))
        if not is_unit(norms[row] ** 2):
            raise GoalRejected(
                f"path: orientations[{row}] has norm {norms[row]:.4g}, must be a unit quaternion"
            )
    _check_pointing(goal)
    if not 1.0 <= goal.time_scale_max < np.inf:
        raise GoalRejected(f"path: time_scale_max is {goal.time_scale_max:g}, must be >= 1")


def _check_pointing(goal: PathGoal) -> None:
    """The tool's axis and where it points, if it is to point anywhere."""
    axis, directions = np.asarray(goal.tool_axis), np.asarray(goal.axis_directions)
    wanted = ((3,), (len(goal.times), 3)) if axis.size else ((0,), (0, 3))
    if (axis.shape, directions.shape) != wanted:
        raise GoalRejected(
            f"path: tool_axis has shape {axis.shape} and axis_directions {directions.shape}; needed"
            f" are (3,) and ({len(goal.times)}, 3), or (0,) and (0, 3) for none"
        )
    if not axis.size:
        return
    if len(goal.orientations):
        raise GoalRejected("path: it has orientations and a tool_axis; leave out one of them")
    for name, rows in (("tool_axis", axis[None]), ("axis_directions", directions)):
        squares = np.sum(rows**2, axis=1)
        row = int(np.argmax(np.where(np.isfinite(squares), np.abs(squares - 1.0), np.inf)))
        if not is_unit(squares[row]):
            raise GoalRejected(f"path: {name}[{row}] = {rows[row]} is no unit vector")
    cosines = np.sum(directions[1:] * directions[:-1], axis=1)
    if np.any(cosines <= 0.0):
        row = int(np.argmax(cosines <= 0.0)) + 1
        raise GoalRejected(
            f"path: axis_directions[{row}] is a right angle or more from the one before it; give"
            " points in between"
        )


def _check_shapes(times: Array, positions: Array, orientations: Array) -> None:
    count = len(times) if times.ndim == 1 else 0
    if count < 2 or positions.shape != (count, 3):
        raise GoalRejected(
            f"path: times has shape {times.shape} and positions {positions.shape};"
            " needed are (k,) and (k, 3) with k >= 2"
        )
    if orientations.shape not in ((0, 4), (count, 4)):
        raise GoalRejected(
            f"path: orientations has shape {orientations.shape}; needed is ({count}, 4), or (0, 4)"
            " for none"
        )


def check_start(goal: PathGoal, position: Array, quaternion: Array, config: PlannerConfig) -> None:
    """Raise GoalRejected where the goal begins too far from the tool's pose."""
    gap = float(np.linalg.norm(goal.positions[0] - position))
    if gap > config.start_tolerance_m:
        raise GoalRejected(
            f"path: its first point is {gap:.4g} m from the end effector, allowed"
            f" {config.start_tolerance_m:g} m; the end effector is at ({_numbers(position)}) m"
        )
    if len(goal.tool_axis):
        axis = quat_to_matrix(quaternion) @ goal.tool_axis
        _check_start_of_axis(axis, goal.axis_directions[0], config)
    if not len(goal.orientations):
        return
    turn = _angle_between(goal.orientations[0], quaternion)
    if turn > np.deg2rad(config.start_tolerance_deg):
        raise GoalRejected(
            f"path: its first orientation is {np.rad2deg(turn):.4g} deg from the end"
            f" effector's, allowed {config.start_tolerance_deg:g} deg; the end effector's is"
            f" ({_numbers(quaternion)})"
        )


def _check_start_of_axis(axis: Array, wanted: Array, config: PlannerConfig) -> None:
    off = float(np.arctan2(np.linalg.norm(np.cross(axis, wanted)), axis @ wanted))
    if off > np.deg2rad(config.start_tolerance_deg):
        raise GoalRejected(
            f"path: tool_axis points ({_numbers(axis)}), {np.rad2deg(off):.4g} deg from its first"
            f" direction, allowed {config.start_tolerance_deg:g} deg"
        )


def check_reachable(
    path: EndEffectorPath | JoinedPath, solver: StepSolver, configuration: Array, step: float
) -> None:
    """Raise GoalRejected, with the time, if vehicle and arm cannot follow the path.

    The path is followed with the projection alone, from `configuration` (m,), within the rate and
    joint limits of every planner step.
    """
    count = max(1, int(np.ceil(path.duration / step)))
    times = np.minimum(np.arange(1, count + 1) * step, path.duration)
    targets = [path.sample(float(time)) for time in times]
    positions = np.array([target.position for target in targets])
    rotations = np.zeros((0, 3, 3))
    if path.oriented:
        rotations = np.array([quat_to_matrix(target.quaternion) for target in targets])
    still = np.zeros_like(configuration)
    bounds = solver.limits.rate_increments(configuration)
    problem = solver.problem(configuration, still, targets[0], bounds)
    frozen, limits = problem.upper <= problem.lower, solver.limits
    reach = np.where(frozen, 0.0, limits.reach)
    index, distance, angle = follow_by_projection(
        solver.model, problem, positions, rotations, limits.lower, limits.upper, reach
    )
    if index < 0:
        return
    _reject_unreachable(times[index:], targets[index:], problem, solver, frozen)
    raise GoalRejected(
        f"path too fast: at t = {times[index]:g} s {_motion_text(targets[index])}; within the rate"
        f" limits the end effector stays {_gap_text(problem, distance, angle)}"
    )


@kernel
def follow_by_projection(model, problem, positions, rotations, lower, upper, reach):
    """Project step by step along `positions` (k, 3); `problem`'s arrays are left where it failed.

    Returns the index of the first point that is not within e, with (m, rad) errors; -1 if none.
    """
    increment = np.zeros_like(problem.configuration)
    for index in range(positions.shape[0]):
        for i in range(increment.shape[0]):
            room_up = max(upper[i] - problem.configuration[i], 0.0)
            room_down = max(problem.configuration[i] - lower[i], 0.0)
            problem.upper[i] = min(reach[i], room_up)
            problem.lower[i] = -min(reach[i], room_down)
            increment[i] = 0.0
        copy_into(problem.position, positions[index])
        if problem.oriented:
            for row in range(3):
                copy_into(problem.rotation[row], rotations[index, row])
        distance, angle = project(model, problem, increment)
        if not within_tolerance(problem, distance, angle):
            return index, distance, angle
        for i in range(increment.shape[0]):
            problem.configuration[i] += increment[i]
    return -1, 0.0, 0.0


def _reject_unreachable(
    times: Array,
    targets: list[PathSample],
    problem: StepProblem,
    solver: StepSolver,
    frozen: NDArray[np.bool_],
) -> None:
    """Raise GoalRejected at the first target that is out of reach at any speed."""
    configuration = problem.configuration.copy()
    for time, target in zip(times, targets, strict=True):
        lower = np.where(frozen, 0.0, np.minimum(solver.limits.lower - configuration, 0.0))
        upper = np.where(frozen, 0.0, np.maximum(solver.limits.upper - configuration, 0.0))
        still = np.zeros_like(configuration)
        unhurried = solver.problem(configuration, still, target, (lower, upper))
        unhurried = unhurried._replace(iterations=SEARCH_ITERATIONS)
        distance, angle = project(solver.model, unhurried, still)
        if distance >= problem.position_tolerance:
            raise GoalRejected(
                f"path: at t = {time:g} s the nearest reachable point is {distance:.4g} m away,"
                f" allowed {problem.position_tolerance:g} m"
            )
        if angle >= problem.orientation_tolerance:
            raise GoalRejected(
                f"path: at t = {time:g} s the nearest reachable orientation is"
                f" {np.rad2deg(angle):.4g} deg away, allowed"
                f" {np.rad2deg(problem.orientation_tolerance):g} deg,"
                f" {_turn_text(solver, configuration + still, target)}; with the orientation free"
                " nothing is asked of it"
            )
        configuration = configuration + still


def _turn_text(solver: StepSolver, configuration: Array, target: PathSample) -> str:
    """About which axis of the tool most of the turn is that is missing."""
    if target.quaternion is None:
        raise AssertionError("nothing is asked of the orientation")
    desired = quat_to_matrix(target.quaternion)
    missing = desired.T @ rotation_error(desired, tool_pose(solver.model, configuration)[1])
    return f"most of it about the tool's {'xyz'[int(np.argmax(np.abs(missing)))]} axis"


def _motion_text(target: PathSample) -> str:
    """How fast the tool moves and turns there."""
    words = []
    speed = float(np.linalg.norm(target.velocity))
    if speed > STILL:
        words.append(f"moves at {speed:.4g} m/s")
    if target.angular_velocity is not None:
        turning = float(np.linalg.norm(target.angular_velocity))
        if turning > STILL:
            words.append(f"turns at {np.rad2deg(turning):.4g} deg/s")
    return f"it {' and '.join(words) or 'rests'}"


def _gap_text(problem: StepProblem, distance: float, angle: float) -> str:
    if distance >= problem.position_tolerance:
        return f"{distance:.4g} m behind, allowed {problem.position_tolerance:g} m"
    allowed = np.rad2deg(problem.orientation_tolerance)
    return f"{np.rad2deg(angle):.4g} deg behind, allowed {allowed:g} deg"


def _angle_between(first: Array, second: Array) -> float:
    cosine = abs(float(np.dot(first, second)))
    scale = float(np.linalg.norm(first) * np.linalg.norm(second))
    return 2.0 * float(np.arccos(min(cosine / scale, 1.0)))


def _numbers(values: Array) -> str:
    return ", ".join(f"{value:.4f}" for value in values)
