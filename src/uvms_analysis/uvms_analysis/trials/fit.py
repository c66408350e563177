"""Least squares of the dynamic model's residuals, and how far its answer can be trusted."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from uvms_analysis.errors import TrialError
from uvms_analysis.trials.parameters import Parameter, changed, value_at
from uvms_analysis.trials.predict import PreparedTrial, drive_model, dynamic
from uvms_core.signals import Array
from uvms_core.vehicle import vehicle_from_data

DEPTH_WEIGHT_DEG_M = 2.0
"""Residuals of the depth count as so many degrees a metre: the two scatter in that proportion."""

STEP = 0.02
"""Of the finite differences, in units of each parameter's scale."""

PRECISION = 1e-6
"""Relative change of cost and step at which the fit has converged."""

PRIOR_WEIGHT_DEG = 1e-3
"""Residual, degrees, for each scale that a constant moves away from the file's value.

A weak prior: it holds constants on which the residuals do not depend.
"""

RESIDUAL_BOUND_DEG = 1e3
"""Bound on residuals, for simulations that diverge; the optimiser then takes the step back."""

MIN_GROUPS = 3
"""Groups of trials that a jackknife needs."""

SMALLEST_EIGENVALUE = 1e-9
"""Relative eigenvalue below which the residuals do not depend on a direction."""

UNDETERMINED_ERROR = 1e3
"""Standard error of such a direction, in scales."""


@dataclass(frozen=True)
class Fit:
    """Result of a fit: values of the parameters with their covariance."""

    parameters: tuple[Parameter, ...]
    values: Array  # (p,)
    errors: Array  # (p,) standard errors, jackknife over groups of trials
    correlation: Array  # (p, p) of the errors, from the slopes of the residuals
    rms_deg: float  # of roll and pitch over all samples, trials weighted alike
    median_deg: tuple[float, float]  # of the trials' RMSE, roll and pitch
    groups: int  # of trials, left out in turn for the errors


def group_of(name: str) -> str:
    """Trials that repeat one motion, `traj005-0` and `traj005-1`, are one group."""
    return re.sub(r"-\d+$", "", name)


def fit(
    data: Any,
    prepared: Sequence[PreparedTrial],
    parameters: Sequence[Parameter],
    log: Callable[[str], None] = lambda line: None,
    precision: float = PRECISION,
) -> Fit:
    """Fit the parameters of the vehicle data to the trials, starting from its own values."""
    parameters = tuple(parameters)
    scale = np.array([p.scale for p in parameters])
    start = np.array([value_at(data, p.path) for p in parameters]) / scale
    low = np.array([p.low for p in parameters]) / scale

    def residuals(x: Array) -> Array:
        parts = _residuals(data, prepared, parameters, x * scale)
        return np.concatenate([*parts, PRIOR_WEIGHT_DEG * (x - start)])

    def slopes(x: Array) -> Array:
        log(f"  rms {_rms(data, prepared, parameters, x * scale):.4f} deg")
        base = residuals(x)
        return np.stack([(residuals(x + e) - base) / STEP for e in STEP * np.eye(len(x))], axis=1)

    found = least_squares(
        residuals,
        np.maximum(start, low + 1e-3),
        jac=slopes,
        bounds=(low, np.inf),
        ftol=precision,
        xtol=precision,
        gtol=1e-12,
        max_nfev=40,
    )
    parts = _residuals(data, prepared, parameters, found.x * scale)
    rows = [len(r) for r in parts]
    measured = sum(rows)  # without the rows of the prior
    jacobian, residual = slopes(found.x)[:measured], residuals(found.x)[:measured]
    errors = scale * _jackknife(jacobian, residual, rows, prepared)
    rmse = np.sqrt([np.sum(r.reshape(-1, 3)[:, :2] ** 2, axis=0) for r in parts])
    return Fit(
        parameters,
        found.x * scale,
        errors,
        _correlation(jacobian),
        rms_deg=float(np.sqrt(np.mean(rmse**2))),
        median_deg=(float(np.median(rmse[:, 0])), float(np.median(rmse[:, 1]))),
        groups=len(set(_groups([each.trial.name for each in prepared]))),
    )


