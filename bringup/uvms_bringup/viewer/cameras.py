"""Where the camera stands: presets that follow the vehicle or the tool, or stay."""

from dataclasses import dataclass

import numpy as np

from uvms_bringup.viewer.elements import Places, world_pose
from uvms_bringup.viewer.scene_model import SceneModel
from uvms_core.signals import Array

CHASE, TOOL, TOP, WIDE, BOW, FREE = "chase", "tool", "top", "wide", "bow", "free"
PRESETS = (WIDE, BOW, CHASE, TOOL, TOP, FREE)
"""What the page offers; `free` stays where the mouse puts it."""
FOLLOWING = CHASE, TOOL
"""These go along with what they look at; the others stay."""
_BACK = {
    WIDE: (-0.9, 1.3, -0.8),
    BOW: (0.95, 1.12, -0.66),
    CHASE: (-1.6, 0.0, -0.6),
    TOOL: (0.35, 0.5, -0.25),
    TOP: (-0.001, 0.0, -2.2),
}
"""From what it looks at to the camera, in diagonals of the hull; chase in the vehicle's heading."""


@dataclass(frozen=True)
class View:
    """A camera's place and what it looks at, (3,) m each, map_ned."""

    position: Array
    look_at: Array


def view_of(preset: str, model: SceneModel, places: Places) -> View:
    """The camera of a preset at a moment whose places of all nodes are given."""
    position, R = world_pose(model.shown_root(places), places)
    middle = position + R @ model.estimated.size[0]
    tool = world_pose(f"{model.shown_root(places)}/tool", places)[0]
    look_at = {TOOL: tool, CHASE: middle}.get(preset, 0.5 * (middle + tool))
    back = np.array(_BACK[preset]) * model.diagonal
    if preset == CHASE:
        yaw = np.arctan2(R[1, 0], R[0, 0])
        c, s = np.cos(yaw), np.sin(yaw)
        back = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ back
    return View(look_at + back, look_at)
