"""Runs of the closed loop in one process, and their errors."""

from dataclasses import dataclass

import numpy as np

from uvms_bringup.loop import LoopTick
from uvms_bringup.scenario import Scenario
from uvms_bringup.simulate import simulate
from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.signals import Array, PathGoal, to_seconds
from uvms_dynamics import build_model, end_effector
from uvms_dynamics.kernels.rotations import quat_to_rpy

# The planner gets the goal in the first tick and starts on it one planner step later.
PATH_BEGINS_S = 0.5


@dataclass(frozen=True)
class Run:
    """Errors of a run at every tick."""

    completed: bool
    rpy_deg: Array  # (k, 3) true
    navigation_error: Array  # (k,) m
    true_error: Array  # (j,) m, end effector from its path while it lasts; (0,) without one
    seen_error: Array  # (j,) m, the same by estimated pose and encoders


def run(scenario: Scenario) -> Run:
    """Simulate a scenario."""
    vehicle = scenario.load_vehicle()
    goal = scenario.goal.build(vehicle, scenario.plant)
    ticks: list[LoopTick] = []
    completed = simulate(scenario, vehicle, goal, observe=ticks.append)
    model = build_model(vehicle)
    rpy = np.degrees([quat_to_rpy(tick.truth.odometry.quaternion) for tick in ticks])
    gaps = [tick.odometry.position - tick.truth.odometry.position for tick in ticks]
    true, seen = _errors(goal, model, ticks) if isinstance(goal, PathGoal) else ([], [])
    return Run(completed, rpy, np.linalg.norm(gaps, axis=1), np.array(true), np.array(seen))


def rms(values: Array) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))


def _errors(goal: PathGoal, model, ticks: list[LoopTick]) -> tuple[list[float], list[float]]:
    path = EndEffectorPath(goal)
    true, seen = [], []
    for tick in ticks:
        elapsed = to_seconds(tick.stamp) - _begin(ticks)
        if not 0.0 <= elapsed <= path.duration:
            continue
        wanted = path.sample(elapsed).position
        for errors, odometry, joints in (
            (true, tick.truth.odometry, tick.truth.joints),
            (seen, tick.odometry, tick.sensors.joints),
        ):
            place = end_effector(model, odometry.position, odometry.quaternion, joints.position)[0]
            errors.append(float(np.linalg.norm(place - wanted)))
    return true, seen


def _begin(ticks: list[LoopTick]) -> float:
    """When the path begins, by the planner's feedback."""
    for tick in ticks:
        if tick.plan is not None and tick.plan.feedback is not None:
            feedback = tick.plan.feedback
            if feedback.elapsed > 0.0:
                return to_seconds(tick.stamp) - feedback.elapsed
    return PATH_BEGINS_S
