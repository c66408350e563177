"""How good the navigation filter is against the truth, and by its own account."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from uvms_analysis.analysis import Analysis, at_common_stamps
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_core import topics
from uvms_core.signals import Array
from uvms_dynamics.kernels.rotations import quat_to_rpy

WITHIN = 3.0
"""Standard deviations within which the error should mostly be."""
KEYS = ("accepted", "gated", "level")
"""What navigation tells of a sensor: samples used, samples rejected, level of the residuals."""


def normalized_error(run: Analysis) -> tuple[Array, Array]:
    """Time (k,) and e' P^-1 e / 3 of the position error (k,): 1 on average in a right filter.

    NEES of Bar-Shalom, Li, Kirubarajan, *Estimation with Applications*, sec. 5.4, per dimension.

    Raises:
        LogError: the log lacks estimate or truth, or a covariance is singular.
    """
    estimate, truth = at_common_stamps(run.estimate, run.truth)
    error = estimate.position - truth.position
    covariance = estimate.pose_covariance[:, :3, :3]
    if not np.all(np.linalg.eigvalsh(covariance)[:, 0] > 0.0):
        raise LogError("a covariance of the estimated position is not positive definite")
    weighted = np.linalg.solve(covariance, error[:, :, None])[:, :, 0]
    return truth.time, np.einsum("ki,ki->k", error, weighted) / 3.0


def share_within(run: Analysis) -> float:
    """Share of the ticks in which each axis' position error is within three of its sigmas."""
    _, error, sigma = run.navigation
    return float(np.mean(np.all(np.abs(error) <= WITHIN * sigma, axis=1)))


def attitude_error_deg(run: Analysis) -> tuple[Array, Array]:
    """Time (k,) and estimated less true roll, pitch and yaw, (k, 3) degrees within ±180."""
    estimate, truth = at_common_stamps(run.estimate, run.truth)
    pairs = zip(estimate.quaternion, truth.quaternion, strict=True)
    errors = np.array([np.subtract(quat_to_rpy(one), quat_to_rpy(two)) for one, two in pairs])
    return truth.time, np.rad2deg((errors + np.pi) % (2.0 * np.pi) - np.pi)


def sensors(log: RunLog) -> dict[str, Mapping[str, Any]]:
    """What navigation last said of each sensor, by its name: `KEYS`, each NaN where it is not told.

    Raises:
        LogError: it says nothing.
    """
    statuses = log.statuses(topics.NAVIGATION)
    if not statuses:
        raise LogError("navigation says nothing of its sensors on /diagnostics")
    last = statuses[-1]
    names = [key.removesuffix("_level") for key in last.values if key.endswith("_level")]
    if not names:
        raise LogError("navigation says nothing of its sensors on /diagnostics")
    return {name: {key: last.number(f"{name}_{key}") for key in KEYS} for name in names}
