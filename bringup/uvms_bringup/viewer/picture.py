"""Pictures of a scene without browser, window or graphics card, by the ray caster of the report."""

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from uvms_analysis.report.posture import arrow, ball, rod
from uvms_analysis.report.raycast import Camera, Shape, blend, render, shrink
from uvms_bringup.errors import ViewError
from uvms_bringup.viewer.cameras import View, view_of
from uvms_bringup.viewer.elements import Colour, Node, Place, Places, is_shown, world_pose
from uvms_bringup.viewer.moment import Moment
from uvms_bringup.viewer.scene_model import SceneModel
from uvms_core.signals import Array

SIZE = (1280, 720)
FINER = 2
"""Pixels are computed so many times finer along each side, for smooth edges."""
VIEW_DEG = 40.0
"""Height of what the camera sees."""
LIGHT = np.array([0.35, 0.6, -1.0])
"""Direction to the lamp, north-east-down."""
SKY, DEEP = np.array([0.90, 0.96, 0.99]), np.array([0.62, 0.78, 0.86])
"""Of the background, above and below."""
ROD = 6.0
"""Length of the rods that a line is made of, in radii."""
INK = (25, 40, 55)
LEFT_OUT = "seabed"
"""A plane that a ray caster of quadrics draws as a box over everything."""


def write_picture(
    model: SceneModel, moment: Moment, file: str | Path, preset: str, title: str
) -> Path:
    """Draw a moment into a file; its suffix is the format.

    Raises:
        ViewError: the file cannot be written, or its format is not known.
    """
    path = Path(file)
    try:
        picture(model, moment, preset, title, SIZE).save(path)
    except (OSError, ValueError) as fault:
        raise ViewError(f"{path}: cannot be written: {fault}") from fault
    return path


def picture(
    model: SceneModel, moment: Moment, preset: str | View, title: str, size: tuple[int, int],
    deep: Array = DEEP,
) -> Image.Image:  # fmt: skip
    """A moment from a preset of the camera or a view, with title and time.

    The background goes from `SKY` above to the colour `deep` (3,) below.
    """
    places = model.all_places(moment)
    fine = (size[0] * FINER, size[1] * FINER)
    view = view_of(preset, model, places) if isinstance(preset, str) else preset
    camera = camera_of(view, fine)
    pixels = shrink(_image(model.nodes, places, camera, deep), FINER)
    image = Image.fromarray(np.rint(255.0 * pixels).astype(np.uint8))
    font = ImageFont.load_default(size[1] / 32)
    text = f"{title}   {moment.time:.1f} s"
    ImageDraw.Draw(image).text((size[0] / 60, size[1] / 40), text, INK, font)
    return image


def camera_of(view: View, size: tuple[int, int]) -> Camera:
    """A camera of the ray caster whose picture has up (against z of map_ned) upward."""
    back = view.position - view.look_at
    back = back / np.linalg.norm(back)
    right = np.cross(back, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    R = np.stack([right, np.cross(back, right), back], axis=1)
    focal = 0.5 * size[1] / np.tan(0.5 * np.radians(VIEW_DEG))
    return Camera(view.position, R, float(focal), size)


def _image(nodes: dict[str, Node], places: Places, camera: Camera, deep: Array) -> np.ndarray:
    """(h, w, 3), 0 to 1: what is opaque, and before it what is not."""
    by_opacity: dict[float, list[Shape]] = {1.0: []}
    for name, node in nodes.items():
        if node.look is not None and name != LEFT_OUT and is_shown(name, places):
            shapes = by_opacity.setdefault(node.look.opacity, [])
            shapes += [s for s in _shapes(node, places) if _is_before(s, camera)]
    solid = render(by_opacity.pop(1.0), camera, LIGHT)
    layers = [solid]
    for opacity, shapes in sorted(by_opacity.items(), reverse=True):
        layer = render(shapes, camera, LIGHT, opacity)
        layer.depth[layer.depth > solid.depth] = np.inf
        layers.append(layer)
    return blend(layers, _background(camera.size, deep))


def _background(size: tuple[int, int], deep: Array) -> np.ndarray:
    down = np.linspace(0.0, 1.0, size[1])[:, None, None]
    return np.broadcast_to(SKY + down * (deep - SKY), (size[1], size[0], 3))


def _is_before(shape: Shape, camera: Camera) -> bool:
    """Whether all of a shape is in front of the camera."""
    reach = float(np.linalg.norm(shape.axes))
    return bool((camera.position - shape.centre) @ camera.R[:, 2] > reach)


def _shapes(node: Node, places: Places) -> Iterator[Shape]:
    """A node for the ray caster."""
    place = places[node.name]
    centre, R = world_pose(node.name, places)
    assert node.look is not None  # of what is drawn
    colour = place.colour or node.look.colour
    if node.look.kind == "arrow":
        yield from arrow(centre, R[:, 2] * place.size[2], 0.4 * float(place.size[0]), colour)
    elif node.look.kind == "line":
        yield from _rods(place, centre, R, colour)
    elif place.size.min() > 0.0:
        yield Shape(node.look.kind, centre, R * place.size, colour)


def _spaced(points: Array, step: float) -> list[Array]:
    """Points no closer than a step to one another, and the last."""
    kept = list(points[:1])
    for point in points[1:]:
        if np.linalg.norm(point - kept[-1]) >= step:
            kept.append(point)
    if len(points) and np.linalg.norm(points[-1] - kept[-1]) > 1e-3 * step:
        kept.append(points[-1])
    return kept


def _rods(place: Place, centre: Array, R: Array, colour: Colour) -> Iterator[Shape]:
    points: Array = np.empty((0, 3)) if place.points is None else centre + place.points @ R.T
    radius = 0.5 * float(place.size[0])
    for first, last in pairwise(_spaced(points, ROD * radius)):
        yield rod(first, last, radius, colour)
    if len(points):
        yield ball(points[-1], radius, colour)
