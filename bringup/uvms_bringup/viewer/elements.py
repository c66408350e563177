"""What a scene consists of: named nodes with a shape, and where each is at a time.

Names are paths: `estimated/link_1/0` moves with `estimated/link_1` and that with `estimated`. The
world is map_ned; a node's place is given in its parent.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from uvms_core.rotations import quat_to_matrix
from uvms_core.signals import Array
from uvms_core.vehicle.frames import IDENTITY, Pose, compose

Colour = tuple[float, float, float]
"""Red, green and blue, 0 to 1."""
Kind = Literal["sphere", "cylinder", "cone", "box", "arrow", "line"]
"""Unit shapes, which a place stretches by its `size`: the ball of radius 1; the cylinder of radius
1, the cone with its tip at z = 1 and the cuboid, all from -1 to 1; the arrow of radius 1 from 0 to
1 along z; a line through the points that its place has, in m, `size` as thick."""


@dataclass(frozen=True)
class Look:
    """Shape and colour of a node."""

    kind: Kind
    colour: Colour
    opacity: float = 1.0


def _origin() -> Array:
    return np.zeros(3)


def _upright() -> Array:
    return np.array([0.0, 0.0, 0.0, 1.0])


def _unit() -> Array:
    return np.ones(3)


@dataclass(frozen=True)
class Place:
    """Where a node is in its parent, and how large."""

    position: Array = field(default_factory=_origin)  # (3,) m
    quaternion: Array = field(default_factory=_upright)  # (4,) x, y, z, w
    size: Array = field(default_factory=_unit)  # (3,) m, of the unit shape
    visible: bool = True
    colour: Colour | None = None  # instead of the look's
    points: Array | None = None  # (k, 3) m, of a line

    @property
    def pose(self) -> Pose:
        """Position and rotation matrix."""
        return self.position, quat_to_matrix(self.quaternion)


HIDDEN = Place(visible=False)


@dataclass(frozen=True)
class Node:
    """One thing of the scene; without a look it only carries others."""

    name: str
    look: Look | None = None
    place: Place = field(default_factory=Place)
    label: str = ""


Places = dict[str, Place]
"""By a node's name where it is now; nodes that are not in it stay where they were."""


def parent(name: str) -> str:
    """The node that a node moves with; "" is the world."""
    return name.rpartition("/")[0]


def world_pose(name: str, places: Mapping[str, Place]) -> Pose:
    """Pose of a node in map_ned."""
    if not name:
        return IDENTITY
    here = places[name].pose if name in places else IDENTITY
    return compose(world_pose(parent(name), places), here)


def is_shown(name: str, places: Mapping[str, Place]) -> bool:
    """Whether a node and all that it moves with are visible."""
    while name:
        if name in places and not places[name].visible:
            return False
        name = parent(name)
    return True
