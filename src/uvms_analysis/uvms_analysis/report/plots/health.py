"""Plots of how healthy the system was: navigation, sensors, thrusters, computing, commands."""

from functools import partial

import numpy as np

from uvms_analysis import effort
from uvms_analysis.analysis import Analysis
from uvms_analysis.errors import LogError
from uvms_analysis.navigation_check import attitude_error_deg, normalized_error
from uvms_analysis.report.plot import Curve, Limit, Panel, Part, panel, panels
from uvms_analysis.report.plots.attitude import ANGLES
from uvms_analysis.report.plots.tracking import AXES
from uvms_analysis.report.run import ReportedRun
from uvms_core import topics
from uvms_core.signals import to_seconds

LEVEL = "_level"
"""End of the names under which navigation reports the level of a sensor's residuals."""


def navigation(run: ReportedRun) -> list[Panel]:
    """Estimate less truth, with three of the filter's own standard deviations; attitude too."""

    def error(axis: int) -> Curve:
        time, errors, _ = run.truth.navigation
        return time, 1e3 * errors[:, axis]

    def edge(axis: int, sign: float) -> Curve:
        time, _, sigma = run.truth.navigation
        return time, sign * 3e3 * sigma[:, axis]

    def angle(axis: int) -> Curve:
        time, errors = attitude_error_deg(run.truth)
        return time, errors[:, axis]

    positions = [
        partial(panel, f"navigation_{name}", f"navigation error, {name}", "mm",
                [Part("estimated less true", partial(error, axis)),
                 Part("± 3 σ of the filter", partial(edge, axis, 1.0), "high"),
                 Part("± 3 σ of the filter", partial(edge, axis, -1.0), "low")], least=1.0)
        for axis, name in enumerate(AXES)
    ]  # fmt: skip
    angles = [
        partial(panel, f"navigation_{name}", f"navigation error, {name}", "deg",
                [Part("estimated less true", partial(angle, axis))], least=0.01)
        for axis, name in enumerate(ANGLES)
    ]  # fmt: skip
    return panels([*positions, *angles])


def consistency(run: ReportedRun) -> list[Panel]:
    """Whether the filter is as good as it says: its own deviation, error against it, residuals."""

    def deviation() -> Curve:
        seen = run.seen.estimate
        variance = np.trace(seen.pose_covariance[:, :3, :3], axis1=1, axis2=2)
        return seen.time, 1e3 * np.sqrt(np.maximum(variance, 0.0))

    found = [
        partial(panel, "navigation_sigma", "standard deviation of the position, by the filter",
                "mm", [Part("σ", deviation)], least=1.0),
        partial(panel, "navigation_nees", "squared position error over its covariance, per axis",
                "", [Part("NEES / 3", lambda: normalized_error(run.truth))],
                [Limit("expected", 1.0)], least=2.0),
        partial(_levels, run),
    ]  # fmt: skip
    return panels(found)


def _levels(run: ReportedRun) -> Panel:
    """Level of each sensor's residuals over time (mean NIS per dimension)."""
    statuses = run.log.statuses(topics.NAVIGATION)
    sensors = {key.removesuffix(LEVEL): None for one in statuses for key in one.values
               if key.endswith(LEVEL)}  # fmt: skip
    if len(statuses) < 2 or not sensors:
        raise LogError(
            "the residuals (NIS) over time are not in the log: navigation reports them once a"
            " second on a graph, and at the end of a run in process"
        )
    time = np.array([to_seconds(one.stamp) for one in statuses])

    def level(sensor: str) -> Curve:
        return time, np.array([one.number(sensor + LEVEL) for one in statuses])

    parts = [Part(sensor, partial(level, sensor)) for sensor in sensors]
    return panel("navigation_nis", "residuals of the sensors, NIS per dimension", "", parts,
                 [Limit("expected", 1.0)], least=1.0)  # fmt: skip


def thruster_health(run: ReportedRun) -> list[Panel]:
    """The share of its command that each thruster is taken to give."""
    shares = run.truth.allocation
    names = run.log.vehicle.thruster_names
    if shares.effectiveness.shape[1:] != (len(names),):
        raise LogError("the log does not say how much of its command each thruster gives")

    def share(index: int) -> Curve:
        return shares.time, 100.0 * shares.effectiveness[:, index]

    parts = [Part(name, partial(share, index)) for index, name in enumerate(names)]
    return [panel("effectiveness", "share of its command that each thruster is taken to give",
                  "%", parts, [Limit("whole", 100.0)], least=10.0)]  # fmt: skip


def computing(run: ReportedRun) -> list[Panel]:
    """Computing time of the planner's steps, and the age of the commands that the plant used."""

    def age() -> Curve:
        time, ages = effort.command_age(run.truth)
        return time, 1e3 * ages

    return panels([
        partial(panel, "planner_step", "computing time of a planner's step", "ms",
                [Part("step", lambda: _steps(run.truth))], least=1.0, peaks=True),
        partial(panel, "command_age", "age of the command in use", "ms", [Part("age", age)],
                least=10.0),
    ])  # fmt: skip


def _steps(run: Analysis) -> Curve:
    statuses = run.log.statuses(topics.MOTION_PLANNER)
    told = [(to_seconds(one.stamp), one.number("step_ms")) for one in statuses]
    found = np.array([pair for pair in told if np.isfinite(pair[1])])
    if not len(found):
        raise LogError("the planner does not report how long its steps take")
    return found[:, 0], found[:, 1]
