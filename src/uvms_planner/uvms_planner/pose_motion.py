"""Going to a pose and holding it, with the joints as they are."""

import numpy as np

from uvms_core.checks import is_unit
from uvms_core.signals import Array, PoseGoal
from uvms_dynamics import inverse_dynamics
from uvms_dynamics.geometry import clearances_along
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_planner.errors import GoalRejected
from uvms_planner.problem import VEHICLE
from uvms_planner.segment import Samples
from uvms_planner.solver import MORE_TILT, StepSolver
from uvms_planner.straight_motion import Profile, StraightMotion, shares_of_limits

SLOWEST = 30.0  # times slower; beyond that the speed is not what takes the thrust
FINE_ENOUGH = 1.01  # ratio between a factor that is too fast and one that is not
TILT_SHARE = 0.5
"""Of the free attitude's limits, that a motion may take; the rest is for currents and overshoot."""
EACH_PHASE = 50  # instants of a phase at which its thrust is examined
EACH_PHASE_TILT = 10  # the same of the tilt, which takes longer
ROUNDING = 1e-9  # share of a limit
LEVEL = np.array([0.0, 0.0, 0.0, 1.0])


def check_pose_goal(goal: PoseGoal, configuration: Array, solver: StepSolver) -> Array:
    """The configuration (m,) that a goal leads to from `configuration` (m,), at rest.

    Raises GoalRejected where the goal is malformed, not level, or not within the depth.
    """
    position, quaternion = np.asarray(goal.position), np.asarray(goal.quaternion)
    _check_form(goal, position, quaternion)
    yaw = _yaw_if_level(quaternion, solver)
    _check_depth(position[2], configuration[2], solver)
    end = configuration.copy()
    end[:3] = position
    turn = yaw - configuration[3]
    end[3] += np.arctan2(np.sin(turn), np.cos(turn))  # the shorter way
    return end


def _check_form(goal: PoseGoal, position: Array, quaternion: Array) -> None:
    for name, values, count in (("position", position, 3), ("quaternion", quaternion, 4)):
        if values.shape != (count,):
            raise GoalRejected(f"pose: {name} has shape {values.shape}; needed is ({count},)")
        if not np.all(np.isfinite(values)):
            raise GoalRejected(f"pose: {name} = {values} is not finite")
    if not is_unit(float(quaternion @ quaternion)):
        raise GoalRejected(
            f"pose: quaternion has norm {np.linalg.norm(quaternion):.4g}, must be a unit quaternion"
        )
    for name in ("duration_s", "hold_s", "speed_max_m_s"):
        if not 0.0 <= getattr(goal, name) < np.inf:
            raise GoalRejected(f"pose: {name} is {getattr(goal, name):g}, must be >= 0 and finite")


def _yaw_if_level(quaternion: Array, solver: StepSolver) -> float:
    R = quat_to_matrix(quaternion.astype(float))
    tilt = float(np.arctan2(np.hypot(R[2, 0], R[2, 1]), R[2, 2]))
    allowed = max(solver.motion_limits.roll_max, solver.motion_limits.pitch_max)
    if tilt > allowed:
        raise GoalRejected(
            f"pose: it is tilted by {np.rad2deg(tilt):.4g} deg, allowed {np.rad2deg(allowed):.4g}"
            " deg: only the heading can be chosen"
        )
    return float(np.arctan2(R[1, 0], R[0, 0]))


def _check_depth(depth: float, present: float, solver: StepSolver) -> None:
    """What is beyond the depths of the limits already may stay or come back."""
    least = min(solver.motion_limits.lower[2], present)
    greatest = max(solver.motion_limits.upper[2], present)
    if depth < least:
        raise GoalRejected(
            f"pose: its depth is {depth:.4g} m, and the vehicle needs at least {least:.4g} m of"
            " water above its origin"
        )
    if depth > greatest:
        raise GoalRejected(f"pose: its depth is {depth:.4g} m, allowed {greatest:.4g} m")


def plan_pose(goal: PoseGoal, ends: tuple[Array, Array], solver: StepSolver) -> StraightMotion:
    """The motion between two configurations (m,) for a goal, beginning at the stamp 0.

    Raises GoalRejected where the goal's time or speed is beyond a limit, the thrusters cannot give
    what it takes, or the way is not clear.
    """
    allowed = allowed_between(ends, solver, goal.speed_max_m_s)
    wanted = goal.duration_s
    if not np.isfinite(allowed[0]):
        return StraightMotion(ends, None, 0, solver.config.step_s, wanted + goal.hold_s)
    fastest = Profile.fastest(*allowed)
    if wanted == 0.0:
        return plan_straight(ends, fastest, solver, goal.hold_s)
    if wanted < (1.0 - ROUNDING) * fastest.duration:
        raise GoalRejected(
            f"pose: {wanted:.4g} s are too short; within the limits of speed and acceleration the"
            f" way there takes {fastest.duration:.4g} s"
        )
    profile = Profile.lasting(wanted, *allowed)
    motion = plan_straight(ends, profile, solver, goal.hold_s)
    if motion.profile is not profile:
        lack, needed = lacking(motion.along(profile), solver), motion.duration - goal.hold_s
        raise GoalRejected(f"pose: {wanted:.4g} s are too short; {lack}; allow {needed:.4g} s")
    return motion


def allowed_between(
    ends: tuple[Array, Array], solver: StepSolver, speed_max: float = 0.0
) -> tuple[float, float]:
    """Rate (1/s) and acceleration (1/s^2) at which the limits allow the way between two
    configurations (m,), and `speed_max` m/s if not 0; infinite without a way.
    """
    way = ends[1] - ends[0]
    rate, acceleration = shares_of_limits(way, solver.motion_limits)
    distance = float(np.linalg.norm(way[:3]))
    if speed_max > 0.0 and distance > 0.0:
        rate = min(rate, speed_max / distance)
    return rate, acceleration


