"""The limits within which a run must stay to count as completed; docs/logs.md explains them."""

import numpy as np
from numpy.typing import NDArray

from uvms_analysis.analysis import Analysis, at_common_stamps
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_core.signals import Array

ATTITUDE_DEG = 30.0
"""Roll or pitch beyond which a controlled vehicle counts as lost. The planner lets it take up 5
degrees, its law saturates at 9 (`control.vehicle.error_scale`), and the worst that it still comes
back from in the scenarios, without the observer, is 15."""

SATURATED_SHARE = 0.5
SATURATED_S = 30.0
"""Some thruster at its limit in more than this share of the ticks, or for so long without a break:
the vehicle then goes where the water takes it, since its thrusters change direction within 2 s."""

NEAR_M = 0.2
"""Distance of the end effector from where it should be, at which it still counts as near, in
addition to three standard deviations of the navigation filter's own position. Following a path
takes 0.03 m in still water; at 0.2 m nothing can be gripped."""

NEAR_DEG = 10.0
"""The same for the joints, where they are the task or the vehicle is not controlled: a joint that
works is within 0.1 degrees, one that is stuck or limp is off by tens."""

NEAR_SHARE = 0.5
"""Share of the time for which the end effector, or the joints, must be near."""


def is_controlled(log: RunLog) -> bool:
    """Whether the vehicle's controller was on."""
    try:
        return bool(log.configuration()["control"]["enabled"])
    except (LogError, KeyError, TypeError):
        return True


def goal_end_s(run: Analysis) -> float:
    """When the run's goal would have ended, s; 0 where it does not say how long it takes."""
    try:
        if run.path is not None:
            return run.path_start_s + float(run.path.times[-1])
        return float(run.log.configuration()["goal"]["joints"]["times_s"][-1])
    except (LogError, KeyError, TypeError, IndexError, ValueError):
        return 0.0


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
    if share <= SATURATED_SHARE and longest <= SATURATED_S:
        return ""
    return (
        f"thrusters at their limits in {share:.0%} of the ticks, for up to {longest:.1f} s without"
        f" a break (bounds {SATURATED_SHARE:.0%}, {SATURATED_S:g} s)"
    )


def _longest(flags: NDArray[np.bool_], time: Array) -> float:
    """Time of the longest stretch of flags without a break, s."""
    longest, begin = 0.0, None
    for flag, now in zip(flags, time, strict=True):
        begin = (now if begin is None else begin) if flag else None
        longest = longest if begin is None else max(longest, float(now - begin))
    return longest


def end_effector(run: Analysis) -> str:
    """Why the end effector was not where it should be; empty where it was.

    A motion of the joints is its own target: there the joints count as well.
    """
    if run.target.kind == "reference" and not arm(run):
        return ""
    if not len(run.end_effector_error):
        return ""
    error = np.linalg.norm(run.end_effector_error, axis=1)
    allowed = NEAR_M + 3.0 * _navigation_sigma(run)[: len(error)]
    share = float(np.mean(error <= allowed))
    if share >= NEAR_SHARE:
        return ""
    return (
        f"the end effector was within {NEAR_M:g} m of its {run.target.kind} for {share:.0%} of the"
        f" time (bound {NEAR_SHARE:.0%}); its median error is {np.median(error):.3f} m"
    )


def _navigation_sigma(run: Analysis) -> Array:
    """The filter's own standard deviation of the position, (k,) m, where there is a target."""
    try:
        time, _, sigma = run.navigation
    except LogError:
        return np.zeros(len(run.target.index))
    now = run.truth.time[run.target.index]
    return np.interp(now, time, np.linalg.norm(sigma, axis=1))


def arm(run: Analysis) -> str:
    """Why the joints were not where the plan wants them; empty where they were."""
    plan = run.planned
    if plan is None or not len(plan):
        return ""
    joints, _ = at_common_stamps(run.joints, run.truth)
    inside = (joints.time >= plan.time[0]) & (joints.time <= plan.time[-1])
    if not inside.any():
        return ""
    wanted = [np.interp(joints.time[inside], plan.time, column) for column in plan.q.T]
    error = np.rad2deg(np.abs(joints.position[inside] - np.column_stack(wanted)).max(axis=1))
    share = float(np.mean(error <= NEAR_DEG))
    if share >= NEAR_SHARE:
        return ""
    return (
        f"the joints were within {NEAR_DEG:g} deg of their plan for {share:.0%} of the time"
        f" (bound {NEAR_SHARE:.0%}); the median error is {np.median(error):.1f} deg"
    )
