"""How clear arm, hull, obstacles and seabed were of one another, truly and in the plan."""

from typing import Any

import numpy as np

from uvms_analysis.analysis import Analysis
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog, Series
from uvms_core.config import Config, validated
from uvms_core.errors import UvmsError
from uvms_core.scene import Obstacles
from uvms_core.signals import Array
from uvms_dynamics.geometry import Geometry, build_geometry, clearances_of_poses

NOTHING = {"min": None, "at_s": None, "pair": None}


class _Scene(Config):
    obstacles: Obstacles = ()


def run_obstacles(log: RunLog) -> Obstacles:
    """The obstacles of a run; none where its log has no configuration.

    Raises:
        LogError: the configuration is damaged.
    """
    if "config.yaml" not in log.attachments:
        return ()
    given = {"obstacles": log.configuration().get("obstacles", ())}
    return validated(_Scene, given, f"log {log.path}: config.yaml", LogError).obstacles


def run_geometry(log: RunLog) -> Geometry:
    """Shapes of a run's vehicle, seabed and obstacles.

    Raises:
        LogError: the log lacks its vehicle, or vehicle or configuration are damaged.
    """
    obstacles = run_obstacles(log)
    try:
        return build_geometry(log.vehicle, obstacles)
    except UvmsError as fault:
        raise LogError(f"log {log.path}: its clearances: {fault}") from fault


def true_clearances(run: Analysis, geometry: Geometry) -> Array:
    """Of each pair (N, k), m, at the times of the true odometry."""
    return _of(run.truth, run.joints.position, geometry)


def planned_clearances(run: Analysis, geometry: Geometry) -> Array | None:
    """Of each pair (N, k), m, at the samples of the references; None where there are none."""
    plan = run.planned
    return None if plan is None else _of(plan, plan.q, geometry)


def _of(poses: Series, angles: Array, geometry: Geometry) -> Array:
    try:
        return clearances_of_poses(geometry, poses.position, poses.quaternion, angles)
    except ValueError as fault:
        raise LogError(f"{poses.name}: its clearances: {fault}") from fault


def least_clearances(run: Analysis) -> dict[str, Any]:
    """The least of all pairs: `min`, m, `at_s` and `pair`; `planned`: the same of the plan.

    Raises:
        LogError: the log has no true poses or no vehicle, or there is no pair.
    """
    geometry = run_geometry(run.log)
    if not geometry.pairs:
        raise LogError(f"log {run.log.path}: its vehicle has no two bodies that could touch")
    planned = planned_clearances(run, geometry)
    least = _least(true_clearances(run, geometry), run.truth.time, geometry)
    if planned is None or run.planned is None:
        return least | {"planned": NOTHING}
    return least | {"planned": _least(planned, run.planned.time, geometry)}


def _least(values: Array, times: Array, geometry: Geometry) -> dict[str, Any]:
    row, column = np.unravel_index(int(np.argmin(values)), values.shape)
    return {
        "min": float(values[row, column]),
        "at_s": float(times[row]),
        "pair": str(geometry.pairs[column]),
    }
