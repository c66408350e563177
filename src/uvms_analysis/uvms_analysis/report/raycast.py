"""A small ray caster: shaded quadrics with exact outlines, from numpy alone.

matplotlib's 3-D axes sort whole patches by depth and shade them flat, so that an arm in front of a
hull comes out wrong. Here every pixel has its own ray, met with the sphere x^2 + y^2 + z^2 = 1, the
box |x|, |y|, |z| <= 1, the cylinder x^2 + y^2 = 1 or the cone x^2 + y^2 = (1 - z)^2 / 4, the latter
two for |z| <= 1, in the shape's own coordinates. An affine map makes spheroids, links and arrows of
them.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array

AMBIENT, DIFFUSE, FILL, GLOSS = 0.52, 0.48, 0.12, 0.25
"""Shares of the light: from everywhere, from the lamp, from the far side, mirrored."""
SHININESS = 40.0
DISTANCE = 4.0
"""Of the camera, in diagonals of what it shows: farther is flatter."""
_TINY = 1e-12
_BOX = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1]), dtype=float).reshape(3, -1).T
_TURN = np.linspace(0.0, np.pi, 13)
_BALL = np.array(
    [
        (np.sin(a) * np.cos(2 * b), np.sin(a) * np.sin(2 * b), np.cos(a))
        for a in _TURN
        for b in _TURN
    ]
)
"""Points on a box and a ball around the unit shapes."""


@dataclass(frozen=True)
class Shape:
    """A unit sphere, cylinder, cone or box, mapped by x = centre + axes @ x_unit."""

    kind: str  # sphere, cylinder, cone or box
    centre: Array  # (3,) m
    axes: Array  # (3, 3) columns are the images of the unit axes, m
    colour: tuple[float, float, float]


@dataclass(frozen=True)
class Camera:
    """A pinhole camera; x of `R` points right, y up, z towards the viewer."""

    position: Array  # (3,) m
    R: Array  # (3, 3) camera axes as columns
    focal: float  # pixels
    size: tuple[int, int]  # width, height, pixels
    shift: tuple[float, float] = (0.0, 0.0)  # of the image's centre, pixels
    height_m: float = 1.0  # that the image covers at the distance of what it shows

    def project(self, points: Array) -> Array:
        """Pixel coordinates (k, 2), x right and y down, of points (k, 3)."""
        x, y, z = ((points - self.position) @ self.R).T
        u = self.size[0] / 2 + self.shift[0] - self.focal * x / z
        return np.stack([u, self.size[1] / 2 + self.shift[1] + self.focal * y / z], axis=1)

    def rays(self, columns: np.ndarray, rows: np.ndarray) -> Array:
        """Directions (k, 3), one unit deep, through pixels."""
        x = (columns + 0.5 - self.size[0] / 2 - self.shift[0]) / self.focal
        y = -(rows + 0.5 - self.size[1] / 2 - self.shift[1]) / self.focal
        return np.stack([x, y, np.full(x.shape, -1.0)], axis=-1) @ self.R.T


@dataclass
class Layer:
    """An image with depth: `colour` (h, w, 3), `depth` (h, w), infinite where nothing is."""

    colour: np.ndarray
    depth: np.ndarray
    opacity: float = 1.0


def frame(
    shapes: Sequence[Shape],
    view_deg: tuple[float, float],
    size: tuple[int, int],
    margin: float = 0.05,
) -> Camera:
    """A camera under these angles (azimuth, elevation) that has all shapes just in view."""
    corners = np.concatenate([_corners(s, _BALL if s.kind == "sphere" else _BOX) for s in shapes])
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle, distance = (low + high) / 2, DISTANCE * float(np.linalg.norm(high - low))
    R = camera_axes(*view_deg)
    position = middle + distance * R[:, 2]
    pixels = Camera(position, R, 1.0, size).project(corners) - np.array(size) / 2
    room = (1.0 - 2.0 * margin) * np.array(size)
    focal = float(np.min(room / np.ptp(pixels, axis=0)))
    across, down = -focal * (pixels.max(axis=0) + pixels.min(axis=0)) / 2
    return Camera(position, R, focal, size, (across, down), distance * size[1] / focal)


def camera_axes(azimuth_deg: float, elevation_deg: float) -> Array:
    """Axes (3, 3) of a camera on this side of what it looks at, with down (z) pointing down."""
    azimuth, elevation = np.radians([azimuth_deg, elevation_deg])
    flat = np.cos(elevation)
    back = np.array([flat * np.cos(azimuth), flat * np.sin(azimuth), -np.sin(elevation)])
    right = np.cross(back, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(back, right), back], axis=1)


def _corners(shape: Shape, unit: Array) -> Array:
    """Points (k, 3) of the unit shape where they lie in the world."""
    return np.asarray(shape.centre + unit @ shape.axes.T)


def render(shapes: Sequence[Shape], camera: Camera, light: Array, opacity: float = 1.0) -> Layer:
    """One layer of shapes; `light` (3,) is the direction to the lamp."""
    width, height = camera.size
    layer = Layer(
        np.zeros((height, width, 3), dtype=np.float32),
        np.full((height, width), np.inf, dtype=np.float32),
        opacity,
    )
    for shape in shapes:
        _draw(layer, shape, camera, light / np.linalg.norm(light))
    return layer


def blend(layers: Sequence[Layer], background: np.ndarray) -> np.ndarray:
    """The layers over the background (h, w, 3), one after the other, the last on top."""
    image = background.astype(np.float32)
    for layer in layers:
        here = np.isfinite(layer.depth)
        image[here] += layer.opacity * (layer.colour[here] - image[here])
    return np.clip(image, 0.0, 1.0)


def shrink(image: np.ndarray, factor: int) -> np.ndarray:
    """Mean of factor x factor pixels: smooth edges."""
    height, width, channels = image.shape
    parts = image.reshape(height // factor, factor, width // factor, factor, channels)
    return np.asarray(parts.mean(axis=(1, 3)))


def _draw(layer: Layer, shape: Shape, camera: Camera, light: Array) -> None:
    """Put a shape where it is nearer than what the layer has."""
    rows, columns = _window(shape, camera)
    if rows.stop <= rows.start or columns.stop <= columns.start:
        return
    grid = np.mgrid[rows, columns].reshape(2, -1)
    rays = camera.rays(grid[1], grid[0])
    inverse = np.linalg.inv(shape.axes)
    distance, normal = _MEET[shape.kind](
        inverse @ (camera.position - shape.centre), rays @ inverse.T
    )
    near = layer.depth[rows, columns].reshape(-1)
    seen = np.flatnonzero(distance < near)
    normals = normal[seen] @ inverse
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    place = grid[0][seen], grid[1][seen]
    layer.depth[place] = distance[seen]
    layer.colour[place] = _shade(np.array(shape.colour), normals, rays[seen], light)


def _window(shape: Shape, camera: Camera) -> tuple[slice, slice]:
    """Rows and columns that the shape's box covers."""
    pixels = camera.project(_corners(shape, _BOX))
    low = np.floor(pixels.min(axis=0)).astype(int)
    high = np.ceil(pixels.max(axis=0)).astype(int) + 1
    width, height = camera.size
    return (
        slice(max(low[1], 0), min(high[1], height)),
        slice(max(low[0], 0), min(high[0], width)),
    )


