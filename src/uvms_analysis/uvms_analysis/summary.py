"""The metrics of a run, from its log: the content of `summary.json`."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from uvms_analysis.analysis import Analysis
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_core import topics
from uvms_core.signals import Array

Metrics = dict[str, float | None]

LOADED = (
    topics.TRUE_ODOMETRY,
    topics.TRUE_JOINT_STATES,
    topics.TRUE_DISTURBANCE,
    topics.ODOMETRY,
    topics.JOINT_STATES,
    topics.REFERENCE,
    topics.ALLOCATION,
    topics.DIAGNOSTICS,
)


def rms_and_max(values: Array) -> Metrics:
    """Root mean square and greatest length of vectors (k, m), or of numbers (k,)."""
    if not len(values):
        return {"rms": None, "max": None}
    lengths = np.abs(values) if values.ndim == 1 else np.linalg.norm(values, axis=1)
    return {"rms": float(np.sqrt(np.mean(lengths**2))), "max": float(np.max(lengths))}


def percentiles(values: Array) -> Metrics:
    """Median and 99th percentile."""
    if not len(values):
        return {"p50": None, "p99": None}
    return {"p50": float(np.percentile(values, 50)), "p99": float(np.percentile(values, 99))}


def summarise(log: str | Path | RunLog, *, completed: bool, wall_s: float) -> dict[str, Any]:
    """The summary of a run; metrics that the log does not determine are None.

    Args:
        log: a log or its file.
        completed: whether the run reached its end.
        wall_s: wall time that it took, s.

    Raises:
        LogError: the file cannot be read.
    """
    log = log if isinstance(log, RunLog) else RunLog.open(log)
    log.load([topic for topic in LOADED if log.has(topic)])
    run = Analysis(log)
    duration = _or_none(lambda: float(run.truth.time[-1] - run.truth.time[0])) or 0.0
    summary = {
        "scenario": log.run.get("scenario", ""),
        "seed": int(log.run.get("seed", 0)),
        "completed": completed,
        "sim_duration_s": duration,
        "wall_s": wall_s,
        "real_time_factor": duration / wall_s if wall_s > 0.0 else None,
        "lockstep_timeouts": run.lockstep_timeouts,
    }
    summary |= _precision(run) | _effort(run)
    summary["log_fault"] = log.fault or None
    summary["rejected_messages"] = {name: len(items) for name, items in log.rejected.items()}
    return summary


def _precision(run: Analysis) -> dict[str, Any]:
    nothing = {"rms": None, "max": None}
    roll_pitch = _or_none(lambda: run.rpy_deg)
    return {
        "end_effector_error_m": _or(nothing, lambda: rms_and_max(run.end_effector_error)),
        "end_effector_target": _or_none(lambda: run.target.kind),
        "end_effector_tracking_error_m": _or(nothing, lambda: rms_and_max(run.tracking_error)),
        "vehicle_error_m": _or(nothing, lambda: rms_and_max(run.vehicle_error[1])),
        "navigation_error_m": _or(nothing, lambda: rms_and_max(run.navigation[1])),
        "roll_deg": nothing if roll_pitch is None else rms_and_max(roll_pitch[:, 0]),
        "pitch_deg": nothing if roll_pitch is None else rms_and_max(roll_pitch[:, 1]),
    }


def _effort(run: Analysis) -> dict[str, Any]:
    return {
        "self_disturbance": _or(
            {"force_rms_n": None, "moment_rms_nm": None}, lambda: self_disturbance(run)
        ),
        "planner_step_ms": percentiles(run.planner_step_ms),
        "thruster_saturated_fraction": _or_none(
            # Share of the control ticks in which some thruster is at its limit.
            lambda: float(np.mean(run.allocation.saturated.any(axis=1)))
        ),
        "thrust_rms_n": _or_none(lambda: float(np.sqrt(np.mean(run.allocation.thrust**2)))),
    }


def self_disturbance(run: Analysis) -> Metrics:
    """True restoring plus coupling wrench, eq. (16), root mean square of its length.

    The first sample is left out: no joint torque is applied yet, and the arm starts to fall under
    its own weight, which neither planner nor controller can influence.
    """
    wrench = (run.disturbance.restoring + run.disturbance.coupling)[1:]
    return {
        "force_rms_n": rms_and_max(wrench[:, :3])["rms"],
        "moment_rms_nm": rms_and_max(wrench[:, 3:])["rms"],
    }


def _or(otherwise: Any, work: Callable[[], Any]) -> Any:
    try:
        return work()
    except LogError:
        return otherwise


def _or_none(work: Callable[[], Any]) -> Any:
    return _or(None, work)
