"""What the tool's orientation along a path is to be: free, kept, one axis of it, or all."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.spatial.transform import Rotation

from uvms_core.signals import Array
from uvms_planner.path_frame import Placement
from uvms_planner.paths.shape import PathPoints

OrientationWord = Literal["free", "keep", "axis", "full"]
Direction = tuple[float, float, float]


@dataclass(frozen=True)
class Orientation:
    """What is asked of the orientation; make it with `of`."""

    word: OrientationWord
    tool_axis: Direction | None = None
    along: Direction | None = None

    @staticmethod
    def of(
        word: OrientationWord | None,
        tool_axis: Direction | None,
        along: Direction | None,
        oriented: bool,
    ) -> "Orientation":
        """What the fields ask for; `oriented`: the path has orientations of its own.

        Raises:
            ValueError: they do not fit together; names the field.
        """
        word = word or ("full" if oriented else "free")
        if word == "full" and not oriented:
            raise ValueError(
                "orientation: full needs rpy_deg of waypoints, or the columns qx, qy, qz, qw"
            )
        if (word == "axis") != (tool_axis is not None):
            raise ValueError("tool_axis: needed with orientation axis, and only there")
        if along is not None and word != "axis":
            raise ValueError("axis_along: only with orientation axis")
        for name, direction in (("tool_axis", tool_axis), ("axis_along", along)):
            if direction is not None and not any(direction):
                raise ValueError(f"{name}: must not be zero")
        return Orientation(word, tool_axis, along)

    def along_path(
        self, frame: Placement, points: PathPoints, quaternion: Array
    ) -> tuple[Array, Array, Array]:
        """Orientations (k, 4), axis of the tool (3,) and its directions (k, 3) in map_ned.

        Empty, (0, 4), (0,) and (0, 3), where they are free. `quaternion` (4,): tool to map_ned at
        the start.
        """
        count, start = len(points.times), np.asarray(quaternion, dtype=float)
        orientations, axis, directions = np.zeros((0, 4)), np.zeros(0), np.zeros((0, 3))
        if self.word == "keep":
            orientations = np.tile(start, (count, 1))
        elif self.word == "full" and points.turns is not None:
            orientations = frame.orientations(points.turns)
        elif self.word == "axis" and self.tool_axis is not None:
            axis = _unit(self.tool_axis)
            direction = Rotation.from_quat(start).apply(axis)
            if self.along is not None:
                direction = frame.directions(_unit(self.along))
            directions = np.tile(direction, (count, 1))
        return orientations, axis, directions


def _unit(direction: Direction) -> Array:
    vector = np.array(direction, dtype=float)
    return vector / np.linalg.norm(vector)
