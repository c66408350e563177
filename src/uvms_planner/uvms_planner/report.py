"""Results of a planner step."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from uvms_core.diagnostics import MANIPULABILITY, STEPS_BEYOND_LIMITS
from uvms_core.signals import Array, Reference
from uvms_planner.choice import Choice
from uvms_planner.config import PlannerConfig
from uvms_planner.exceeded import LimitExceeded
from uvms_planner.on_path import FollowedStep
from uvms_planner.solver import StepSolver


@dataclass(frozen=True)
class GoalFeedback:
    """How far a goal is, at the stamp of a planner step."""

    stamp: int
    elapsed: float  # s that are done
    duration: float  # s, the whole goal
    planned_error: float  # m, of the last planned step against the path
    tracking_error: float  # m, distance of the estimated end effector from its present target
    distance: float = np.nan  # m, of the estimated vehicle from the pose that it goes to, if any
    turn: float = np.nan  # rad, likewise, about the vertical axis


@dataclass(frozen=True)
class GoalResult:
    """How a goal ended."""

    success: bool
    message: str
    max_planned_error: float  # m, of the plan against the path, once it has joined it


@dataclass(frozen=True)
class StepDiagnostics:
    """How good the step along a path is that was planned last."""

    method: str
    fitness: float  # 1 / cost, eq. (18)
    self_disturbance: Array  # (6,) N, N m, F_dis of eq. (16) at the end of the step
    free_roll: float  # rad, that the vehicle would take up freely
    free_pitch: float  # rad
    attitude_violation: float  # rad beyond the limits of eq. (17); 0 within
    evaluations: int  # candidates judged
    feasible: int  # of them within e and the attitude limits
    discarded: int  # of them not within e
    planned_error: float  # m
    manipulability: float  # of the arm at the end of the step, as a share of its best
    limits_exceeded: tuple[LimitExceeded, ...]  # by the step, the most exceeded first
    steps_beyond_limits: int  # so far, of this planner

    @staticmethod
    def of(method: str, solver: StepSolver, step: FollowedStep) -> "StepDiagnostics":
        """The diagnostics of a planned step."""
        choice = step.choice
        roll, pitch = solver.free_attitude(step.knot.configuration)
        return StepDiagnostics(
            method=method,
            fitness=1.0 / choice.cost if choice.cost > 0.0 else np.inf,
            self_disturbance=solver.disturbance(step.problem, choice.increment),
            free_roll=roll,
            free_pitch=pitch,
            attitude_violation=choice.attitude_violation,
            evaluations=choice.evaluations,
            feasible=choice.feasible,
            discarded=choice.discarded,
            planned_error=step.planned_error,
            manipulability=solver.manipulability(step.knot.configuration),
            limits_exceeded=choice.limits_exceeded,
            steps_beyond_limits=solver.steps_beyond_limits,
        )

    def values(self) -> dict[str, Any]:
        """The numbers by name, for /diagnostics; angles in degrees."""
        force, moment = self.self_disturbance[:3], self.self_disturbance[3:]
        return {
            "method": self.method,
            "fitness": self.fitness,
            "self_disturbance_n": float(np.linalg.norm(force)),
            "self_disturbance_nm": float(np.linalg.norm(moment)),
            "free_roll_deg": float(np.rad2deg(self.free_roll)),
            "free_pitch_deg": float(np.rad2deg(self.free_pitch)),
            "attitude_violation_deg": float(np.rad2deg(self.attitude_violation)),
            "evaluations": self.evaluations,
            "feasible": self.feasible,
            "discarded": self.discarded,
            "planned_error_m": self.planned_error,
            MANIPULABILITY: self.manipulability,
            "limits_exceeded": "; ".join(map(str, self.limits_exceeded)) or "none",
            STEPS_BEYOND_LIMITS: self.steps_beyond_limits,
        }


@dataclass(frozen=True)
class PlannerStep:
    """What one planner tick gives."""

    references: tuple[Reference, ...]  # the segments planned in this tick, in order
    feedback: GoalFeedback | None  # while a goal is active
    finished: GoalResult | None  # in the tick in which a goal ends
    step: StepDiagnostics | None  # of the last step planned along a path in this tick

    def diagnostics(self) -> dict[str, Any]:
        """Numbers for /diagnostics by name; empty when nothing was chosen and no goal is active."""
        values: dict[str, Any] = {}
        if self.feedback is not None:  # here too, since logs do not hold an action's feedback
            values["elapsed_s"] = self.feedback.elapsed
            values["tracking_error_m"] = self.feedback.tracking_error
        return values | (self.step.values() if self.step is not None else {})


def why_not(choice: Choice, config: PlannerConfig) -> str:
    """Why a choice that is not valid cannot be planned: the limit, the value, the bound."""
    allowed = config.projection
    if choice.limits_exceeded:
        listed = "; ".join(map(str, choice.limits_exceeded))
        return f"the path can be followed only beyond a limit: {listed}"
    if choice.distance >= allowed.position_tolerance_m:
        return (
            f"the nearest reachable point is {choice.distance:.4g} m away, allowed"
            f" {allowed.position_tolerance_m:g} m"
        )
    if np.rad2deg(choice.angle) >= allowed.orientation_tolerance_deg:
        return (
            f"the nearest reachable orientation is {np.rad2deg(choice.angle):.4g} deg away,"
            f" allowed {allowed.orientation_tolerance_deg:g} deg"
        )
    return (
        "the attitude that the vehicle would take up freely is"
        f" {np.rad2deg(choice.attitude_violation):.4g} deg beyond its limits, roll"
        f" {config.limits.roll_max_deg:g} deg and pitch {config.limits.pitch_max_deg:g} deg"
    )
