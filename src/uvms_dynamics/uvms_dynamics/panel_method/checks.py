"""What a surface must be before the panel method can make sense of it."""

from dataclasses import replace

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from uvms_dynamics.panel_method.errors import PanelMethodError
from uvms_dynamics.panel_method.panels import Panels
from uvms_dynamics.signals import Array

SMALLEST_M, LARGEST_M = 0.01, 30.0
"""Extents of a body that look like metres."""

SLIVER = 1e-10
"""A panel below this part of the whole area has no reliable normal."""


def check_closed(panels: Panels, what: str) -> None:
    """Raise PanelMethodError unless each edge joins two panels that run along it oppositely."""
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
            f"{what}: neighbouring panels point to different sides at {twice} edges:"
            " make the normals consistent with a mesh tool, outwards"
        )


def check_outward(panels: Panels, what: str) -> int:
    """Number of separate surfaces, each of which must enclose water outside of it."""
    volumes = surface_volumes(panels)
    if (volumes < 0.0).all():
        raise PanelMethodError(
            f"{what}: the normals point inwards (enclosed volume {panels.volume():.4g} m^3):"
            " turn them round with --flip"
        )
    if (volumes <= 0.0).any():
        raise PanelMethodError(
            f"{what}: {len(volumes)} separate surfaces, one of which encloses"
            f" {volumes.min():.4g} m^3: an inner wall or a surface inside out. Leave only what"
            " touches the water outside"
        )
    return len(volumes)


def surface_volumes(panels: Panels) -> Array:
    """Volume that each connected surface encloses, m^3, negative if inside out."""
    start, end = _edges(panels)
    n = len(panels.vertices)
    joined = coo_array((np.ones(len(start)), (start, end)), shape=(n, n))
    label = connected_components(joined, directed=False)[1][panels.faces[:, 0]]
    sums = np.bincount(label, weights=panels.cone_volumes())
    return sums[np.unique(label)]


def check_metres(panels: Panels, what: str) -> None:
    """Raise PanelMethodError if the size of a file without units is no size in metres."""
    if not SMALLEST_M <= panels.size <= LARGEST_M:
        raise PanelMethodError(
            f"{what}: it is {panels.size:.4g} m long and {panels.volume():.4g} m^3 large if its"
            f" numbers are metres; expected is a length of {SMALLEST_M:g} to {LARGEST_M:g} m."
            " Say what they are: --scale 0.001 for millimetres, --scale 0.0254 for inches,"
            " --scale 1 for metres indeed"
        )


def without_slivers(panels: Panels) -> Panels:
    """The panels whose area is large enough to have a normal."""
    area = np.linalg.norm(panels.area_vectors(), axis=1)
    return replace(panels, faces=panels.faces[area > SLIVER * area.sum()])


def _edges(panels: Panels) -> tuple[Array, Array]:
    """Start and end of every edge of every panel, in the panel's own sense."""
    start, end = panels.faces.ravel(), np.roll(panels.faces, -1, axis=1).ravel()
    real = start != end
    return start[real].astype(np.int64), end[real].astype(np.int64)


def _point(panels: Panels, index: Array) -> str:
    x, y, z = panels.vertices[index[0]]
    return f"{x:.4g}, {y:.4g}, {z:.4g}"
