"""Whether a prescribed orientation can be had at all: the nearest posture, at any speed.

The vehicle goes wherever the tool's position wants it, so that yaw and joints are free to turn the
tool, within the joints' bounds, the depth and the free attitude. From many postures at many
instants of the path, the least angle is sought by damped Gauss-Newton steps, all at once.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvms_core.signals import Array
from uvms_planner.constraints import free_attitude
from uvms_planner.problem import VEHICLE
from uvms_planner.whole_path.path_problem import PathProblem
from uvms_planner.whole_path.plan import plan_values
from uvms_planner.whole_path.posture_range import spread_postures
from uvms_planner.whole_path.sample import (
    ATTITUDE,
    MANIPULABILITY,
    NO_SURROUNDINGS,
    POSITION,
    TURN,
    Target,
)
from uvms_planner.whole_path.sampled_bounds import tool_offset

INSTANTS = 41  # of a path that are looked at
STARTS_LOG2 = 4  # postures from which each is approached
STEPS = 40
RESIDUALS = 6  # turn, and what is beyond roll, pitch and depth
STRICT = 300.0  # weight of 1 rad or 1 m beyond another limit; that of 1 rad of turn is 1
DIFFERENCE = 1e-6  # rad
LEAST_DAMPING, FIRST_DAMPING, MOST_DAMPING = 1e-9, 1e-3, 1e6
NEGLIGIBLE = 3e-3  # rad or m beyond a limit


@dataclass(frozen=True)
class OrientationGap:
    """Where the prescribed orientation is farthest out of reach."""

    first: float  # s, when it first is out of reach
    time: float  # s, when it is farthest
    angle: float  # rad, to the nearest that can be reached then
    turn: Array  # (3,) rad, from the prescribed orientation to that; the tool's axes, of an axis
    # alone those of map_ned


def orientation_gap(problem: PathProblem) -> OrientationGap | None:
    """Where the orientation is out of reach at any speed; None where it is not.

    None as well where the positions alone are out of reach: then the orientation is not to blame.
    """
    times = np.linspace(0.0, problem.duration, INSTANTS)
    target = problem.target(times)
    beyond, turns = _nearest(problem, target)
    angles = np.linalg.norm(turns, axis=1)
    if beyond.max() > NEGLIGIBLE or angles.max() <= problem.turn_tolerance:
        return None
    worst = int(np.argmax(angles))
    first = int(np.argmax(angles > problem.turn_tolerance))
    turn = turns[worst]
    if len(target.rotation):
        turn = target.rotation[worst].T @ turn
    return OrientationGap(float(times[first]), float(times[worst]), float(angles[worst]), turn)


def hard_turn(problem: PathProblem, time: float, posture: Array) -> tuple[float, Array]:
    """How little the tool turns about the axis (3,) that is hardest to turn it about.

    In rad per rad of yaw and joints (d,) together, 0 in a singular posture. The axis is in the
    tool's own axes, those of map_ned where an axis alone is prescribed; of turns about that axis
    itself nothing is asked.
    """
    target, here = problem.target(np.array([time])), posture[None]
    jacobian = _jacobian(problem, target, here, _residual(problem, target, here))[0, :3]
    about, gains, _ = np.linalg.svd(jacobian)
    hardest = 1 if len(target.direction) else 2
    axis = about[:, hardest]
    return float(gains[hardest]), target.rotation[0].T @ axis if len(target.rotation) else axis


def _nearest(problem: PathProblem, target: Target) -> tuple[Array, Array]:
    """Of the nearest posture at each instant: what is beyond other limits (k,), and turn (k, 3)."""
    starts, count = _starts(problem), len(target.position)
    best = np.full((count, RESIDUALS), np.inf)
    postures, instant = np.tile(starts, (count, 1)), np.repeat(np.arange(count), len(starts))
    rest = _residual(problem, _rows(target, instant), postures)
    damping = np.full(len(postures), FIRST_DAMPING)
    for _ in range(STEPS):
        _keep_best(best, instant, rest)
        sought = (np.linalg.norm(best, axis=1) > problem.turn_tolerance / 2)[instant]
        if not sought.any():
            break
        postures, instant, rest = postures[sought], instant[sought], rest[sought]
        postures, rest, damping = _step(
            problem, _rows(target, instant), postures, rest, damping[sought]
        )
    _keep_best(best, instant, rest)
    return np.abs(best[:, 3:]).max(axis=1) / STRICT, best[:, :3]


def _keep_best(best: Array, instant: NDArray[np.int_], rest: Array) -> None:
    """Put into `best` (k, 6) the least of the residuals of each instant."""
    order = np.argsort(-np.sum(rest**2, axis=1), kind="stable")  # of equal indices the last counts
    least = best.copy()
    least[instant[order]] = rest[order]
    better = np.sum(least**2, axis=1) < np.sum(best**2, axis=1)
    best[better] = least[better]


def _step(
    problem: PathProblem, target: Target, postures: Array, rest: Array, damping: Array
) -> tuple[Array, Array, Array]:
    """Postures, residuals and dampings after a step, which is taken where it comes nearer."""
    jacobian = _jacobian(problem, target, postures, rest)
    trial = _moved(postures, rest, jacobian, damping, _bounds(problem))
    new = _residual(problem, target, trial)
    better = np.sum(new**2, axis=1) < np.sum(rest**2, axis=1)
    damping = np.clip(np.where(better, damping / 5, damping * 4), LEAST_DAMPING, MOST_DAMPING)
    taken = better[:, None]
    return np.where(taken, trial, postures), np.where(taken, new, rest), damping


def _bounds(problem: PathProblem) -> tuple[Array, Array]:
    """Of yaw, which has none, and the joints (d,); the start is within them."""
    limits, start = problem.limits, problem.start.value
    own = slice(VEHICLE - 1, None)
    return np.minimum(limits.lower[own], start), np.maximum(limits.upper[own], start)


def _starts(problem: PathProblem) -> Array:
    """That of the start and evenly spread postures (s, d); yaw all around."""
    lower, upper = (bound.copy() for bound in _bounds(problem))
    start = problem.start.value
    lower[0], upper[0] = start[0] - np.pi, start[0] + np.pi
    return np.vstack([start, spread_postures(lower, upper, STARTS_LOG2)])


def _rows(target: Target, index: NDArray[np.int_]) -> Target:
    """The target at the instants `index`, those that it has none of left out."""
    position, velocity, acceleration, rotation, axis, direction = target
    rotation = rotation[index] if len(rotation) else rotation
    direction = direction[index] if len(direction) else direction
    return Target(position[index], velocity[index], acceleration[index], rotation, axis, direction)


def _residual(problem: PathProblem, target: Target, postures: Array) -> Array:
    """Turn (k, 3) of the tool, and what is beyond roll, pitch and depth, (k, 6) in all."""
    motion = np.zeros((len(postures), 3, postures.shape[1]))
    motion[:, 0] = postures
    values = plan_values(problem.model, NO_SURROUNDINGS, motion, target)
    most, shallow, deep = _other_limits(problem)
    depth, attitude = values[:, POSITION + 2], np.abs(values[:, ATTITUDE : ATTITUDE + 2]) - most
    below = np.maximum(depth - deep, 0.0) + np.minimum(depth - shallow, 0.0)
    return np.hstack(
        [
            values[:, TURN:MANIPULABILITY],
            STRICT * np.maximum(attitude, 0.0),
            STRICT * below[:, None],
        ]
    )


def _other_limits(problem: PathProblem) -> tuple[Array, float, float]:
    """Roll and pitch (2,) at most, and least and greatest depth; the start is within all."""
    limits, start = problem.limits, problem.start.value
    depth = (problem.target(np.zeros(1)).position[0] - tool_offset(problem.model, start))[2]
    most = np.maximum(
        np.abs(free_attitude(problem.model, start[1:])), (limits.roll_max, limits.pitch_max)
    )
    return most, min(limits.lower[2], depth), max(limits.upper[2], depth)


def _jacobian(problem: PathProblem, target: Target, postures: Array, rest: Array) -> Array:
    """Derivatives (k, 6, d) by forward differences."""
    columns = []
    for k in range(postures.shape[1]):
        moved = postures.copy()
        moved[:, k] += DIFFERENCE
        columns.append((_residual(problem, target, moved) - rest) / DIFFERENCE)
    return np.stack(columns, axis=2)


def _moved(
    postures: Array, rest: Array, jacobian: Array, damping: Array, bounds: tuple[Array, Array]
) -> Array:
    """Postures after a damped step; what is at a bound and would be pushed beyond it stays."""
    lower, upper = bounds
    slope = np.einsum("kij,ki->kj", jacobian, rest)
    held = ((postures <= lower) & (slope > 0.0)) | ((postures >= upper) & (slope < 0.0))
    free = np.where(held, 0.0, 1.0)
    jacobian = jacobian * free[:, None, :]
    matrix = np.einsum("kia,kib->kab", jacobian, jacobian)
    matrix += (damping[:, None] + held)[:, :, None] * np.eye(postures.shape[1])
    step = np.linalg.solve(matrix, (slope * free)[:, :, None])[:, :, 0]
    return np.clip(postures - step, lower, upper)
