"""The surface of a body as flat panels, with its volume, area, pose and refinement."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from uvms_core.signals import Array

Numbers = NDArray[np.int64]
"""Vertex numbers."""

LONG = 3.0
"""An edge counts as long from this multiple of the mean edge (see `mean_edge`)."""


@dataclass(frozen=True)
class Panels:
    """Flat triangles and quadrilaterals, counter-clockwise as seen from the water.

    vertices (v, 3) m; faces (k, 4) of vertex numbers, where a triangle repeats its last one.
    """

    vertices: Array
    faces: Numbers

    @property
    def count(self) -> int:
        """Number of panels."""
        return len(self.faces)

    @property
    def size(self) -> float:
        """Greatest extent along a coordinate axis, m."""
        return float(np.ptp(self.vertices, axis=0).max())

    def area_vectors(self) -> Array:
        """Area times outward normal of each panel (k, 3), m^2: half the diagonals' product."""
        a, b, c, d = np.moveaxis(self.vertices[self.faces], 1, 0)
        return np.cross(c - a, d - b) / 2.0

    def volume(self) -> float:
        """Enclosed volume, m^3; negative where the normals point inwards."""
        return float(self.cone_volumes().sum())

    def cone_volumes(self) -> Array:
        """Signed volume (k,) between each panel and one corner of the body, m^3."""
        corner = self.vertices[self.faces[:, 0]] - self.vertices.min(axis=0)
        return np.einsum("ij,ij->i", corner, self.area_vectors()) / 3.0

    def triangles(self) -> Array:
        """Corners (k', 3, 3) of the panels, quadrilaterals cut along a diagonal, m."""
        quads = self.faces[self.faces[:, 2] != self.faces[:, 3]]
        return self.vertices[np.concatenate([self.faces[:, :3], quads[:, [0, 2, 3]]])]

    def centroid(self) -> Array:
        """Middle of the enclosed volume (3,), m."""
        origin = self.vertices.min(axis=0)
        corners = self.triangles() - origin
        volumes = np.linalg.det(corners) / 6.0
        return origin + volumes @ corners.sum(axis=1) / (4.0 * volumes.sum())

    def in_frame(self, position: Array, rotation: Array) -> "Panels":
        """The same body in a frame in which its own has the pose (position (3,), R (3, 3))."""
        return replace(self, vertices=self.vertices @ rotation.T + position)

    def flipped(self) -> "Panels":
        """The same panels with their normals reversed."""
        return replace(self, faces=self.faces[:, [1, 0, 3, 2]])

    def refined(self) -> "Panels":
        """Each panel cut into four at the middles of its edges; the surface stays the same."""
        faces = self.faces
        ends = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2))
        edges, number = np.unique(ends, axis=0, return_inverse=True)
        middle = len(self.vertices) + number.reshape(-1, 4)
        inner = len(self.vertices) + len(edges) + np.arange(self.count)
        corners = self.vertices[faces]
        vertices = [self.vertices, self.vertices[edges].mean(axis=1), corners.mean(axis=1)]
        quads, triangles = _quarters(faces, middle, inner), _triangle_quarters(faces, middle)
        triangle = faces[:, 2] == faces[:, 3]
        parts = np.where(triangle[:, None, None], triangles, quads)
        return Panels(np.concatenate(vertices), parts.reshape(-1, 4))


def _quarters(faces: Numbers, middle: Numbers, inner: Numbers) -> Numbers:
    """Four quadrilaterals (k, 4, 4) around the inner point of each quadrilateral."""
    before = np.roll(middle, 1, axis=1)
    around = np.broadcast_to(inner[:, None], faces.shape)
    return np.stack([faces, middle, around, before], axis=-1)


def _triangle_quarters(faces: Numbers, middle: Numbers) -> Numbers:
    """Four triangles (k, 4, 4): one at each corner and the one between them."""
    a, b, c = faces[:, :3].T
    ab, bc, _, ca = middle.T
    thirds = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.stack([np.stack([*each, each[2]], axis=-1) for each in thirds], axis=1)


def with_short_edges(panels: Panels, count: int) -> Panels:
    """At least `count` triangles, by halving the longest edges; the surface stays the same.

    Long thin triangles, as CAD programs write them, spoil the solution in any number: up to half as
    many panels again are spent on cutting them. A cut edge may meet an uncut one, which does no
    harm to collocation at the centres of the panels.
    """
    corners = panels.triangles()
    enough = max(count, 1.5 * len(corners))
    while len(corners) < count or (
        len(corners) < enough and longest_edge(corners) > LONG * mean_edge(corners)
    ):
        lengths = _edge_lengths(corners)
        longest = lengths.max(axis=1)
        cut = longest > 0.75 * longest.max()
        turn = (lengths[cut].argmax(axis=1)[:, None] + np.arange(3)) % 3
        a, b, c = np.moveaxis(np.take_along_axis(corners[cut], turn[:, :, None], axis=1), 1, 0)
        middle = (a + b) / 2.0
        halves = [np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)]
        corners = np.concatenate([corners[~cut], *halves])
    return from_corners(corners)


def longest_edge(corners: Array) -> float:
    """Longest edge of the triangles (k, 3, 3), m."""
    return float(_edge_lengths(corners).max())


def mean_edge(corners: Array) -> float:
    """Edge of as many equilateral triangles of the same area, m."""
    a, b, c = np.moveaxis(corners, 1, 0)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).mean() / 2.0
    return float(np.sqrt(4.0 / np.sqrt(3.0) * area))


def _edge_lengths(corners: Array) -> Array:
    return np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)


def from_corners(corners: Array) -> Panels:
    """Panels of triangles that are given by their corners (k, 3, 3); equal points are joined."""
    vertices, number = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    triangles = number.reshape(-1, 3)
    return Panels(vertices, triangles[:, [0, 1, 2, 2]])
