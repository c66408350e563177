"""Least squares of the dynamic model's residuals, and how far its answer can be trusted."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from uvms_analysis.errors import TrialError
from uvms_analysis.trials.parameters import Parameter, changed, value_at
from uvms_analysis.trials.predict import Course, drive_model, dynamic
from uvms_core.signals import Array
from uvms_core.vehicle import vehicle_from_data

DEPTH_WEIGHT_DEG_M = 2.0
"""Residuals of the depth count as so many degrees a metre: the two scatter in that proportion."""

STEP = 0.02
"""Of the finite differences, in the scales of the parameters."""

PRECISION = 1e-6
"""Relative, of the cost and the step, at which the fit has converged."""

LEASH = 1e-3
"""Degrees that a constant costs for each of its scales from the file: holds what is not felt."""

WILD_DEG = 1e3
"""Residual of a simulation that left the numbers; the step that led there is taken back."""

FEWEST_GROUPS = 3
"""Groups of trials below which their scatter says nothing."""

NULL, BLIND = 1e-9, 1e3
"""Relative eigenvalue below which a direction is not felt, and the standard error it then gets."""


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
    courses: Sequence[Course],
    parameters: Sequence[Parameter],
    tell: Callable[[str], None] = lambda line: None,
    precision: float = PRECISION,
) -> Fit:
    """Fit the parameters of the vehicle data to the courses, from the values in the data."""
    parameters = tuple(parameters)
    scale = np.array([p.scale for p in parameters])
    start = np.array([value_at(data, p.path) for p in parameters]) / scale
    low = np.array([p.low for p in parameters]) / scale

    def residuals(x: Array) -> Array:
        parts = _residuals(data, courses, parameters, x * scale)
        return np.concatenate([*parts, LEASH * (x - start)])

    def slopes(x: Array) -> Array:
        tell(f"  rms {_rms(data, courses, parameters, x * scale):.4f} deg")
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
    parts = _residuals(data, courses, parameters, found.x * scale)
    rows = [len(r) for r in parts]
    felt = sum(rows)
    jacobian, residual = slopes(found.x)[:felt], residuals(found.x)[:felt]
    errors = scale * _jackknife(jacobian, residual, rows, courses)
    rmse = np.sqrt([np.sum(r.reshape(-1, 3)[:, :2] ** 2, axis=0) for r in parts])
    return Fit(
        parameters,
        found.x * scale,
        errors,
        _correlation(jacobian),
        rms_deg=float(np.sqrt(np.mean(rmse**2))),
        median_deg=(float(np.median(rmse[:, 0])), float(np.median(rmse[:, 1]))),
        groups=len(set(_groups([course.trial.name for course in courses]))),
    )


def _residuals(
    data: Any, courses: Sequence[Course], parameters: Sequence[Parameter], values: Array
) -> list[Array]:
    """Of each course: roll, pitch (degrees) and weighted depth, over the root of their number."""
    new = changed(data, {p.path: float(v) for p, v in zip(parameters, values, strict=True)})
    model, load = drive_model(vehicle_from_data(new))
    out = []
    for course in courses:
        trial, said = course.trial, dynamic(course, model, load)
        depth = DEPTH_WEIGHT_DEG_M * (said.depth - course.depth)
        error = np.column_stack([said.tilt - trial.tilt, depth])[trial.accepted]
        error = np.nan_to_num(error, nan=WILD_DEG, posinf=WILD_DEG, neginf=-WILD_DEG)
        out.append((np.clip(error, -WILD_DEG, WILD_DEG) / np.sqrt(len(error))).ravel())
    return out


def _rms(data: Any, courses: Sequence[Course], parameters: Sequence[Parameter], x: Array) -> float:
    """Root mean square of roll and pitch over the courses, degrees."""
    tilt = [r.reshape(-1, 3)[:, :2] for r in _residuals(data, courses, parameters, x)]
    return float(np.sqrt(np.mean([0.5 * np.sum(each**2) for each in tilt])))


def _jackknife(
    jacobian: Array, residual: Array, rows: list[int], courses: Sequence[Course]
) -> Array:
    """Standard errors (p,) of the estimate, by leaving out one group of trials at a time.

    One Gauss-Newton step from the full solution for each group, H and J without it:
    (H - H_g)^-1 J_g^T r_g. Whole groups go, because the errors within a trial, and of one motion
    repeated, are anything but independent (Tukey's variance; Efron 1982, ch. 3).
    """
    owner = np.repeat(_groups([course.trial.name for course in courses]), rows)
    groups = sorted(set(owner))
    total = jacobian.T @ jacobian
    moves, unseen = [], np.zeros_like(total)
    for group in groups:
        mine = jacobian[owner == group]
        step, blind = _solve(total - mine.T @ mine, mine.T @ residual[owner == group])
        moves.append(step)
        unseen = np.maximum(unseen, blind)
    spread = np.array(moves) - np.mean(moves, axis=0)
    variance = (len(groups) - 1) / len(groups) * np.sum(spread**2, axis=0)
    return np.asarray(np.sqrt(variance + np.diag(unseen)))


def _correlation(jacobian: Array) -> Array:
    """Correlations (p, p) of errors from white noise; what is not felt goes with nothing."""
    size = jacobian.shape[1]
    inverse = np.stack([_solve(jacobian.T @ jacobian, unit)[0] for unit in np.eye(size)])
    scale = np.sqrt(np.maximum(np.diag(inverse), 1e-300))
    return np.asarray(inverse / np.outer(scale, scale))


def _groups(names: list[str]) -> list[str]:
    """The group of each trial; with too few groups every trial is its own."""
    groups = [group_of(name) for name in names]
    if len(set(groups)) >= FEWEST_GROUPS:
        return groups
    if len(names) < FEWEST_GROUPS:
        raise TrialError(
            f"{len(names)} trials do not show how well a constant is determined; at least"
            f" {FEWEST_GROUPS} are needed"
        )
    return names


def _solve(matrix: Array, right: Array) -> tuple[Array, Array]:
    """Solution of the symmetric system without its null space, and what that leaves open.

    A direction that the residuals do not feel gets a variance far beyond every scale.
    """
    values, vectors = np.linalg.eigh(matrix)
    seen = values > NULL * values[-1]
    inverse = np.where(seen, 1.0 / np.where(seen, values, 1.0), 0.0)
    blind = vectors[:, ~seen]
    return vectors @ (inverse * (vectors.T @ right)), BLIND**2 * blind @ blind.T
