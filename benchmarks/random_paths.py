"""Random goals for the planner: seven kinds of paths, any size, from slow to too fast."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.rng import generator
from uvms_core.signals import Array, PathGoal
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.plausible.stability import postures
from uvms_core.vehicle.postures import posture_deg
from uvms_dynamics import build_model
from uvms_dynamics.geometry import OWN, build_geometry, clearances
from uvms_dynamics.kernels.rotations import matrix_to_quat
from uvms_planner import PathSpec, PlannerConfig
from uvms_planner.clearance import clearance_margins
from uvms_planner.constraints import free_attitude
from uvms_planner.limits import MotionLimits
from uvms_planner.problem import VEHICLE
from uvms_planner.projection import tool_pose

NOMINAL_S = 60.0
"""Duration of a path before its speed is drawn."""
SLOWEST, FASTEST = 10.0, 0.6
"""Duration over the least in which the vehicle alone could carry the tool along."""
SHORTEST_S, LONGEST_S = 6.0, 240.0
DEEP_M, SHALLOW_M = 10.0, (0.6, 1.5)
_DEEP = (0.0, 0.0, DEEP_M, 0.0)
"""A level vehicle at that depth."""
ROOM = 0.1  # of a joint's range on either side, for random starts
KINDS = ("line", "circle", "helix", "waypoints", "eight", "scan", "poke")


@dataclass(frozen=True)
class RandomGoal:
    """A goal with the configuration (m,) that it starts from."""

    kind: str
    number: int
    orientation: str
    start: Array
    goal: PathGoal
    haste: float  # duration over that of the vehicle alone

    def __str__(self) -> str:
        turn = "" if self.orientation == "free" else f", orientation {self.orientation}"
        return f"{self.number} {self.kind}{turn}, {self.goal.times[-1]:.1f} s"


def random_goals(vehicle: Vehicle, count: int, seed: int) -> list[RandomGoal]:
    """That many goals; each follows from `seed` and its number alone."""
    return [random_goal(vehicle, number, seed) for number in range(count)]


def random_goal(vehicle: Vehicle, number: int, seed: int) -> RandomGoal:
    """Goal `number` of a seed."""
    rng = generator(seed, f"goal {number}")
    kind = KINDS[number % len(KINDS)]
    orientation = "keep" if rng.uniform() < 0.3 else "free"
    size = float(np.exp(rng.uniform(np.log(0.05), np.log(2.0))))
    model = build_model(vehicle)
    while True:
        start = _start(vehicle, rng)
        position, rotation = tool_pose(model, start)
        goal = _SHAPES[kind](rng, size, position, matrix_to_quat(rotation), orientation)
        if goal.positions[:, 2].min() > 0.0:
            break
    haste = float(np.exp(rng.uniform(np.log(FASTEST), np.log(SLOWEST))))
    duration = float(np.clip(haste * _least_time(vehicle, goal), SHORTEST_S, LONGEST_S))
    return RandomGoal(kind, number, orientation, start, goal.slowed(duration / NOMINAL_S), haste)


def _start(vehicle: Vehicle, rng) -> Array:
    """At rest at 10 m, or near the surface; in `home`, a posture of the file, or a random one."""
    deep, which = rng.uniform() < 0.8, rng.uniform()
    depth = DEEP_M if deep else rng.uniform(*SHALLOW_M)
    place = np.array([0.0, 0.0, depth, rng.uniform(-np.pi, np.pi)])
    if which < 0.6:
        q = np.deg2rad(posture_deg(vehicle.arm, "home"))
    elif which < 0.75:
        known = [np.asarray(own) for _, own in postures(vehicle)]
        q = known[rng.integers(len(known))]
    else:
        q = _random_posture(vehicle, rng)
    limits = MotionLimits.of(vehicle, build_model(vehicle), PlannerConfig().limits)
    return np.concatenate([place, np.clip(q, limits.lower[VEHICLE:], limits.upper[VEHICLE:])])


def _random_posture(vehicle: Vehicle, rng) -> Array:
    """Joints (n,) off their stops, clear of the hull, with the free attitude within its limits.

    Clear is what keeps the planner's margins, or as far away as in `home`: of some arms a link is
    near the hull in every posture.
    """
    config, model, geometry = PlannerConfig(), build_model(vehicle), build_geometry(vehicle)
    limits = MotionLimits.of(vehicle, model, config.limits)
    own = np.array([pair.kind in OWN for pair in geometry.pairs])
    home = np.concatenate([_DEEP, np.deg2rad(posture_deg(vehicle.arm, "home"))])
    margins = np.minimum(
        clearance_margins(config.clearance, vehicle, geometry), clearances(geometry, home)
    )
    low, high = limits.lower[VEHICLE:], limits.upper[VEHICLE:]
    while True:
        q = low + rng.uniform(ROOM, 1 - ROOM, len(low)) * (high - low)
        roll, pitch = np.abs(free_attitude(model, q))
        apart = clearances(geometry, np.concatenate([_DEEP, q]))
        level = roll < limits.roll_max and pitch < limits.pitch_max
        if level and np.all(apart[own] >= margins[own]):
            return q


def _least_time(vehicle: Vehicle, goal: PathGoal) -> float:
    """Seconds in which the vehicle, its arm held still, could carry the tool along."""
    limits = MotionLimits.of(vehicle, build_model(vehicle), PlannerConfig().limits)
    along = EndEffectorPath(goal).samples(np.linspace(0.0, NOMINAL_S, 1201))
    speed = np.abs(along.velocity).max(axis=0) / limits.rate[:3]
    bend = np.abs(along.acceleration).max(axis=0) / limits.acceleration[:3]
    return NOMINAL_S * float(max(speed.max(), np.sqrt(bend.max())))


def _by_word(words: dict, position: Array, quaternion: Array, orientation: str) -> PathGoal:
    return PathSpec.model_validate({**words, "orientation": orientation}).goal(position, quaternion)


def _direction(rng) -> Array:
    vector = rng.standard_normal(3)
    return vector / np.linalg.norm(vector)


def _floats(values: Array) -> list:
    return np.asarray(values, dtype=float).tolist()


def _line(rng, size, *pose_and_word) -> PathGoal:
    line = {"to_m": _floats(2 * size * _direction(rng)), "duration_s": NOMINAL_S}
    return _by_word({"line": line}, *pose_and_word)


def _circle(rng, size, *pose_and_word, **more) -> PathGoal:
    turns = float(rng.choice([1.0, 2.0, 1.5, -1.0]))
    circle = {"radius_m": size / 2, "turns": turns, "duration_s": NOMINAL_S, **more}
    circle |= {"normal": _floats(_direction(rng)), "towards": _floats(_direction(rng))}
    return _by_word({"helix" if more else "circle": circle}, *pose_and_word)


def _helix(rng, size, *pose_and_word) -> PathGoal:
    advance = float(size * rng.uniform(-0.5, 0.5))
    return _circle(rng, size, *pose_and_word, advance_m=advance)


def _waypoints(rng, size, *pose_and_word) -> PathGoal:
    steps = rng.uniform(-size, size, (rng.integers(2, 7), 3))
    times = np.cumsum(rng.uniform(0.5, 1.5, len(steps)))
    points = {
        "points_m": _floats(np.cumsum(steps, axis=0)),
        "times_s": _floats(NOMINAL_S * times / times[-1]),
        "stop": bool(rng.uniform() < 0.3),
    }
    return _by_word({"waypoints": points}, *pose_and_word)


def _eight(rng, size, position, quaternion, orientation) -> PathGoal:
    """Gerono's lemniscate in a random plane, from rest to rest."""
    first, turn = _direction(rng), _direction(rng)
    second = np.cross(turn, first) / np.linalg.norm(np.cross(turn, first))
    u = np.linspace(0.0, 1.0, 241)
    angle = 2 * np.pi * rng.integers(1, 3) * u**3 * (10 - 15 * u + 6 * u**2)
    plane = np.stack([np.sin(angle), np.sin(angle) * np.cos(angle)], axis=1)
    turned = np.tile(quaternion, (len(u), 1)) if orientation == "keep" else np.zeros((0, 4))
    points = position + size * plane @ np.stack([first, second])
    return PathGoal(times=NOMINAL_S * u, positions=points, orientations=turned)