def _residuals(
    data: Any, prepared: Sequence[PreparedTrial], parameters: Sequence[Parameter], values: Array
) -> list[Array]:
    """Residuals of each trial: roll, pitch (degrees) and weighted depth, over sqrt(samples)."""
    new = changed(data, {p.path: float(v) for p, v in zip(parameters, values, strict=True)})
    model, load = drive_model(vehicle_from_data(new))
    out = []
    for each in prepared:
        trial, predicted = each.trial, dynamic(each, model, load)
        depth = DEPTH_WEIGHT_DEG_M * (predicted.depth - each.depth)
        error = np.column_stack([predicted.tilt - trial.tilt, depth])[trial.accepted]
        error = np.nan_to_num(
            error, nan=RESIDUAL_BOUND_DEG, posinf=RESIDUAL_BOUND_DEG, neginf=-RESIDUAL_BOUND_DEG
        )
        out.append(
            (np.clip(error, -RESIDUAL_BOUND_DEG, RESIDUAL_BOUND_DEG) / np.sqrt(len(error))).ravel()
        )
    return out


def _rms(
    data: Any, prepared: Sequence[PreparedTrial], parameters: Sequence[Parameter], x: Array
) -> float:
    """Root mean square of roll and pitch over the trials, degrees."""
    tilt = [r.reshape(-1, 3)[:, :2] for r in _residuals(data, prepared, parameters, x)]
    return float(np.sqrt(np.mean([0.5 * np.sum(each**2) for each in tilt])))


def _jackknife(
    jacobian: Array, residual: Array, rows: list[int], prepared: Sequence[PreparedTrial]
) -> Array:
    """Standard errors (p,) of the estimate, by leaving out one group of trials at a time.

    One Gauss-Newton step from the full solution for each group, H and J without it:
    (H - H_g)^-1 J_g^T r_g. Whole groups are left out, because the errors within a trial and those
    of a repeated motion are strongly correlated (Tukey's variance; Efron 1982, ch. 3).
    """
    owner = np.repeat(_groups([each.trial.name for each in prepared]), rows)
    groups = sorted(set(owner))
    total = jacobian.T @ jacobian
    moves, undetermined = [], np.zeros_like(total)
    for group in groups:
        own = jacobian[owner == group]
        step, open_variance = _solve(total - own.T @ own, own.T @ residual[owner == group])
        moves.append(step)
        undetermined = np.maximum(undetermined, open_variance)
    spread = np.array(moves) - np.mean(moves, axis=0)
    variance = (len(groups) - 1) / len(groups) * np.sum(spread**2, axis=0)
    return np.asarray(np.sqrt(variance + np.diag(undetermined)))


def _correlation(jacobian: Array) -> Array:
    """Correlations (p, p) of the errors under white noise; 0 for undetermined directions."""
    size = jacobian.shape[1]
    inverse = np.stack([_solve(jacobian.T @ jacobian, unit)[0] for unit in np.eye(size)])
    scale = np.sqrt(np.maximum(np.diag(inverse), 1e-300))
    return np.asarray(inverse / np.outer(scale, scale))


def _groups(names: list[str]) -> list[str]:
    """The group of each trial; with too few groups every trial is its own."""
    groups = [group_of(name) for name in names]
    if len(set(groups)) >= MIN_GROUPS:
        return groups
    if len(names) < MIN_GROUPS:
        raise TrialError(
            f"{len(names)} trials are too few to show how well a constant is determined; at least"
            f" {MIN_GROUPS} are needed"
        )
    return names


def _solve(matrix: Array, right: Array) -> tuple[Array, Array]:
    """Solution of the symmetric system outside its null space, and the variance (p, p) inside it.

    Directions on which the residuals do not depend get a variance far beyond every scale.
    """
    values, vectors = np.linalg.eigh(matrix)
    determined = values > SMALLEST_EIGENVALUE * values[-1]
    inverse = np.where(determined, 1.0 / np.where(determined, values, 1.0), 0.0)
    null = vectors[:, ~determined]
    return vectors @ (inverse * (vectors.T @ right)), UNDETERMINED_ERROR**2 * null @ null.T