def _shade(colour: Array, normals: Array, rays: Array, light: Array) -> Array:
    """Lambert and Blinn-Phong under one lamp, with a faint one on the far side."""
    facing = normals @ light
    to_eye = -rays / np.linalg.norm(rays, axis=1, keepdims=True)
    half = light + to_eye
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    gloss = GLOSS * np.clip(np.sum(normals * half, axis=1), 0.0, 1.0) ** SHININESS
    lit = AMBIENT + DIFFUSE * np.clip(facing, 0.0, 1.0) + FILL * np.clip(-facing, 0.0, 1.0)
    return np.asarray(np.clip(lit[:, None] * colour + gloss[:, None], 0.0, 1.0))


def _sphere(o: Array, d: Array) -> tuple[Array, Array]:
    """Distance (k,) along rays d (k, 3) from o (3,) and the normal (k, 3) there."""
    near = _roots(np.sum(d * d, axis=1), d @ o, np.full(len(d), o @ o - 1.0))[0]
    distance = np.where(near > 0.0, near, np.inf)
    return distance, o + np.where(np.isfinite(distance), distance, 0.0)[:, None] * d


def _cylinder(o: Array, d: Array) -> tuple[Array, Array]:
    """As `_sphere`, for the side and both ends."""
    a, b = np.sum(d[:, :2] ** 2, axis=1), d[:, :2] @ o[:2]
    side = _bounded(_roots(a, b, np.full(len(d), o[:2] @ o[:2] - 1.0)), o, d)
    points = o + np.where(np.isfinite(side), side, 0.0)[:, None] * d
    normal = points * [1.0, 1.0, 0.0]
    for end in (-1.0, 1.0):
        side, normal = _nearer(side, normal, _end(end, o, d), (0.0, 0.0, end))
    return side, normal


