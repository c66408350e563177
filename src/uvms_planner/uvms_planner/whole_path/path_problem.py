"""The problem of a whole path: the tool's motion, where the posture starts, and the limits."""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from uvms_core.signals import Array
from uvms_dynamics import Model
from uvms_planner.whole_path.sample import Target, Water

OVERLAP_S = 0.25  # between instants at which a path that is not C2 is read


class Limits(Protocol):
    """Limits of c = (x, y, z, psi, q) as `MotionLimits` has them, (m,) each, SI and rad."""

    lower: Array
    upper: Array
    rate: Array
    acceleration: Array
    roll_max: float
    pitch_max: float


@dataclass(frozen=True)
class Posture:
    """Yaw and joints (d,) with their rates and accelerations."""

    value: Array
    rate: Array
    acceleration: Array

    @staticmethod
    def at_rest(value: Array) -> "Posture":
        """A posture that does not move."""
        value = np.array(value, dtype=float)
        return Posture(value, np.zeros_like(value), np.zeros_like(value))


@dataclass(frozen=True)
class CostWeights:
    """What costs a little beside the self-disturbance, in N^2 (and N^2 m^2)."""

    rate: float = 1e-5  # of a posture variable at its full rate
    acceleration: float = 1e-5  # at its full acceleration
    stop: float = 1e-3  # of a joint at its stop, falling to zero at the margin
    stop_margin: float = np.deg2rad(8.0)  # rad
    turn: float = 1e6  # of one rad away from a prescribed orientation


@dataclass(frozen=True)
class PathProblem:
    """Everything that decides a plan; `tool` gives the path by `samples(times)`."""

    model: Model
    tool: "ToolPath"
    duration: float  # s
    start: Posture
    limits: Limits
    weights: CostWeights = field(default_factory=CostWeights)
    water: Water | None = None
    turn_tolerance: float = np.deg2rad(0.5)  # rad, from a prescribed orientation

    @property
    def size(self) -> int:
        """D = 1 + n, yaw and joints."""
        return len(self.start.value)

    def target(self, times: Array) -> Target:
        """The tool's path at `times` (k,) s."""
        return self.tool.target(np.clip(times, 0.0, self.duration))


class ToolPath:
    """A path of the end effector, C2 in time, possibly followed `factor` times slower."""

    def __init__(self, path, factor: float = 1.0):
        self.path = path
        self.factor = factor
        self.oriented = bool(path.oriented)
        self._smooth = None if hasattr(path, "samples") else _Smoothed(path)

    @property
    def duration(self) -> float:
        """S, from the first point to the last."""
        return float(self.path.duration) * self.factor

    def slower(self, factor: float) -> "ToolPath":
        """The same way in `factor` times the time."""
        return ToolPath(self.path, self.factor * factor)

    def target(self, times: Array) -> Target:
        """Position, velocity, acceleration and rotation at `times` (k,) s."""
        k = self.factor
        source = self._smooth or self.path
        s = source.samples(np.asarray(times, dtype=float) / k)
        rotation = np.zeros((0, 3, 3))
        if s.quaternion is not None:
            rotation = Rotation.from_quat(s.quaternion).as_matrix()
        return Target(
            np.ascontiguousarray(s.position),
            np.ascontiguousarray(s.velocity / k),
            np.ascontiguousarray(s.acceleration / k**2),
            np.ascontiguousarray(rotation),
        )


@dataclass(frozen=True)
class _Read:
    position: Array
    velocity: Array
    acceleration: Array
    quaternion: Array | None


class _Smoothed:
    """A cubic spline through instants of a path that gives only positions and velocities."""

    def __init__(self, path):
        count = max(4, round(path.duration / OVERLAP_S))
        times = np.linspace(0.0, path.duration, count + 1)
        rest = (1, np.zeros(3))
        points = np.array([path.sample(t).position for t in times])
        self._path, self._oriented = path, bool(path.oriented)
        self._spline = CubicSpline(times, points, bc_type=(rest, rest))

    def samples(self, times: Array) -> _Read:
        turns = None
        if self._oriented:
            turns = np.array([self._path.sample(t).quaternion for t in times])
        return _Read(self._spline(times), self._spline(times, 1), self._spline(times, 2), turns)
