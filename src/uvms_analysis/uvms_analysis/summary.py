"""The metrics of a run, from its log: the content of `summary.json`."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from uvms_analysis.analysis import Analysis
from uvms_analysis.check import check_log
from uvms_analysis.clearance import NOTHING, least_clearances
from uvms_analysis.counters import node_counters
from uvms_analysis.energy import BATTERY, ENERGY, battery, energy
from uvms_analysis.errors import LogError, determine
from uvms_analysis.goals_of import goals_of
from uvms_analysis.happened import events_of, not_reached
from uvms_analysis.log import plant_record
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.run_end import RunEnd
from uvms_analysis.lyapunov import NAMES, stability
from uvms_analysis.outcome import judge, judged_by
from uvms_analysis.thruster_faults import errors_first_s, thruster_faults
from uvms_core import topics
from uvms_core.signals import Array
from uvms_core.vehicle import vehicle_warnings

Metrics = dict[str, float | None]

LOADED = (
    topics.TRUE_ODOMETRY,
    topics.TRUE_JOINT_STATES,
    topics.TRUE_DISTURBANCE,
    topics.ODOMETRY,
    topics.JOINT_STATES,
    topics.REFERENCE,
    topics.ALLOCATION,
    topics.APPLIED_THRUST,
    topics.STABILITY,
    topics.BATTERY_STATE,
    *topics.GAPS,
    topics.DIAGNOSTICS,
)


def rms_and_max(values: Array) -> Metrics:
    """Root mean square and greatest length of vectors (k, m), or of numbers (k,)."""
    if not len(values):
        return {"rms": None, "max": None}
    lengths = np.abs(values) if values.ndim == 1 else np.linalg.norm(values, axis=1)
    return {"rms": float(np.sqrt(np.mean(lengths**2))), "max": float(np.max(lengths))}


END_S = 5.0
"""s; how long the end of a run is, by which one sees whether it has settled after what happened."""


def at_end(values: Array, times: Array) -> Metrics:
    """Greatest length of vectors (k, m), or of numbers (k,), among the last `END_S` of them.

    The values are as far apart as the `times` (n,), s, and may be fewer.
    """
    if not len(values):
        return {"end": None}
    count = int(np.count_nonzero(times >= times[-1] - END_S))
    return {"end": rms_and_max(values[-count:])["max"]}


def percentiles(values: Array) -> Metrics:
    """Median and 99th percentile."""
    if not len(values):
        return {"p50": None, "p99": None}
    return {"p50": float(np.percentile(values, 50)), "p99": float(np.percentile(values, 99))}


def summarise(log: str | Path | RunLog, *, wall_s: float | None) -> dict[str, Any]:
    """The summary of a run; metrics that the log does not determine are None.

    `missing` says why they are; the figures of an invalid run stay, and `outcome` says what they
    are worth.

    Args:
        log: a log or its file.
        wall_s: wall time that the run took, s; None where nobody knows.

    Raises:
        LogError: the file cannot be read.
    """
    log = log if isinstance(log, RunLog) else RunLog.open(log)
    log.load([topic for topic in LOADED if log.has(topic)])
    check = check_log(log)
    run, figures = Analysis(log), Figures(log)
    outcome = judge(log, check, run)
    duration = figures.of("sim_duration_s", lambda: _span(run))
    end = figures.of("end", lambda: _end(log))
    summary = {
        "scenario": figures.of("scenario", lambda: _about(log, "scenario")),
        "seed": figures.of("seed", lambda: _seed(log)),
        "outcome": outcome.word,
        "reasons": list(outcome.reasons),
        "completed": outcome.completed,
        "judged_by": judged_by(log),
        "goal": None if end is None else end.goal,
        "sim_duration_s": duration,
        "wall_s": wall_s,
        "real_time_factor": figures.of("real_time_factor", lambda: _factor(duration, wall_s)),
        "lockstep_timeouts": figures.of("lockstep_timeouts", lambda: run.lockstep_timeouts),
    }
    summary |= _precision(run, figures) | _effort(run, figures)
    summary["energy"] = figures.of("energy", lambda: energy(run), dict.fromkeys(ENERGY))
    summary["battery"] = figures.of("battery", lambda: battery(run), dict.fromkeys(BATTERY))
    summary["goals"] = figures.of("goals", lambda: goals_of(run), [])
    summary["clearance_m"] = figures.of(
        "clearance_m", lambda: least_clearances(run), {**NOTHING, "planned": NOTHING}
    )
    summary["stability"] = figures.of(
        "stability", lambda: stability(run, at_end), dict.fromkeys(NAMES)
    )
    summary["log_fault"] = log.fault or None
    summary["rejected_messages"] = {name: len(items) for name, items in log.rejected.items()}
    summary["incidents"] = [] if end is None else list(end.incidents)
    summary["node_counters"] = figures.of("node_counters", lambda: node_counters(log))
    summary["thruster_faults"] = figures.of("thruster_faults", lambda: thruster_faults(log), {})
    summary["errors_first_s"] = figures.of("errors_first_s", lambda: errors_first_s(log), {})
    summary["vehicle_warnings"] = figures.of(
        "vehicle_warnings", lambda: list(map(str, vehicle_warnings(log.vehicle)))
    )
    summary["plant"] = figures.of("plant", lambda: plant_record.read(log))
    summary["events"] = figures.of("events", lambda: list(events_of(log)))
    summary["events_not_reached"] = figures.of(
        "events_not_reached", lambda: not_reached(log, duration or 0.0)
    )
    summary["check"] = check.summary()
    summary["missing"] = figures.missing
    return summary


class Figures:
    """Works figures out one by one; where the log does not determine one, it keeps the reason."""

    def __init__(self, log: RunLog) -> None:
        self._prefix = f"log {log.path}: "
        self.missing: dict[str, str] = {}

    def of(self, name: str, work: Callable[[], Any], otherwise: Any = None) -> Any:
        """What `work` gives, or `otherwise`."""
        try:
            return determine(work)
        except LogError as fault:
            self.missing[name] = str(fault).removeprefix(self._prefix)
        return otherwise


def _span(run: Analysis) -> float:
    return float(run.truth.time[-1] - run.truth.time[0])


def _factor(duration: float | None, wall_s: float | None) -> float:
    """Simulated by wall time."""
    if not wall_s or duration is None:
        raise LogError("the duration or the wall time is not known")
    return duration / wall_s


def _end(log: RunLog) -> RunEnd:
    if log.end is None:
        raise LogError(f"log {log.path}: has no record of the run's end")
    return log.end


def _about(log: RunLog, key: str) -> str:
    """What the log says about the run."""
    if key not in log.run:
        raise LogError(f"log {log.path}: has no record of the run's {key}")
    return log.run[key]


def _seed(log: RunLog) -> int:
    seed = _about(log, "seed")
    try:
        return int(seed)
    except ValueError:
        raise LogError(f"log {log.path}: the seed {seed!r} is not a number") from None


def _precision(run: Analysis, figures: Figures) -> dict[str, Any]:
    def spread(name: str, work: Callable[[], Array]) -> Metrics:
        nothing = {"rms": None, "max": None, "end": None}
        return figures.of(name, lambda: of(work()), nothing)

    def of(values: Array) -> Metrics:
        return rms_and_max(values) | at_end(values, run.truth.time)

    return {
        "end_effector_error_m": spread("end_effector_error_m", lambda: run.end_effector_error),
        "end_effector_target": figures.of("end_effector_target", lambda: run.target.kind),
        "end_effector_tracking_error_m": spread(
            "end_effector_tracking_error_m", lambda: run.tracking_error
        ),
        "vehicle_error_m": spread("vehicle_error_m", lambda: run.vehicle_error[1]),
        "navigation_error_m": spread("navigation_error_m", lambda: run.navigation[1]),
        "roll_deg": spread("roll_deg", lambda: run.rpy_deg[:, 0]),
        "pitch_deg": spread("pitch_deg", lambda: run.rpy_deg[:, 1]),
    }


def _effort(run: Analysis, figures: Figures) -> dict[str, Any]:
    nothing = {"force_rms_n": None, "moment_rms_nm": None}
    return {
        "self_disturbance": figures.of("self_disturbance", lambda: self_disturbance(run), nothing),
        "planned_disturbance_error": figures.of(
            "planned_disturbance_error",
            lambda: force_and_moment(run.planned_disturbance_error[1]),
            nothing,
        ),
        "planner_step_ms": figures.of(
            "planner_step_ms", lambda: percentiles(run.planner_step_ms), {"p50": None, "p99": None}
        ),
        "least_manipulability": figures.of(
            "least_manipulability", lambda: run.least_manipulability
        ),
        "thruster_saturated_fraction": figures.of(
            "thruster_saturated_fraction",
            # Share of the control ticks in which some thruster is at its limit.
            lambda: float(np.mean(run.allocation.saturated.any(axis=1))),
        ),
        "thrust_rms_n": figures.of(
            "thrust_rms_n", lambda: float(np.sqrt(np.mean(run.allocation.thrust**2)))
        ),
    }


def self_disturbance(run: Analysis) -> Metrics:
    """True restoring plus coupling wrench, eq. (16), root mean square of its length.

    The first sample is left out: no joint torque is applied yet, and the arm starts to fall under
    its own weight, which neither planner nor controller can influence.
    """
    return force_and_moment((run.disturbance.restoring + run.disturbance.coupling)[1:])


def force_and_moment(wrenches: Array) -> Metrics:
    """Root mean square of the lengths of the forces and of the moments of wrenches (k, 6)."""
    return {
        "force_rms_n": rms_and_max(wrenches[:, :3])["rms"],
        "moment_rms_nm": rms_and_max(wrenches[:, 3:])["rms"],
    }