def plan_straight(
    ends: tuple[Array, Array], profile: Profile, solver: StepSolver, hold: float = 0.0
) -> StraightMotion:
    """The motion between two configurations (m,), slower than `profile` where thrust is lacking, or
    what keeps the vehicle level.

    Raises GoalRejected where the way is not clear, or it is lacking at any speed.
    """
    motion = StraightMotion(ends, profile, 0, solver.config.step_s, hold)
    check_clear(motion, solver)
    lack = lacking(motion, solver)
    if not lack:
        return motion
    fast, slow = 1.0, SLOWEST
    if lacking(motion.along(profile.slower(slow)), solver):
        raise GoalRejected(f"pose: {lack}, and too much however slowly it goes there")
    while slow > FINE_ENOUGH * fast:
        middle = float(np.sqrt(fast * slow))
        too_fast = lacking(motion.along(profile.slower(middle)), solver)
        fast, slow = (middle, slow) if too_fast else (fast, middle)
    return motion.along(profile.slower(slow))


def lacking(motion: StraightMotion, solver: StepSolver) -> str:
    """What a motion takes more of than a plan may take; empty where that is nothing."""
    return _thrust_lacking(motion, solver) or _tilt_beyond(motion, solver)


def _tilt_beyond(motion: StraightMotion, solver: StepSolver) -> str:
    """Where roll or pitch, which no thruster holds, would come to more than their share."""
    times, limits = _phases(motion, EACH_PHASE_TILT), solver.motion_limits
    tilt = np.abs(solver.tilt().along(solver.model, motion.sample(times)))
    bounds = TILT_SHARE * np.array([limits.roll_max, limits.pitch_max])
    allowed = np.maximum(bounds, MORE_TILT * tilt[0])
    k, axis = np.unravel_index(int(np.argmax(tilt / allowed)), tilt.shape)
    if tilt[k, axis] <= allowed[axis]:
        return ""
    name, angle = ("roll", "pitch")[axis], np.rad2deg(tilt[k, axis])
    become = f"{name} would become {angle:.3g} deg"
    if not np.isfinite(angle):
        become = f"nothing would hold {name} against the flow"
    return f"{become} at t = {times[k]:.4g} s, allowed {np.rad2deg(allowed[axis]):.3g} deg"


def _thrust_lacking(motion: StraightMotion, solver: StepSolver) -> str:
    """What a motion takes beyond what a plan may take of a thruster; empty where it is enough.

    Where more is needed at rest already, as much as that is allowed.
    """
    times = _phases(motion, EACH_PHASE)
    shares = np.abs(_wrenches(motion.sample(times), solver) @ solver.around.shares.T)
    allowed = np.maximum(1.0, shares[0]) * (1.0 + ROUNDING)
    excess = shares / allowed
    k, thruster = np.unravel_index(int(np.argmax(excess)), excess.shape)
    if excess[k, thruster] <= 1.0:
        return ""
    return (
        f"thruster {thruster + 1} would have to give {shares[k, thruster]:.3g} times what a plan"
        f" may take of it, at t = {times[k]:.4g} s"
    )


def _phases(motion: StraightMotion, each: int) -> Array:
    """Times (k,) s that show every phase: getting up to speed, going on, stopping."""
    profile = motion.profile
    if profile is None:
        return np.zeros(1)
    shares = np.linspace(0.0, 1.0, each)
    cruise = profile.duration - 2 * profile.ramp
    return np.concatenate(
        [
            shares * profile.ramp,
            profile.ramp + shares[1:-1] * cruise,
            profile.duration - (1.0 - shares) * profile.ramp,
        ]
    )


def _wrenches(samples: Samples, solver: StepSolver) -> Array:
    """Wrenches (k, 6) that a motion of vehicle and joints takes in still water."""
    out = np.empty((len(samples.configuration), 6))
    for i, (c, v, a) in enumerate(
        zip(samples.configuration, samples.rate, samples.acceleration, strict=True)
    ):
        cos, sin, turning = np.cos(c[3]), np.sin(c[3]), v[3]
        surge, sway = cos * v[0] + sin * v[1], cos * v[1] - sin * v[0]
        along, across = cos * a[0] + sin * a[1], cos * a[1] - sin * a[0]
        nu = np.array([surge, sway, v[2], 0.0, 0.0, turning])
        nu_dot = np.array([along + turning * sway, across - turning * surge, a[2], 0.0, 0.0, a[3]])
        out[i] = inverse_dynamics(
            solver.model, LEVEL, nu, nu_dot, *(part[VEHICLE:].copy() for part in (c, v, a))
        )[:6]
    return out


def check_clear(motion: StraightMotion, solver: StepSolver) -> None:
    """Raise GoalRejected where a motion comes too close to the seabed or an obstacle."""
    geometry = solver.geometry
    if not geometry.pairs:
        return
    way = 0.0 if motion.profile is None else motion.profile.duration
    times = np.linspace(0.0, way, 1 + int(np.ceil(way / solver.config.sample_s)))
    clear = clearances_along(geometry, motion.sample(times).configuration)
    margins = solver.around_from(motion.ends[0]).margins
    k, pair = np.unravel_index(int(np.argmin(clear - margins)), clear.shape)
    if clear[k, pair] < margins[pair]:
        raise GoalRejected(
            f"pose: the way there is not clear: {geometry.pairs[pair]} come within"
            f" {clear[k, pair]:.3g} m at t = {times[k]:.4g} s, allowed {margins[pair]:.3g} m"
        )
