"""A path with less asked of the tool's orientation: one of its axes alone, or nothing."""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from uvms_core.end_effector_path import PathSamples
from uvms_core.errors import SignalError
from uvms_core.pointing import Directions
from uvms_core.signals import Array
from uvms_planner.whole_path.path_problem import Path, PathProblem, ToolPath


class RelaxedPath:
    """The positions of a path; where `axis` (3,) is given it points as the path's tool has it."""

    oriented = False

    def __init__(self, path: Path, axis: Array | None = None) -> None:
        self._path = path
        self.tool_axis = axis

    @property
    def duration(self) -> float:
        """Seconds from the first point to the last."""
        return self._path.duration

    def samples(self, times: Array) -> PathSamples:
        """As of the path, without orientations."""
        position, velocity, acceleration = self._path.samples(times)[:3]
        return PathSamples(position, velocity, acceleration, None, None, None)

    def directions(self, times: Array) -> Directions:
        """Where `tool_axis` is to point at `times` (k,) s: d = R a, d_dot = omega x d."""
        own = self._path.samples(times)
        turning, bending = own.angular_velocity, own.angular_acceleration
        if self.tool_axis is None or turning is None or bending is None:
            raise SignalError("the path has no tool_axis, and so no directions for it")
        direction = Rotation.from_quat(own.quaternion).apply(self.tool_axis)
        rate = np.cross(turning, direction)
        return Directions(direction, rate, np.cross(bending, direction) + np.cross(turning, rate))


def relaxed(problem: PathProblem, axis: Array | None = None) -> PathProblem:
    """The problem with the orientation free, but for an axis (3,) of the tool where it is given."""
    tool = problem.tool
    return replace(problem, tool=ToolPath(RelaxedPath(tool.path, axis), tool.factor, tool.begin))
