"""The limits within which a run must stay to count as completed; docs/logs.md explains them."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uvms_analysis.analysis import Analysis
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_core.checks import ATTITUDE_DEG
from uvms_core.signals import Array

SATURATED_SHARE = 0.5
SATURATED_S = 30.0
"""Some thruster at its limit in more than this share of the ticks, or for so long without a break:
the vehicle then goes where the water takes it, since its thrusters turn round within 0.5 s."""
SATURATED_LEAST_S = 2.0
"""The share counts from so much time at a limit on: of a run of two seconds more than half may be
the beginning of a motion."""

NEAR_SHARE = 0.5
"""Share of the time for which whatever has a place must be near it."""

ASTRAY_S = 10.0
"""It may be astray for so long without a break, s: a disturbance that comes and goes. In the
scenarios that come with the project nothing is ever astray."""

FINAL_S = 5.0
"""At the end it must be there: astray in less than half of the last seconds, s."""

SIGMA_CAP_M = 0.3
"""Three standard deviations of the navigation filter's own position are allowed for, up to here: a
filter that has lost its way excuses nothing. In the scenarios they are 0.06 to 0.17 m."""


@dataclass(frozen=True)
class Band:
    """How far off something may be: near its place, and astray; both in `unit`."""

    near: float
    astray: float
    unit: str


END_EFFECTOR = Band(0.2, 0.2, "m")
"""Following a path takes 0.03 m in still water; at 0.2 m nothing can be gripped."""

VEHICLE = Band(0.5, 0.5, "m")
"""Looser, since the arm makes up for the vehicle: it keeps to 0.06 m of its reference."""

JOINTS = Band(10.0, 20.0, "deg")
"""A joint that works is within 2 degrees, and one that is stuck or limp is off by tens. Astray is
looser: a small arm's shoulder creeps up to 16 degrees off for 11 s before its law moves it."""


def is_controlled(log: RunLog) -> bool:
    """Whether the vehicle's controller was on."""
    try:
        return bool(log.configuration()["control"]["enabled"])
    except (LogError, KeyError, TypeError):
        return True


def goal_end_s(run: Analysis) -> float:
    """When the run's goal would have ended, s; 0 where it does not say how long it takes.

    Of several goals in turn: the least time that they take.
    """
    try:
        if several := run.log.configuration().get("goals"):
            return sum(map(_least_s, several))
        if run.path is not None:
            return run.path_start_s + float(run.path.times[-1])
        goal = run.log.configuration()["goal"]
        if goal.get("pose"):
            way = goal["pose"]["duration_s"]  # none: as the limits allow
            return 0.0 if way is None else float(way + goal["pose"]["hold_s"])
        return float(goal["joints"]["times_s"][-1])
    except (LogError, KeyError, TypeError, IndexError, ValueError):
        return 0.0


def _least_s(goal: Mapping[str, Any]) -> float:
    """How long a goal of a list takes at least, s: what it says itself."""
    if pose := goal.get("pose"):
        return float((pose.get("duration_s") or 0.0) + pose["hold_s"])
    if joints := goal.get("joints"):
        return float(joints["times_s"][-1])
    phases = (goal.get("path") or {}).get("phases") or ()
    return float(sum(phase["duration_s"] for phase in phases))


def attitude(run: Analysis) -> str:
    """Why the attitude is not within its limit; empty where it is.

    A run may begin beyond it: it counts from where the vehicle has first come within.
    """
    tilt = np.abs(run.rpy_deg[:, :2]).max(axis=1)
    within = np.flatnonzero(tilt <= ATTITUDE_DEG)
    if not len(within):
        return f"roll or pitch never came below {ATTITUDE_DEG:g} deg; least {tilt.min():.1f} deg"
    after = tilt[within[0] :]
    beyond = np.flatnonzero(after > ATTITUDE_DEG)
    if not len(beyond):
        return ""
    at = run.truth.time[within[0] + beyond[0]]
    return (
        f"roll or pitch beyond {ATTITUDE_DEG:g} deg from {at:.2f} s on, up to {after.max():.1f} deg"
    )


