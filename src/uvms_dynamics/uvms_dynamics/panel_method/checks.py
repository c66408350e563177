"""Requirements on a surface for the panel method."""

from dataclasses import replace
from itertools import permutations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from uvms_core.signals import Array
from uvms_dynamics.panel_method.errors import PanelMethodError
from uvms_dynamics.panel_method.panels import Numbers, Panels

SMALLEST_M, LARGEST_M = 0.01, 30.0
"""Plausible range of a body's length."""

MOST_POINTS = 200
"""Corners of a surface that are tested against each other surface."""

SLIVER = 1e-10
"""Share of the total area below which a panel has no reliable normal."""


def check_closed(panels: Panels, what: str) -> None:
    """Raise PanelMethodError unless each edge joins two panels of opposite direction there."""
    start, end = _edges(panels)
    n = len(panels.vertices)
    forth, back = start * n + end, end * n + start
    _, first, times = np.unique(np.minimum(forth, back), return_index=True, return_counts=True)
    if (bad := times != 2).any():
        raise PanelMethodError(
            f"{what}: the surface is not closed: {bad.sum()} of {len(times)} edges belong to one"
            f" panel only or to more than two (one of them at {_point(panels, start[first[bad]])})."
            " Fill the holes and make it one solid with a mesh tool (MeshLab, Blender, CAD)"
        )
    if (twice := len(forth) - len(np.unique(forth))) > 0:
        raise PanelMethodError(
            f"{what}: neighbouring panels have opposite orientation at {twice} edges:"
            " make the normals consistent with a mesh tool, outwards"
        )


def check_outward(panels: Panels, what: str) -> int:
    """Number of separate surfaces; each must enclose a volume of its own, normals outwards."""
    label = surface_labels(panels)
    volumes = np.bincount(label, weights=panels.cone_volumes())
    if (volumes < 0.0).all():
        raise PanelMethodError(
            f"{what}: the normals point inwards (enclosed volume {panels.volume():.4g} m^3):"
            " reverse them with --flip"
        )
    if (volumes <= 0.0).any():
        raise PanelMethodError(
            f"{what}: {len(volumes)} separate surfaces, one of which encloses"
            f" {volumes.min():.4g} m^3: an inner wall or a surface inside out. Keep only what"
            " touches the water outside"
        )
    _check_apart(panels, label, what)
    return len(volumes)


def surface_labels(panels: Panels) -> Numbers:
    """Number (k,) of the connected surface that each panel belongs to, from 0 without gaps."""
    start, end = _edges(panels)
    n = len(panels.vertices)
    joined = coo_array((np.ones(len(start)), (start, end)), shape=(n, n))
    label = connected_components(joined, directed=False)[1][panels.faces[:, 0]]
    return np.unique(label, return_inverse=True)[1].astype(np.int64)


def _check_apart(panels: Panels, label: Numbers, what: str) -> None:
    """Raise PanelMethodError if a corner of one surface lies within another one."""
    surfaces = [replace(panels, faces=panels.faces[label == i]) for i in range(label.max() + 1)]
    for one, other in permutations(surfaces, 2):
        numbers = np.unique(one.faces)
        points = panels.vertices[numbers[:: -(-len(numbers) // MOST_POINTS)]]
        if (inside := winding_number(other, points) > 0.5).any():
            x, y, z = points[inside.argmax()]
            raise PanelMethodError(
                f"{what}: {len(surfaces)} separate surfaces, two of which overlap or lie within"
                f" each other (at {x:.4g}, {y:.4g}, {z:.4g}). Unite them and keep only what"
                " touches the water outside"
            )


def winding_number(panels: Panels, points: Array) -> Array:
    """How often the surface encloses each point (n, 3): 1 within, 0 outside.

    Sum of the triangles' solid angles over 4 pi (Van Oosterom and Strackee 1983).
    """
    corners = panels.triangles()
    total = np.empty(len(points))
    for index, point in enumerate(points):
        a, b, c = np.moveaxis(corners - point, 1, 0)
        la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
        dot = np.einsum
        above = dot("ij,ij->i", a, np.cross(b, c))
        below = la * lb * lc + dot("ij,ij->i", a, b) * lc
        below += dot("ij,ij->i", b, c) * la + dot("ij,ij->i", c, a) * lb
        total[index] = np.arctan2(above, below).sum() / (2.0 * np.pi)
    return total


def check_metres(panels: Panels, what: str) -> None:
    """Raise PanelMethodError if the size of a file without units is implausible in metres."""
    if not SMALLEST_M <= panels.size <= LARGEST_M:
        raise PanelMethodError(
            f"{what}: it is {panels.size:.4g} m long and {panels.volume():.4g} m^3 large if its"
            f" numbers are metres; expected is a length of {SMALLEST_M:g} to {LARGEST_M:g} m."
            " Give the unit: --scale 0.001 for millimetres, --scale 0.0254 for inches,"
            " --scale 1 if they are metres"
        )


def without_slivers(panels: Panels) -> Panels:
    """The panels whose area is large enough to have a normal."""
    area = np.linalg.norm(panels.area_vectors(), axis=1)
    return replace(panels, faces=panels.faces[area > SLIVER * area.sum()])


def _edges(panels: Panels) -> tuple[Array, Array]:
    """Start and end of every edge of every panel, in the panel's own direction."""
    start, end = panels.faces.ravel(), np.roll(panels.faces, -1, axis=1).ravel()
    real = start != end
    return start[real].astype(np.int64), end[real].astype(np.int64)


def _point(panels: Panels, index: Array) -> str:
    x, y, z = panels.vertices[index[0]]
    return f"{x:.4g}, {y:.4g}, {z:.4g}"
