"""Unit shapes of the scene as triangles: vertices (v, 3) and faces (f, 3), outward."""

from functools import lru_cache

import numpy as np

from uvms_bringup.viewer.elements import Kind
from uvms_core.signals import Array

ROUND = 24
"""Corners of a circle."""
NECK, SHAFT = 0.72, 0.4
"""Of an arrow: where its head begins, and the radius of its shaft."""
_PROFILES: dict[str, list[tuple[float, float]]] = {
    "sphere": [(float(np.sin(a)), float(-np.cos(a))) for a in np.linspace(0.0, np.pi, 13)],
    "cylinder": [(0.0, -1.0), (1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (1.0, 1.0), (0.0, 1.0)],
    "cone": [(0.0, -1.0), (1.0, -1.0), (1.0, -1.0), (0.0, 1.0)],
    "arrow": [(0.0, 0.0), (SHAFT, 0.0), (SHAFT, 0.0), (SHAFT, NECK), (SHAFT, NECK), (1.0, NECK),
              (1.0, NECK), (0.0, 1.0)],
}  # fmt: skip
"""Radius and height of the outline that is turned about z; a point that comes twice is an edge."""


@lru_cache
def unit_mesh(kind: Kind) -> tuple[Array, np.ndarray]:
    """Vertices and faces of a unit shape."""
    return _box() if kind == "box" else _turned(_PROFILES[kind])


def _turned(profile: list[tuple[float, float]]) -> tuple[Array, np.ndarray]:
    angle = np.linspace(0.0, 2.0 * np.pi, ROUND, endpoint=False)
    rings = [
        np.column_stack([r * np.cos(angle), r * np.sin(angle), np.full(ROUND, z)])
        for r, z in profile
    ]
    here, following = np.arange(ROUND), np.roll(np.arange(ROUND), -1)
    faces = []
    for ring in range(len(profile) - 1):
        a, b = ring * ROUND + here, ring * ROUND + following
        c, d = a + ROUND, b + ROUND
        faces += [np.column_stack([a, b, d]), np.column_stack([a, d, c])]
    return np.concatenate(rings), np.concatenate(faces)


def _box() -> tuple[Array, np.ndarray]:
    """Four corners a face, so that edges stay sharp."""
    vertices: list[Array] = []
    faces: list[list[int]] = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            along = sign * np.eye(3)[axis]
            across, up = np.eye(3)[(axis + 1) % 3], sign * np.eye(3)[(axis + 2) % 3]
            corners = [along - across - up, along + across - up, along + across + up,
                       along - across + up]  # fmt: skip
            start = len(vertices)
            vertices += corners
            faces += [[start, start + 1, start + 2], [start, start + 2, start + 3]]
    return np.array(vertices), np.array(faces)
