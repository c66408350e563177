"""Drives the planner alone along the manipulation's path, and evaluates the plan."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from uvms_bringup.scenario import load_scenario
from uvms_core.signals import Array, JointStates, Odometry, Reference, to_nanoseconds
from uvms_dynamics import build_model, coupling_wrench, restoring_wrench, rpy_to_quat
from uvms_dynamics.simulation.plant.config import initial_joints
from uvms_planner import MotionPlanner


@dataclass
class Planned:
    """The planner's output along the path."""

    step_s: float
    references: list[Reference] = field(default_factory=list)
    step_seconds: list[float] = field(default_factory=list)
    evaluations: list[int] = field(default_factory=list)
    success: bool | None = None
    beyond: int = 0  # steps beyond the planned accelerations


def plan(
    method: str,
    seconds: float,
    clock: Callable[[], float] = lambda: 0.0,
    settings: Sequence[str] = (),
) -> Planned:
    """The references of the first `seconds` of the path by one of the planner's methods.

    `settings` are further ones of the scenario, as `planner.limits.strict=false`. The odometry
    stays at the start: the planner continues from its own plan.
    """
    scenario = load_scenario("manipulation", [f"planner.method={method}", *settings])
    vehicle, start = scenario.load_vehicle(), scenario.plant
    planner = MotionPlanner(vehicle, scenario.planner, scenario.seed)
    result = Planned(scenario.planner.step_s)
    q = initial_joints(vehicle, start)
    for index in range(round(seconds / result.step_s) + 4):
        stamp = to_nanoseconds(index * result.step_s)
        odometry = Odometry(
            stamp, np.array(start.initial_position_m), rpy_to_quat(0.0, 0.0, 0.0), np.zeros(6),
            np.zeros((6, 6)), np.zeros((6, 6)),
        )  # fmt: skip
        joints = JointStates(stamp, q, np.zeros_like(q), np.zeros_like(q))
        began = clock()
        step = planner.step(stamp, odometry, joints)
        spent = clock() - began
        result.references += step.references
        if step.step is not None and index > 4:  # the first steps load kernels
            result.step_seconds.append(spent)
            result.evaluations.append(step.step.evaluations)
            result.beyond = step.step.steps_beyond_limits
        if step.finished is not None:
            result.success = step.finished.success
        if index == 0:
            planner.accept(scenario.goal.build(vehicle, scenario.plant))
    return result


def self_disturbances(references: list[Reference]) -> Array:
    """Restoring (first six) and coupling wrench (last six) along references, (k, 12), N and N m."""
    model = build_model(load_scenario("manipulation").load_vehicle())
    rows = []
    for r in references:
        for k in range(len(r.times) - 1):
            restoring = restoring_wrench(model, r.quaternion[k], r.q[k])
            coupling = coupling_wrench(model, r.nu[k], r.nu_dot[k], r.q[k], r.q_dot[k], r.q_ddot[k])
            rows.append(np.concatenate([restoring, coupling]))
    return np.array(rows)


def self_disturbance(references: list[Reference]) -> Array:
    """F_dis of eq. (16) along references in still water, (k, 6), N and N m."""
    parts = self_disturbances(references)
    return parts[:, :6] + parts[:, 6:]
