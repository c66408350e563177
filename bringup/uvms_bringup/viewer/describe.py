"""What a picture shows, in numbers: small enough to be kept beside it and compared."""

from typing import Any

import numpy as np

from uvms_bringup.viewer.cameras import view_of
from uvms_bringup.viewer.elements import Node, Place, Places, is_shown, world_pose
from uvms_bringup.viewer.moment import Moment
from uvms_bringup.viewer.scene_model import SceneModel
from uvms_core.signals import Array

DEEPEST = 2
"""Parts of the name of a node that is described: what is deeper moves with it."""
PUSHES = "thrust_", "force_"


def describe(model: SceneModel, moment: Moment, preset: str) -> dict[str, Any]:
    """Camera and what is shown of a moment: by name the shape, its colour, and where it is.

    Places are in map_ned, in m to the millimetre; of a line both ends. Arrows of thrusts and forces
    are left out: while a vehicle holds still they are noise.
    """
    places = model.all_places(moment)
    view = view_of(preset, model, places)
    shown = {name: node for name, node in model.nodes.items() if _is_told(node, places)}
    return {
        "camera": [_rounded(view.position), _rounded(view.look_at)],
        "shown": {name: _told(node, places) for name, node in shown.items()},
    }


def _is_told(node: Node, places: Places) -> bool:
    parts = node.name.split("/")
    is_part = node.look is not None and len(parts) <= DEEPEST
    return is_part and not parts[-1].startswith(PUSHES) and is_shown(node.name, places)


def _told(node: Node, places: Places) -> list[Any]:
    assert node.look is not None  # what `_is_told` says
    place = places[node.name]
    centre, R = world_pose(node.name, places)
    return [node.look.kind, _hex(place, node), *map(_rounded, _marks(place, centre, R))]


def _marks(place: Place, centre: Array, R: Array) -> list[Array]:
    if place.points is None or not len(place.points):
        return [centre]
    return [centre + R @ place.points[0], centre + R @ place.points[-1]]


def _hex(place: Place, node: Node) -> str:
    assert node.look is not None
    return "#" + "".join(f"{round(255 * part):02x}" for part in place.colour or node.look.colour)


def _rounded(point: Array) -> list[float]:
    return [float(number) for number in np.round(point, 3)]
