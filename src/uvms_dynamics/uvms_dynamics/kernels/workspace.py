"""Scratch tables of the kernels, allocated once where they run often."""

from typing import NamedTuple

import numpy as np

from uvms_dynamics.kernels.jit import kernel
from uvms_dynamics.signals import Array


class Workspace(NamedTuple):
    """One row per body (0: the hull) or joint; contents do not outlive a call."""

    rotation: Array  # (n, 3, 3) joint frame to parent
    velocity: Array  # (n+1, 6)
    acceleration: Array  # (n+1, 6)
    force: Array  # (n+1, 6) forces on, or bias forces of, the bodies
    inertia: Array  # (n+1, 6, 6) articulated or composite inertia
    joint: Array  # (n, 8) what the passes of forward dynamics hand on per joint
    down: Array  # (n+1, 3) unit vector downward in each frame


@kernel
def make_workspace(n):
    """Workspace of an arm of n joints."""
    return Workspace(
        np.empty((n, 3, 3)),
        np.empty((n + 1, 6)),
        np.empty((n + 1, 6)),
        np.empty((n + 1, 6)),
        np.empty((n + 1, 6, 6)),
        np.empty((n, 8)),
        np.empty((n + 1, 3)),
    )
