"""The problem of a whole path: the tool's motion, where the posture starts, and the limits."""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from scipy.spatial.transform import Rotation

from uvms_core.end_effector_path import PathSamples
from uvms_core.pointing import Directions
from uvms_core.signals import Array
from uvms_dynamics import Model
from uvms_planner.limits import MotionLimits
from uvms_planner.problem import VEHICLE
from uvms_planner.whole_path.manipulability import best_manipulability
from uvms_planner.whole_path.posture_range import typical_restoring
from uvms_planner.whole_path.sample import NO_SURROUNDINGS, Surroundings, Target

LEAST_TYPICAL = 40.0
"""N^2 m^2; of a lighter arm the coupling counts for more than its weight."""


class Path(Protocol):
    """What `EndEffectorPath` and `JoinedPath` have in common."""

    @property
    def duration(self) -> float:
        """Seconds from the first point to the last."""
        ...

    @property
    def oriented(self) -> bool:
        """Whether the path prescribes the orientation, too."""
        ...

    @property
    def tool_axis(self) -> Array | None:
        """(3,) unit vector in the tool's axes that is to point along `directions`; or None."""
        ...

    def directions(self, times: Array) -> Directions:
        """Where `tool_axis` is to point at `times` (k,) s."""
        ...

    def samples(self, times: Array) -> PathSamples:
        """Targets at `times` (k,) s."""
        ...


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
    turn: float = 2.5  # of 1 rad away from a prescribed orientation, times the tolerance in rad and
    # per typical disturbance squared: a plan gains about a twentieth of that by a rad, so that it
    # stays within a twentieth of the tolerance. More would make the Newton steps short for nothing
    singular: float = 1e-3  # of a singular posture, falling to zero where manipulability is enough
    manipulability: float = 0.15  # that is enough, as a share of the arm's best


@dataclass(frozen=True)
class PathProblem:
    """Everything that decides a plan; `tool` gives the path by `samples(times)`."""

    model: Model
    tool: "ToolPath"
    duration: float  # s
    start: Posture
    limits: MotionLimits
    weights: CostWeights = field(default_factory=CostWeights)
    around: Surroundings = NO_SURROUNDINGS
    end: Posture | None = None  # at which the plan ends; None: at rest, in any posture
    turn_tolerance: float = np.deg2rad(0.5)  # rad, from a prescribed orientation

    @property
    def size(self) -> int:
        """D = 1 + n, yaw and joints."""
        return len(self.start.value)

    @property
    def best_manipulability(self) -> float:
        """The greatest that the arm has within its limits, m^3."""
        return best_manipulability(self.model, *self._joint_bounds())

    @property
    def turn_weight(self) -> float:
        """Of one rad away from the prescribed orientation, squared; 0 where there is none."""
        if not self.tool.oriented:
            return 0.0
        typical = max(typical_restoring(self.model, *self._joint_bounds()), LEAST_TYPICAL)
        return self.weights.turn * typical / self.turn_tolerance

    def _joint_bounds(self) -> tuple[Array, Array]:
        return self.limits.lower[VEHICLE:], self.limits.upper[VEHICLE:]

    def target(self, times: Array) -> Target:
        """The tool's path at `times` (k,) s."""
        return self.tool.target(np.clip(times, 0.0, self.duration))


class ToolPath:
    """A path of the end effector from `begin` s on, possibly followed `factor` times slower.

    `path` is an EndEffectorPath or a JoinedPath.
    """

    def __init__(self, path: Path, factor: float = 1.0, begin: float = 0.0):
        self.path = path
        self.factor = factor
        self.begin = begin
        self.axis = np.zeros(3) if path.tool_axis is None else np.array(path.tool_axis)
        """(3,) of the tool, in its own axes, that is to point somewhere; zero: none."""
        self.oriented = bool(path.oriented) or path.tool_axis is not None
        """Whether the path prescribes the tool's orientation, or an axis of it."""

    @property
    def duration(self) -> float:
        """S, from `begin` to the last point."""
        return float(self.path.duration) * self.factor - self.begin

    def after(self, time: float) -> "ToolPath":
        """What is left of the path `time` s later; it rests where it has ended."""
        return ToolPath(self.path, self.factor, self.begin + time)

    def slower(self, factor: float) -> "ToolPath":
        """The same way in `factor` times the time."""
        return ToolPath(self.path, self.factor * factor, self.begin * factor)

    def target(self, times: Array) -> Target:
        """Position, velocity, acceleration and what is asked of the rotation at `times` (k,) s."""
        k = self.factor
        own = (np.asarray(times, dtype=float) + self.begin) / k
        s = self.path.samples(own)
        rotation, direction = np.zeros((0, 3, 3)), np.zeros((0, 3))
        if self.path.tool_axis is not None:
            direction = self.path.directions(own).direction
        if s.quaternion is not None:
            rotation = Rotation.from_quat(s.quaternion).as_matrix()
        return Target(
            np.ascontiguousarray(s.position),
            np.ascontiguousarray(s.velocity / k),
            np.ascontiguousarray(s.acceleration / k**2),
            np.ascontiguousarray(rotation),
            self.axis,
            np.ascontiguousarray(direction),
        )