def _scan(rng, size, *pose_and_word) -> PathGoal:
    """Lanes to and fro in a random plane, with stops or round the corners."""
    lanes, width = int(rng.integers(2, 5)), size / 4
    first, turn = _direction(rng), _direction(rng)
    second = np.cross(turn, first) / np.linalg.norm(np.cross(turn, first))
    corners = [
        (x, k * width) for k in range(lanes) for x in ((0, size) if k % 2 == 0 else (size, 0))
    ]
    points = np.array(corners[1:]) @ np.stack([first, second])
    ways = np.linalg.norm(np.diff(np.vstack([np.zeros(3), points]), axis=0), axis=1)
    times = np.cumsum(np.sqrt(ways))
    scan = {"points_m": _floats(points), "times_s": _floats(NOMINAL_S * times / times[-1])}
    return _by_word({"waypoints": {**scan, "stop": bool(rng.uniform() < 0.5)}}, *pose_and_word)


def _poke(rng, size, *pose_and_word) -> PathGoal:
    """There, a pause, and back."""
    there = _floats(size / 2 * _direction(rng))
    phases = [
        {"duration_s": 0.4 * NOMINAL_S, "to_m": there},
        {"duration_s": 0.2 * NOMINAL_S, "to_m": there},
        {"duration_s": 0.4 * NOMINAL_S, "to_m": [0.0, 0.0, 0.0]},
    ]
    return _by_word({"phases": phases}, *pose_and_word)


_SHAPES: dict[str, Callable[..., PathGoal]] = {
    "line": _line,
    "circle": _circle,
    "helix": _helix,
    "waypoints": _waypoints,
    "eight": _eight,
    "scan": _scan,
    "poke": _poke,
}