def saturation(run: Analysis) -> str:
    """Why thrusters were at their limits for too long; empty where they were not."""
    saturated: NDArray[np.bool_] = np.any(run.allocation.saturated, axis=1)
    share = float(np.mean(saturated))
    longest = _longest(saturated, run.allocation.time)
    time = run.allocation.time
    spent = share * float(time[-1] - time[0])
    if (share <= SATURATED_SHARE or spent < SATURATED_LEAST_S) and longest <= SATURATED_S:
        return ""
    return (
        f"thrusters at their limits in {share:.0%} of the ticks, for up to {longest:.1f} s without"
        f" a break (bounds {SATURATED_SHARE:.0%}, {SATURATED_S:g} s)"
    )


def _longest(flags: NDArray[np.bool_], time: Array) -> float:
    """Time of the longest stretch of flags without a break, s."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    begins, ends = edges[::2], edges[1::2] - 1
    return float(np.max(time[ends] - time[begins], initial=0.0))


def end_effector(run: Analysis) -> str:
    """Why the end effector was not where it should be; empty where it was.

    A motion of the joints is its own target: there the joints and the vehicle count instead.
    """
    if run.target.kind == "reference" and not arm(run):
        return ""
    if not len(run.target.index):
        return ""
    error = np.linalg.norm(run.end_effector_error, axis=1)
    time = run.truth.time[run.target.index]
    what = f"the end effector was within {END_EFFECTOR.near:g} m of its {run.target.kind}"
    return _kept(what, time, error - _allowance(run, time), END_EFFECTOR, error)


def vehicle(run: Analysis) -> str:
    """Why the vehicle was not where its reference wants it; empty where it was."""
    if run.planned is None:
        return ""
    time, offset = run.vehicle_error
    if not len(time):
        return ""
    error = np.linalg.norm(offset, axis=1)
    what = f"the vehicle was within {VEHICLE.near:g} m of its reference"
    return _kept(what, time, error - _allowance(run, time), VEHICLE, error)


def _allowance(run: Analysis, time: Array) -> Array:
    """What the filter itself cannot know about the position at these times (k,), (k,) m."""
    try:
        known, _, sigma = run.navigation
    except LogError:
        return np.zeros(len(time))
    three = 3.0 * np.linalg.norm(sigma, axis=1)
    return np.minimum(np.interp(time, known, three), SIGMA_CAP_M)


def arm(run: Analysis) -> str:
    """Why the joints were not where the plan wants them; empty where they were."""
    plan = run.planned
    if plan is None or not len(plan):
        return ""
    time, errors = run.joint_error_deg
    if not len(time):
        return ""
    error = np.abs(errors).max(axis=1)
    what = f"the joints were within {JOINTS.near:g} deg of their plan"
    return _kept(what, time, error, JOINTS, error)


def _kept(what: str, time: Array, beyond: Array, band: Band, error: Array) -> str:
    """Why something was not where it should be: mostly near, never astray for long, there at last.

    Args:
        what: it was and should have been, in words.
        time: (k,) s.
        beyond: error (k,) less what is allowed for; judged against the band.
        error: (k,) as it is told.
    """
    near, astray = float(np.mean(beyond <= band.near)), ~(beyond <= band.astray)
    if near < NEAR_SHARE:
        return (
            f"{what} for {near:.0%} of the time (bound {NEAR_SHARE:.0%}); its median error is"
            f" {np.median(error):.3g} {band.unit}"
        )
    longest, last = _longest(astray, time), time > time[-1] - FINAL_S
    if longest > ASTRAY_S:
        return (
            f"{what} for {near:.0%} of the time, but more than {band.astray:g} {band.unit} off for"
            f" {longest:.1f} s without a break (bound {ASTRAY_S:g} s), by up to"
            f" {error.max():.3g} {band.unit}"
        )
    if np.mean(astray[last]) > 1.0 - NEAR_SHARE:
        return (
            f"{what} for {near:.0%} of the time, but more than {band.astray:g} {band.unit} off in"
            f" {np.mean(astray[last]):.0%} of the last {FINAL_S:g} s, by up to"
            f" {error[last].max():.3g} {band.unit}"
        )
    return ""
