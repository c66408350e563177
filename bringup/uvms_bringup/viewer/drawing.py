"""Draws a scene with viser, and sends what has changed."""

from collections.abc import Collection
from typing import Any

import numpy as np
import viser

from uvms_bringup.viewer.batches import batches
from uvms_bringup.viewer.elements import Colour, Look, Node, Place, Places
from uvms_bringup.viewer.meshes import unit_mesh
from uvms_core.signals import Array

NO_LINE = np.zeros((1, 2, 3))
SKY, DEEP = (255, 255, 255), (150, 165, 175)
"""Colours of the light from above and from below."""
UP = (0.0, 0.0, -1.0)
LINE_PX = 2.0
"""Width of a line on the screen, from wherever one looks: a line as thick as it is in the world
fades with distance, and takes a computer without a graphics card as long as the vehicle."""
BRIGHT = 1.6
"""Strength of it, beside viser's own lamp."""


def light(scene: viser.SceneApi) -> None:
    """Light a scene cheaply.

    Shadows and mirrored surroundings, viser's default, say nothing and are what costs a computer
    without a graphics card most.
    """
    scene.configure_default_lights(True, cast_shadow=False)
    scene.configure_environment_map(None)
    scene.add_light_hemisphere(
        "/light", sky_color=SKY, ground_color=DEEP, intensity=BRIGHT, position=UP
    )


class Drawing:
    """The nodes of a scene in a viser scene; the third axis of the world points down.

    Args:
        scene: to draw into.
        nodes: by name, parents before their children.
        still: those whose places never change; they are drawn together where they can be, and
            cannot be switched off one by one.
        line_m: width of a line that is drawn `LINE_PX` wide, m.
    """

    def __init__(
        self, scene: viser.SceneApi, nodes: dict[str, Node], still: Collection[str], line_m: float
    ) -> None:
        self._scene, self._line_m = scene, line_m
        scene.set_up_direction("-z")
        joined, gone = batches(nodes, nodes.keys() - still)
        self._handles = {name: self._add(nodes[name]) for name in nodes if name not in gone}
        for batch in joined:
            self._add_mesh(f"/{batch.name}", batch.look, batch.vertices, batch.faces)
        self._shown = {name: node.place for name, node in nodes.items()}
        self._switched_off: set[str] = set()

    def show(self, places: Places) -> None:
        """Put nodes where they are now."""
        for name, place in places.items():
            before = self._shown[name]
            if place is not before:
                self._move(name, before, place)
                self._shown[name] = place

    def switch(self, names: list[str], on: bool) -> None:
        """Show or hide nodes whatever their places say."""
        for name in names:
            (self._switched_off.discard if on else self._switched_off.add)(name)
            self._handles[name].visible = on and self._shown[name].visible

    def position_of(self, name: str) -> Array:
        """Where the page has a node, (3,) m in its parent."""
        return np.array(self._handles[name].position)

    def is_visible(self, name: str) -> bool:
        """Whether the page shows a node, if all that it moves with is shown."""
        return bool(self._handles[name].visible)

    def _add(self, node: Node) -> Any:
        name, place = f"/{node.name}", node.place
        common: dict[str, Any] = {
            "position": place.position,
            "wxyz": _wxyz(place),
            "visible": place.visible,
        }
        if node.look is None:
            return self._scene.add_frame(name, show_axes=False, **common)
        if node.look.kind == "line":
            return self._scene.add_line_segments(
                name, _segments(place), _rgb(node.look.colour), thickness=self._pixels(place),
                thickness_units="screen", **common,
            )  # fmt: skip
        shape = unit_mesh(node.look.kind)
        handle = self._add_mesh(name, node.look, *shape, scale=_scale(place), **common)
        if node.label:
            self._scene.add_label(f"{name}/label", node.label)
        return handle

    def _add_mesh(
        self, name: str, look: Look, vertices: Array, faces: np.ndarray, **more: Any
    ) -> viser.MeshHandle:
        opacity = None if look.opacity == 1.0 else look.opacity
        return self._scene.add_mesh_simple(
            name, vertices, faces, color=_rgb(look.colour), opacity=opacity,
            cast_shadow=False, receive_shadow=False, **more,
        )  # fmt: skip

    def _move(self, name: str, before: Place, now: Place) -> None:
        handle = self._handles[name]
        if now.visible != before.visible:
            handle.visible = now.visible and name not in self._switched_off
        if not now.visible:
            return
        if not np.array_equal(now.position, before.position):
            handle.position = now.position
        if not np.array_equal(now.quaternion, before.quaternion):
            handle.wxyz = _wxyz(now)
        if now.points is not None:
            if now.points is not before.points:
                handle.points = _segments(now).astype(np.float32)
            if now.size[0] != before.size[0]:
                handle.thickness = self._pixels(now)
        elif not np.array_equal(now.size, before.size):
            handle.scale = _scale(now)
        if now.colour is not None and now.colour != before.colour:
            handle.color = _rgb(now.colour)

    def _pixels(self, line: Place) -> float:
        return LINE_PX * float(line.size[0]) / self._line_m


def _wxyz(place: Place) -> Array:
    return np.roll(place.quaternion, 1)


def _rgb(colour: Colour) -> tuple[int, int, int]:
    red, green, blue = (round(255 * part) for part in colour)
    return red, green, blue


def _scale(place: Place) -> tuple[float, float, float]:
    x, y, z = place.size.tolist()
    return x, y, z


def _segments(place: Place) -> Array:
    """(k - 1, 2, 3) m."""
    points = place.points
    if points is None or len(points) < 2:
        return NO_LINE
    return np.stack([points[:-1], points[1:]], axis=1)
