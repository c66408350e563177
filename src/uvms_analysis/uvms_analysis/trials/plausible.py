"""Checks of a trial: units that its numbers rule out, and gaps in time."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from uvms_analysis.errors import TrialError
from uvms_core.signals import Array
from uvms_dynamics.kernels.rotations import quat_to_rpy

LARGEST_ANGLE_RAD = 4.0 * np.pi
"""Bound on joint angles, two turns; angles given in degrees usually exceed it."""

DISAGREEMENT_DEG = 1.0
"""Allowed median difference of roll and pitch from the quaternion in the same file."""

SMALL_DEG = 0.5
"""Tilt below which roll and pitch may be in radians (0.5 rad are 29 degrees)."""

LONGEST_GAP_S = 0.2
"""Longest gap between two samples without a note; the arm's motion is interpolated in it."""

_AXES = {"q_b": 3, "q_c": 2, "q_d": 1, "q_e": 0}  # column of `alpha`


def check_angles(file: Path, alpha: Array) -> None:
    """Raise TrialError if the measured axes (k, 4), rad, e to b, must be degrees."""
    for name, place in _AXES.items():
        worst = alpha[np.abs(alpha[:, place]).argmax(), place]
        if abs(worst) > LARGEST_ANGLE_RAD:
            raise TrialError(
                f"{file}: column {name}: {worst:g} rad is more than two turns"
                f" ({LARGEST_ANGLE_RAD:.4g}); are these radians?"
            )


def tilt_notes(file: Path, tilt: Array, quaternion: Array | None) -> list[str]:
    """Notes on the measured roll and pitch (k, 2), degrees.

    quaternion: (k, 4) w, x, y, z from the same file, rows of nan where it is missing.

    Raises:
        TrialError: the quaternion shows that roll and pitch are radians.
    """
    known = np.zeros(0, dtype=bool) if quaternion is None else np.isfinite(quaternion).all(axis=1)
    if quaternion is None or not known.any():
        largest = float(np.abs(tilt).max())
        if largest >= SMALL_DEG:
            return []
        return [f"{file}: roll and pitch never exceed {largest:.2g}; are they degrees?"]
    own = np.degrees([quat_to_rpy(np.roll(each, -1))[:2] for each in _unit(quaternion[known])])
    off = _median_difference(tilt[known], own)
    if off <= DISAGREEMENT_DEG:
        return []
    if _median_difference(np.degrees(tilt[known]), own) <= DISAGREEMENT_DEG:
        raise TrialError(
            f"{file}: columns roll, pitch: are radians by the quaternion beside them; must be"
            " degrees"
        )
    return [
        f"{file}: roll and pitch differ from the quaternion beside them by {off:.2g} deg in the"
        " median; roll and pitch are what is used"
    ]


def gap_notes(file: Path, t: Array) -> list[str]:
    """A note on the longest gap in time (k,) and the number of others, if there are any."""
    steps = np.diff(t)
    gaps = np.flatnonzero(steps > LONGEST_GAP_S + 1e-6)
    if not len(gaps):
        return []
    longest = gaps[steps[gaps].argmax()]
    others = f"; {len(gaps) - 1} more of over {LONGEST_GAP_S:g} s" if len(gaps) > 1 else ""
    return [
        f"{file}: no samples for {steps[longest]:.2f} s after t = {t[longest]:g} s{others};"
        " the arm's motion there is interpolated"
    ]


def optional_columns(columns: Mapping[str, Array], *names: str) -> Array | None:
    """Optional columns (k, n); None if one is absent."""
    if any(name not in columns for name in names):
        return None
    return np.stack([columns[name] for name in names], axis=1)


def _unit(quaternion: Array) -> Array:
    length = np.linalg.norm(quaternion, axis=1, keepdims=True)
    return np.asarray(quaternion / np.where(length > 0.0, length, 1.0))


def _median_difference(one: Array, other: Array) -> float:
    return float(np.median(np.abs(one - other), axis=0).max())
