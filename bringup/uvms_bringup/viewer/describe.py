"""What a picture shows, in numbers: small enough to be kept beside it and compared."""

from typing import Any

import numpy as np

from uvms_bringup.viewer.cameras import view_of
from uvms_bringup.viewer.elements import Node, Place, Places, is_shown, world_pose
from uvms_bringup.viewer.moment import Moment
from uvms_bringup.viewer.scene_model import SceneModel
from uvms_core.signals import Array

DEEPEST = 1
"""Slashes in the name of a node that is described: the parts of its parts move with it."""


def describe(model: SceneModel, moment: Moment, preset: str) -> dict[str, Any]:
    """Camera and what is shown of a moment: by name the shape, its colour, and where it is.

    Places are in map_ned, in m to the millimetre: of a line both ends, of an arrow where it begins.
    Thrusts and forces, which are noise while a vehicle holds still, are told by their number alone.
    """
    places = model.all_places(moment)
    view = view_of(preset, model, places)
    shown = {name: node for name, node in model.nodes.items() if _is_told(node, places)}
    arrows = [name for name in shown if "/thrust_" in name or "/force_" in name]
    return {
        "camera": [_rounded(view.position), _rounded(view.look_at)],
        "arrows": len([name for name in model.nodes if "/thrust_" in name or "/force_" in name]),
        "shown": {name: _told(node, places) for name, node in shown.items() if name not in arrows},
    }


def _is_told(node: Node, places: Places) -> bool:
    return node.look is not None and node.name.count("/") <= DEEPEST and is_shown(node.name, places)


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
