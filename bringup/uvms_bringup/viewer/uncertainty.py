"""Ellipsoids of the estimate's error, at the body's origin and at the tool."""

import numpy as np

from uvms_bringup.viewer.elements import HIDDEN, Colour, Look, Node, Place, Places
from uvms_core.rotations import matrix_to_quat, skew
from uvms_core.signals import Array

ERROR: Colour = (0.55, 0.80, 1.0)
SIGMAS = 3.0
"""Half axes of an ellipsoid in standard deviations."""
NAMES = "error_vehicle", "error_tool"


def error_nodes() -> list[Node]:
    """The two ellipsoids, hidden."""
    return [Node(name, Look("sphere", ERROR, 0.35), HIDDEN) for name in NAMES]


def error_places(covariance: Array | None, body: Array, tool: Array) -> Places:
    """Where they are.

    Args:
        covariance: (6, 6) of the pose: position and rotation about the axes, map_ned.
        body: (3,) m, the estimated body origin in map_ned.
        tool: (3,) m, the estimated tool.
    """
    if covariance is None:
        return dict.fromkeys(NAMES, HIDDEN)
    lever = np.hstack([np.eye(3), -skew(tool - body)])
    parts = covariance[:3, :3], lever @ covariance @ lever.T
    return {
        name: _ellipsoid(part, centre)
        for name, part, centre in zip(NAMES, parts, (body, tool), strict=True)
    }


def _ellipsoid(covariance: Array, centre: Array) -> Place:
    """All points within `SIGMAS` standard deviations."""
    variances, axes = np.linalg.eigh(covariance)
    if np.linalg.det(axes) < 0.0:
        axes[:, 0] *= -1.0
    half = SIGMAS * np.sqrt(np.maximum(variances, 0.0))
    return Place(centre, matrix_to_quat(axes), half, visible=bool(half.max() > 0.0))
