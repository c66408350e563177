"""The frames in which a path may be given, and the way from them to map_ned."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.spatial.transform import Rotation

from uvms_core.signals import Array
from uvms_core.world_frames import R_MAP_MAP_NED
from uvms_planner.paths.shape import AT_ORIGIN, Begin

PathFrame = Literal["start", "map_ned", "map"]


@dataclass(frozen=True)
class Placement:
    """Where a path's frame is. Positions and orientations may have different axes: in the frame
    `start` positions are along map_ned, and orientations from the tool's own.
    """

    begin: Begin  # the tool's pose at the start, in the frame
    origin: Array  # (3,) m, of the frame in map_ned
    axes: Rotation  # of positions and directions, to map_ned
    attitude: Rotation  # of orientations, to map_ned

    def positions(self, values: Array) -> Array:
        """Positions (k, 3) of the frame in map_ned."""
        return self.origin + self.axes.apply(values)

    def directions(self, values: Array) -> Array:
        """Directions (k, 3) of the frame in map_ned."""
        return self.axes.apply(values)

    def orientations(self, turns: Array) -> Array:
        """Quaternions (k, 4), tool to frame, as tool to map_ned."""
        return (self.attitude * Rotation.from_quat(turns)).as_quat()


def frame_of(name: PathFrame, position: Array, quaternion: Array) -> Placement:
    """The frame `name` of a path that begins with the tool at this pose (3,), (4,) in map_ned."""
    place, turned = np.asarray(position, dtype=float), Rotation.from_quat(quaternion)
    if name == "start":
        return Placement(AT_ORIGIN, place, Rotation.identity(), turned)
    axes = Rotation.identity() if name == "map_ned" else Rotation.from_matrix(R_MAP_MAP_NED.T)
    begin = Begin(axes.inv().apply(place), axes.inv() * turned)
    return Placement(begin, np.zeros(3), axes, axes)
