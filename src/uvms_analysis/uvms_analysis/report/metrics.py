"""The figures that the report shows, question by question: name, unit, limit, what is better."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from uvms_analysis import limits
from uvms_core.checks import ATTITUDE_DEG

Better = Literal["low", "high", ""]


@dataclass(frozen=True)
class Metric:
    """One figure.

    `limit` is in the shown unit, and `of_limit` says what it bounds; the value against it is shown
    as a bar. `better` says which of several runs is best; empty: neither is.
    """

    key: str
    name: str
    unit: str
    scale: float = 1.0
    limit: float | None = None
    rule: str = ""
    better: Better = "low"

    def value(self, values: Mapping[str, Any]) -> float | None:
        """The figure in the shown unit; None where it is missing."""
        found = values.get(self.key)
        if isinstance(found, bool) or not isinstance(found, int | float):
            return None
        return self.scale * float(found)


_MM, _PERCENT = 1e3, 100.0
_ASTRAY = (
    f"for {limits.NEAR_SHARE:.0%} of the time at least, and farther off for"
    f" {limits.ASTRAY_S:g} s at most; navigation's own 3 σ are allowed for"
)

HOW_WELL = (
    Metric(
        "end_effector_tracking_error_m.rms", "tool off its target, seen by the loop", "mm rms", _MM
    ),
    Metric(
        "end_effector_tracking_error_m.max",
        "tool off its target, seen by the loop, greatest",
        "mm",
        _MM,
    ),
    Metric("end_effector_error_m.rms", "tool off its target, true", "mm rms", _MM),
    Metric(
        "end_effector_error_m.max",
        "tool off its target, true, greatest",
        "mm",
        _MM,
        _MM * limits.END_EFFECTOR.near,
        f"within {_ASTRAY}",
    ),
    Metric("vehicle_error_m.rms", "vehicle off its reference, true", "mm rms", _MM),
    Metric(
        "vehicle_error_m.max",
        "vehicle off its reference, true, greatest",
        "mm",
        _MM,
        _MM * limits.VEHICLE.near,
        f"within {_ASTRAY}",
    ),
    Metric("joint_error_deg.rms", "worst joint off its plan, true", "deg rms"),
    Metric(
        "joint_error_deg.max",
        "worst joint off its plan, true, greatest",
        "deg",
        1.0,
        limits.JOINTS.near,
        f"within for {limits.NEAR_SHARE:.0%} of the time at least; judged where the joints are"
        " the goal",
    ),
    Metric("navigation_error_m.rms", "position estimate off the truth", "mm rms", _MM),
    Metric("navigation_error_m.max", "position estimate off the truth, greatest", "mm", _MM),
    Metric("roll_deg.rms", "roll", "deg rms"),
    Metric("roll_deg.max", "roll, greatest", "deg", 1.0, ATTITUDE_DEG, "at any time"),
    Metric("pitch_deg.rms", "pitch", "deg rms"),
    Metric("pitch_deg.max", "pitch, greatest", "deg", 1.0, ATTITUDE_DEG, "at any time"),
    Metric("yaw_error_deg.rms", "heading estimate off the truth", "deg rms"),
    Metric("clearance_m.min", "least clearance", "mm", _MM, None, "", "high"),
)

DISTURBED = (
    Metric("self_disturbance.force_rms_n", "self-disturbance, force", "N rms"),
    Metric("self_disturbance.moment_rms_nm", "self-disturbance, moment", "N m rms"),
    Metric(
        "planned_disturbance_error.force_rms_n",
        "self-disturbance, true less planned, force",
        "N rms",
    ),
    Metric(
        "planned_disturbance_error.moment_rms_nm",
        "self-disturbance, true less planned, moment",
        "N m rms",
    ),
    Metric("external.force_rms_n", "external force, true", "N rms", better=""),
    Metric("external.force_max_n", "external force, true, greatest", "N", better=""),
    Metric("external.moment_rms_nm", "external moment, true", "N m rms", better=""),
    Metric("external_observed.force_rms_n", "external force, observed", "N rms", better=""),
    Metric("external_observed.moment_rms_nm", "external moment, observed", "N m rms", better=""),
)

COST = (
    Metric("thrust_rms_n", "thrust of a thruster", "N rms"),
    Metric("thrust_total_n", "all thrust, added up, mean", "N"),
    Metric("impulse_ns", "all thrust over the run", "N s"),
    Metric("authority_left", "least left to the busiest thruster", "%", _PERCENT, better="high"),
    Metric(
        "thruster_saturated_fraction",
        "ticks with a thruster at its limit",
        "%",
        _PERCENT,
        _PERCENT * limits.SATURATED_SHARE,
        f"and {limits.SATURATED_S:g} s at most without a break",
    ),
    Metric("thruster_work_j", "mechanical work of the thrusters on the vehicle", "J"),
    Metric(
        "torque_share",
        "greatest torque of a joint over its limit",
        "%",
        _PERCENT,
        _PERCENT,
        "the drive's",
    ),
    Metric("arm_work_j", "mechanical work of the joints", "J"),
    Metric("energy.total_wh", "electrical energy", "Wh"),
    Metric("energy.propulsion_wh", "electrical energy of the thrusters", "Wh"),
    Metric("energy.arm_wh", "electrical energy of the joints' drives", "Wh"),
    Metric("energy.hotel_wh", "electrical energy of the hotel load", "Wh", better=""),
    Metric("energy.power_mean_w", "electrical power, mean", "W"),
    Metric("energy.power_max_w", "electrical power, greatest", "W"),
    Metric("battery.used", "share of the battery that was used", "%", _PERCENT),
    Metric("battery.left", "share of the battery that is left", "%", _PERCENT, better="high"),
    Metric("battery.lasts_h", "how long a full battery lasts at this rate", "h", better="high"),
)

HEALTH = (
    Metric(
        "navigation_within",
        "position error within the filter's 3 σ, all axes",
        "%",
        _PERCENT,
        better="high",
    ),
    Metric(
        "navigation_nees",
        "squared position error over its covariance, per axis; 1 is right",
        "",
        better="",
    ),
    Metric("planner_step_ms.p50", "planner's step, median", "ms"),
    Metric("planner_step_ms.p99", "planner's step, 99th percentile", "ms"),
    Metric("lockstep_timeouts", "ticks that the plant did not wait for", "ticks"),
    Metric("command_age_s", "oldest command that the plant used", "ms", _MM),
    Metric("safe_ticks", "ticks without a usable command (the first one has none)", "ticks"),
    Metric("real_time_factor", "simulated by wall time", "×", better="high"),
)

STABLE = (
    Metric(
        "stability.condition_holds",
        "ticks in which the condition below (29) holds",
        "%",
        _PERCENT,
        better="high",
    ),
    Metric(
        "stability.lyapunov_falls",
        "ticks in which V does not grow, by the model",
        "%",
        _PERCENT,
        better="high",
    ),
    Metric("stability.lyapunov_rms", "V", "m²/s², rad²/s², rms"),
    Metric("stability.lyapunov_max", "V, greatest", "m²/s², rad²/s²"),
    Metric("stability.lyapunov_end", "V at the end, greatest of 5 s", "m²/s², rad²/s²"),
)

CARDS = (
    ("end_effector_tracking_error_m.rms", "end_effector_tracking_error_m.max"),
    ("end_effector_error_m.rms", "end_effector_error_m.max"),
    ("navigation_error_m.rms", "navigation_error_m.max"),
    ("roll_deg.rms", "roll_deg.max"),
    ("pitch_deg.rms", "pitch_deg.max"),
    ("self_disturbance.moment_rms_nm", "self_disturbance.force_rms_n"),
    ("authority_left", "thruster_saturated_fraction"),
    ("clearance_m.min", None),
)
"""Of the head of the page: a figure, and a second one below it."""

ALL = (*HOW_WELL, *DISTURBED, *COST, *HEALTH, *STABLE)
BY_KEY = {metric.key: metric for metric in ALL}