def _cone(o: Array, d: Array) -> tuple[Array, Array]:
    """As `_sphere`, for the side and the base at z = -1; the tip is at z = 1."""
    slope, height = -0.5 * d[:, 2], 0.5 * (1.0 - o[2])
    a = np.sum(d[:, :2] ** 2, axis=1) - slope**2
    b = d[:, :2] @ o[:2] - slope * height
    side = _bounded(_roots(a, b, np.full(len(d), o[:2] @ o[:2] - height**2)), o, d)
    points = o + np.where(np.isfinite(side), side, 0.0)[:, None] * d
    normal = np.column_stack([points[:, :2], 0.25 * (1.0 - points[:, 2])])
    return _nearer(side, normal, _end(-1.0, o, d), (0.0, 0.0, -1.0))


def _box(o: Array, d: Array) -> tuple[Array, Array]:
    """As `_sphere`, for six faces: the last of the three pairs of planes that a ray passes."""
    across = np.where(np.abs(d) < _TINY, _TINY, d)
    entries, exits = (-o - np.sign(across)) / across, (-o + np.sign(across)) / across
    face = np.argmax(entries, axis=1)
    enters = entries.max(axis=1)
    seen = (enters > 0.0) & (enters <= exits.min(axis=1))
    return np.where(seen, enters, np.inf), -np.sign(across) * np.eye(3)[face]


def _roots(a: Array, b: Array, c: Array) -> tuple[Array, Array]:
    """Both solutions of a t^2 + 2 b t + c = 0, in order; infinite where there are none."""
    a = np.where(np.abs(a) < _TINY, _TINY, a)
    under = b * b - a * c
    root = np.sqrt(np.where(under > 0.0, under, 0.0))
    first, second = (-b - root) / a, (-b + root) / a
    none = under <= 0.0
    near, far = np.minimum(first, second), np.maximum(first, second)
    return np.where(none, np.inf, near), np.where(none, np.inf, far)


def _bounded(roots: tuple[Array, Array], o: Array, d: Array) -> Array:
    """The first root in front of the camera with |z| <= 1."""
    found = np.full(len(d), np.inf)
    for t in reversed(roots):
        z = o[2] + np.where(np.isfinite(t), t, 0.0) * d[:, 2]
        found = np.where((t > 0.0) & np.isfinite(t) & (np.abs(z) <= 1.0), t, found)
    return found


def _end(z: float, o: Array, d: Array) -> Array:
    """Distance to the unit disc at this z."""
    down = np.where(np.abs(d[:, 2]) < _TINY, _TINY, d[:, 2])
    t = (z - o[2]) / down
    radius = np.sum((o[:2] + t[:, None] * d[:, :2]) ** 2, axis=1)
    return np.where((t > 0.0) & (radius <= 1.0), t, np.inf)


def _nearer(
    t: Array, normal: Array, other: Array, other_normal: tuple[float, float, float]
) -> tuple[Array, Array]:
    closer = other < t
    return np.where(closer, other, t), np.where(closer[:, None], other_normal, normal)


_MEET: dict[str, Callable[[Array, Array], tuple[Array, Array]]] = {
    "sphere": _sphere,
    "cylinder": _cylinder,
    "cone": _cone,
    "box": _box,
}
