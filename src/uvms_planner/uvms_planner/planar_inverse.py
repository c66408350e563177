"""Inverse kinematics of two joints in the plane that they share, in closed form.

The paper obtains theta_2 and theta_3 "directly through inverse kinematics", sec. 5.1: shoulder and
elbow turn about parallel axes, so that between them they place the tool anywhere in the plane
across those axes that two links can reach (Craig, Introduction to Robotics, 3rd ed., sec. 4.4).
Here the two are found in any arm that has such joints.
"""

from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics import Model
from uvms_dynamics.kernels.jit import kernel
from uvms_planner.errors import PlannerError
from uvms_planner.limits import JointLimits
from uvms_planner.problem import VEHICLE
from uvms_planner.projection import configuration_jacobian, tool_pose

PARALLEL_RAD = 1e-3  # measured vehicle files give a right angle or a half turn in four digits
LEVER_M = 1e-3  # the shortest link that counts as one
POSTURES = 32  # in which the structure of the arm is looked at
PASSES = 3  # the second and third take away what axes that are parallel within PARALLEL_RAD leave


@dataclass(frozen=True)
class PlanarPair:
    """Two neighbouring joints with parallel axes: their numbers in the arm, from 0."""

    first: int
    second: int


def planar_pair(model: Model, joints: JointLimits) -> PlanarPair:
    """The two neighbouring joints whose common plane is the largest for the tool.

    Raises:
        PlannerError: no two neighbouring joints turn about parallel axes with a link between
            them and one behind them; the message says what each two of them lack.
    """
    found = [_examined(model, joints, i) for i in range(len(joints.names) - 1)]
    usable = [i for i, (lack, _) in enumerate(found) if not lack]
    if not usable:
        raise PlannerError(
            "method paper solves two joints in the plane that they share, which takes two"
            " neighbouring joints with parallel axes, a link between them and one behind them;"
            f" this arm has none: {_lacks(joints.names, found)}. Choose another planner.method"
        )
    best = max(usable, key=lambda i: found[i][1])
    return PlanarPair(best, best + 1)


def _lacks(names: tuple[str, ...], found: list[tuple[str, float]]) -> str:
    if not found:
        return f"its only joint is {', '.join(names)}"
    return "; ".join(f"{names[i]}, {names[i + 1]}: {lack}" for i, (lack, _) in enumerate(found))


def _examined(model: Model, joints: JointLimits, first: int) -> tuple[str, float]:
    """What the joints `first` and the next lack ("" for nothing), and the product of their links.

    Looked at in postures that fill the joints' range evenly (a Kronecker sequence of square roots
    of primes: Niederreiter 1992, sec. 3.1).
    """
    tilts, between, behind = np.zeros(POSTURES), np.zeros(POSTURES), np.zeros(POSTURES)
    slopes = np.sqrt(_primes(len(joints.names)))
    for k in range(POSTURES):
        share = np.modf((k + 1) * slopes)[0]
        q = joints.lower + share * (joints.upper - joints.lower)
        jacobian = configuration_jacobian(model, np.concatenate([np.zeros(VEHICLE), q]))
        columns = jacobian[:, VEHICLE + first], jacobian[:, VEHICLE + first + 1]
        levers = [np.cross(column[:3], column[3:]) for column in columns]
        tilts[k] = np.linalg.norm(np.cross(columns[0][3:], columns[1][3:]))
        between[k] = np.linalg.norm(levers[0] - levers[1])
        behind[k] = np.linalg.norm(levers[1])
    tilt, links = float(np.max(tilts)), (float(np.mean(between)), float(np.mean(behind)))
    if tilt > PARALLEL_RAD:
        degrees = np.rad2deg(np.arcsin(min(tilt, 1.0)))
        return f"axes {degrees:.3g} deg from parallel", 0.0
    if min(links) < LEVER_M:
        place = "between" if links[0] < LEVER_M else "behind"
        return f"parallel, but the link {place} them is {1e3 * min(links):.2g} mm", 0.0
    return "", links[0] * links[1]


def _primes(count: int) -> Array:
    found: list[int] = []
    number = 2
    while len(found) < count:
        if all(number % prime for prime in found):
            found.append(number)
        number += 1
    return np.array(found, dtype=float)


@kernel
def solve_planar(model, configuration, first, second, desired, branch):
    """Turn two joints so that the tool is at `desired` (3,) in their plane; (found, turns (2,)).

    `configuration` (m,) is changed to the solution; across the plane the tool stays where it is.
    `branch` (1 or -1) says to which side of the first link the second one leans, seen along the
    first axis. With the first link d, the second rho and the target r in the plane's coordinates,
        cos(gamma) = (r^2 - d^2 - rho^2) / (2 d rho)
    is the angle between the links. Not found where the target is farther than both links reach,
    or nearer than they fold.
    """
    turns = np.zeros(2)
    for _ in range(PASSES):
        found, about_first, about_second = _turns(
            model, configuration, first, second, desired, branch
        )
        if not found:
            return False, turns
        turns[0] += about_first
        turns[1] += about_second
        configuration[VEHICLE + first] += about_first
        configuration[VEHICLE + second] += about_second
        if abs(about_first) + abs(about_second) < 1e-9:
            break
    return True, turns


@kernel
def _turns(model, configuration, first, second, desired, branch):
    """(found, turn of the first, turn of the second joint) in rad for axes that are parallel."""
    jacobian = configuration_jacobian(model, configuration)
    position, _ = tool_pose(model, configuration)
    axis, other = np.empty(3), np.empty(3)
    near, far, link, target = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for i in range(3):
        axis[i] = jacobian[3 + i, VEHICLE + first]
        other[i] = jacobian[3 + i, VEHICLE + second]
    # (z x v) x z: what of the lever v lies in the plane
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        a, b = VEHICLE + first, VEHICLE + second
        near[i] = jacobian[j, a] * axis[k] - jacobian[k, a] * axis[j]
        far[i] = jacobian[j, b] * other[k] - jacobian[k, b] * other[j]
    along = 0.0
    for i in range(3):
        along += axis[i] * (desired[i] - position[i])
    length = 0.0
    for i in range(3):
        link[i] = near[i] - far[i]
        length += link[i] ** 2
        target[i] = near[i] + desired[i] - position[i] - along * axis[i]
    length = np.sqrt(length)
    if length == 0.0:
        return False, 0.0, 0.0
    tx, ty, fx, fy, sense = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        across = (axis[j] * link[k] - axis[k] * link[j]) / length
        tx += target[i] * link[i] / length
        ty += target[i] * across
        fx += far[i] * link[i] / length
        fy += far[i] * across
        sense += axis[i] * other[i]
    reach = np.hypot(fx, fy)
    if reach == 0.0:
        return False, 0.0, 0.0
    cosine = (tx**2 + ty**2 - length**2 - reach**2) / (2.0 * length * reach)
    if not abs(cosine) <= 1.0:
        return False, 0.0, 0.0
    sine = branch * np.sqrt((1.0 - cosine) * (1.0 + cosine))
    about_second = np.arctan2(sine, cosine) - np.arctan2(fy, fx)
    about_first = np.arctan2(ty, tx) - np.arctan2(reach * sine, length + reach * cosine)
    return True, _wrapped(about_first), np.sign(sense) * _wrapped(about_second)


@kernel
def _wrapped(angle):
    """The same angle within -pi and pi."""
    return angle - 2.0 * np.pi * np.round(angle / (2.0 * np.pi))
