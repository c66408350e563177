"""Added mass with its discretisation error, from two resolutions of the same surface."""

from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.panel_method.errors import PanelMethodError
from uvms_dynamics.panel_method.panels import Panels
from uvms_dynamics.panel_method.solver import Progress, solve

NEGATIVE = 1e-3
"""Negative eigenvalue, relative to the largest, beyond which the result is refused."""

NEGLIGIBLE = 1e-3
"""Terms below this part of the displaced water's inertia count as unchanged."""


@dataclass(frozen=True)
class AddedMassEstimate:
    """Added mass (6, 6), order X Y Z K M N, SI, symmetric and positive semidefinite.

    `solved` holds (panels, matrix) of each resolution as computed; `change` (6,) is the relative
    change of each diagonal term by the extrapolation (None with a single resolution; 0 for
    negligible terms). `asymmetry` is the largest |A - A^T| of the finest, and `clipped` the most
    negative eigenvalue that was set to zero, both relative to the largest entry with lengths in
    units of the cube root of the volume.
    """

    matrix: Array
    solved: tuple[tuple[int, Array], ...]
    change: Array | None
    asymmetry: float
    clipped: float
    volume: float


def estimate(
    levels: tuple[Panels, ...], density: float, progress: Progress | None = None
) -> AddedMassEstimate:
    """Added mass of one body from one surface or from a surface and its halved panels.

    The error falls with the panels' size squared where the surface is smooth, so that
    A = (4 A_fine - A_coarse) / 3 (Richardson). Edges converge more slowly; then `change` is
    nearer to the error itself. The volume is extrapolated in the same way.
    """
    if not (np.isfinite(density) and density > 0.0):
        raise PanelMethodError(f"density {density:g}: must be a density in kg/m^3, > 0")
    solved = [(panels.count, solve(panels, density, progress)) for panels in levels]
    volumes = np.array([panels.volume() for panels in levels])
    finest = solved[-1][1]
    raw, volume = finest, float(volumes[-1])
    if len(levels) > 1:
        raw = (4.0 * finest - solved[-2][1]) / 3.0
        volume = float((4.0 * volumes[-1] - volumes[-2]) / 3.0)
    units = _units(volume)
    matrix, clipped = _semidefinite((raw + raw.T) / 2.0, units)
    scaled = finest / np.outer(units, units)
    return AddedMassEstimate(
        matrix=matrix,
        solved=tuple(solved),
        change=_change(matrix, finest, density * volume * units**2) if len(levels) > 1 else None,
        asymmetry=float(np.abs(scaled - scaled.T).max() / np.abs(scaled).max()),
        clipped=clipped,
        volume=volume,
    )


def _units(volume: float) -> Array:
    length = volume ** (1.0 / 3.0)
    return np.array([1.0, 1.0, 1.0, length, length, length])


def _semidefinite(matrix: Array, units: Array) -> tuple[Array, float]:
    """The nearest positive semidefinite matrix, and the eigenvalue that was removed."""
    values, vectors = np.linalg.eigh(matrix / np.outer(units, units))
    if values[0] >= 0.0:
        return matrix, 0.0
    if values[0] < -NEGATIVE * values[-1]:
        raise PanelMethodError(
            f"the added mass has a negative eigenvalue, {values[0] / values[-1]:.2g} of the"
            " largest: the panels are too coarse for this body, overlap, or point inwards"
        )
    repaired = (vectors * np.maximum(values, 0.0)) @ vectors.T
    repaired = (repaired + repaired.T) / 2.0
    return repaired * np.outer(units, units), float(-values[0] / values[-1])


def _change(matrix: Array, finest: Array, scale: Array) -> Array:
    value, before = np.diag(matrix), np.diag(finest)
    present = value > NEGLIGIBLE * scale
    return np.where(present, np.abs(value - before) / np.where(present, value, 1.0), 0.0)
