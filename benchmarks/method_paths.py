"""Whole short paths by each planner method: self-disturbance, limits and tool error at 1 kHz."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from planning import self_disturbances

from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.signals import Array, JointStates, Odometry, Reference, to_nanoseconds, to_seconds
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import rpy_to_quat
from uvms_planner import GoalRejected, MotionPlanner, PathSpec, PlannerConfig

START = np.concatenate([[0.0, 0.0, 10.0, 0.0], np.deg2rad([0.0, 10.0, 115.0, 0.0])])
PATHS = {
    "paper": PathSpec.model_validate(
        {
            "phases": [
                {"duration_s": 20.0, "to_m": (0.0, 0.0, 0.35)},
                {"duration_s": 20.0, "to_m": (0.0, 0.0, 0.15), "bulge_m": (0.1, 0.0, 0.0)},
                {"duration_s": 20.0, "to_m": (0.0, 0.0, 0.0), "bulge_m": (0.0, 0.1, 0.0)},
            ]
        }
    ),
    "circle": PathSpec.model_validate(
        {"circle": {"radius_m": 0.3, "plane": "XOZ", "turns": 1.0, "period_s": 60.0}}
    ),
    "line": PathSpec.model_validate({"line": {"to_m": (3.0, 0.0, 0.0), "duration_s": 120.0}}),
}
"""The path of Fig. 9 in 60 instead of 900 s, a circle, and 3 m straight ahead."""
SAMPLE_S = 1e-3


@dataclass(frozen=True)
class Followed:
    """A whole path by one method."""

    finished: bool
    disturbance: float  # J = integral of |restoring|^2 + |coupling|^2, N^2 s with moments in N m
    worst_ratio: float  # greatest rate or acceleration of any variable over its planned limit
    tool_error: float  # m, greatest distance of the tool from the path
    steps_beyond: int  # steps that were planned beyond the accelerations


def config_of(method: str, *, strict: bool = True, **sections: Any) -> PlannerConfig:
    """The default planner with `method`."""
    return PlannerConfig(method=method, limits={"strict": strict}, **sections)


def follow(method: str, spec: PathSpec, **sections: Any) -> Followed | None:
    """Plan the whole path, beyond the accelerations where the method cannot do without.

    None where the planner rejects the goal, since the method cannot follow the path at all.
    """
    config = config_of(method, strict=False, sample_s=SAMPLE_S, **sections)
    planner = MotionPlanner(load_vehicle(), config, 1)
    references, result, index, path, begin = [], None, 0, None, 0.0
    while result is None:
        step = planner.step(*_inputs(to_nanoseconds(index * config.step_s)))
        references += step.references
        result = step.finished
        if index == 0:
            goal = spec.goal(*planner.end_effector)
            path, begin = EndEffectorPath(goal), to_seconds(references[-1].end)
            try:
                planner.accept(goal)
            except GoalRejected:
                return None
        index += 1
    moving = [r for r in references if begin <= to_seconds(r.stamp) < begin + path.duration]
    return Followed(
        finished=result.success,
        disturbance=SAMPLE_S * float(np.sum(self_disturbances(moving) ** 2)),
        worst_ratio=_worst_ratio(moving, planner),
        tool_error=max(_tool_error(r, path, begin) for r in moving),
        steps_beyond=planner._solver.steps_beyond_limits,
    )


def _inputs(stamp: int) -> tuple[int, Odometry, JointStates]:
    """Odometry and joints that stay at the start: the planner continues from its own plan."""
    odometry = Odometry(
        stamp, START[:3].copy(), rpy_to_quat(0.0, 0.0, 0.0), np.zeros(6), np.zeros((6, 6)),
        np.zeros((6, 6)),
    )  # fmt: skip
    still = np.zeros(len(START) - 4)
    return stamp, odometry, JointStates(stamp, START[4:].copy(), still, still.copy())


def _worst_ratio(references: list[Reference], planner: MotionPlanner) -> float:
    limits, step = planner._solver.limits, planner._config.step_s
    worst = 0.0
    for r in references:
        rate, acceleration = world_motion(r)
        worst = max(worst, float(np.max(np.abs(rate) * step / limits.reach)))
        worst = max(worst, float(np.max(np.abs(acceleration) * step**2 / limits.jump)))
    return worst


def world_motion(r: Reference) -> tuple[Array, Array]:
    """Rate and acceleration (k, m) of c: p_dot = R nu, p_ddot = R (nu_dot + omega x nu)."""
    yaw = 2.0 * np.arctan2(r.quaternion[:, 2], r.quaternion[:, 3])
    cos, sin = np.cos(yaw), np.sin(yaw)
    u, v, turn = r.nu[:, 0], r.nu[:, 1], r.nu[:, 5]
    along, across = r.nu_dot[:, 0] - turn * v, r.nu_dot[:, 1] + turn * u
    rate = np.column_stack([cos * u - sin * v, sin * u + cos * v, r.nu[:, 2], turn, r.q_dot])
    acceleration = np.column_stack(
        [
            cos * along - sin * across,
            sin * along + cos * across,
            r.nu_dot[:, 2],
            r.nu_dot[:, 5],
            r.q_ddot,
        ]
    )
    return rate, acceleration


def _tool_error(r: Reference, path: EndEffectorPath, begin: float) -> float:
    wanted = path.positions(to_seconds(r.stamp) + r.times - begin)
    return float(np.max(np.linalg.norm(r.end_effector - wanted, axis=1)))
