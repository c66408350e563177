"""Surfaces from mesh files."""

from pathlib import Path
from typing import Any

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.panel_method.checks import check_closed, check_metres, check_outward
from uvms_dynamics.panel_method.errors import PanelMethodError
from uvms_dynamics.panel_method.optional import optional
from uvms_dynamics.panel_method.panels import Panels, from_corners

FORMATS = (".stl", ".obj", ".ply", ".off", ".glb", ".gltf")
"""Read by trimesh; capytaine reads the others."""


def load_panels(path: str | Path, scale: float | None = None, flip: bool = False) -> Panels:
    """Closed surface of a mesh file in its own frame, m.

    `scale` is the file's unit in metres (None: metres, and the size must be plausible); `flip`
    reverses the normals. Raises PanelMethodError unless the surface is closed and its normals point
    outwards.
    """
    path = Path(path)
    if scale is not None and not (np.isfinite(scale) and scale > 0.0):
        raise PanelMethodError(f"scale {scale:g}: must be the file's unit in metres, > 0")
    corners = _read(path) * (1.0 if scale is None else scale)
    if not len(corners):
        raise PanelMethodError(f"{path}: it has no triangles or quadrilaterals")
    if not np.isfinite(corners).all():
        raise PanelMethodError(f"{path}: it has coordinates that are not finite")
    panels = from_corners(_joined(corners))
    check_closed(panels, str(path))
    panels = panels.flipped() if flip else panels
    check_outward(panels, str(path))
    if scale is None:
        check_metres(panels, str(path))
    return panels


def _read(path: Path) -> Array:
    """Corners (k, 3, 3) of the triangles of a file."""
    if not path.is_file():
        raise PanelMethodError(f"{path}: there is no such mesh file")
    try:
        if path.suffix.lower() in FORMATS:
            mesh: Any = optional("trimesh").load(path, force="mesh", process=False)
            return np.asarray(mesh.vertices, dtype=float)[np.asarray(mesh.faces)]
        return _read_by_capytaine(path)
    except PanelMethodError:
        raise
    except Exception as fault:  # readers raise errors of many kinds on a broken file
        choices = ", ".join(FORMATS)
        raise PanelMethodError(
            f"{path}: cannot be read as a mesh ({fault}); known formats are {choices} and"
            " those of capytaine (.gdf, .mar, .pnl, .hst; with meshio .msh, .vtk and more)"
        ) from fault


def _read_by_capytaine(path: Path) -> Array:
    mesh = optional("capytaine").load_mesh(path).merged()
    faces = np.array([[*face, face[-1]][:4] for face in mesh._faces])
    quads = faces[faces[:, 2] != faces[:, 3]]
    triangles = np.concatenate([faces[:, :3], quads[:, [0, 2, 3]]])
    return np.asarray(mesh.vertices)[triangles]


def _joined(corners: Array) -> Array:
    """Corners on a grid of 1e-7 of the size, without triangles that collapse on it.

    STL has no shared corners and single precision; equal points must become identical.
    """
    size = float(np.ptp(corners.reshape(-1, 3), axis=0).max())
    step = 1e-7 * size if size > 0.0 else 1.0
    corners = np.round(corners / step) * step
    a, b, c = np.moveaxis(corners, 1, 0)
    apart = [(p != q).any(axis=1) for p, q in ((a, b), (b, c), (c, a))]
    return corners[np.logical_and.reduce(apart)]
