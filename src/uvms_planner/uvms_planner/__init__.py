"""Motion planning for vehicle and arm together, paper sec. 3."""

from typing import Any

from uvms_core.moved import moved
from uvms_planner.choice import Choice, nearest_on_path
from uvms_planner.config import (
    FitnessConfig,
    GeneticConfig,
    LimitsConfig,
    PlannerConfig,
    ProjectionConfig,
)
from uvms_planner.errors import GoalRejected, PlannerError
from uvms_planner.interfaces import StepMethod
from uvms_planner.path_spec import PathPhase, PathSpec, figure_9
from uvms_planner.planner import MotionPlanner
from uvms_planner.report import GoalFeedback, GoalResult, PlannerStep, StepDiagnostics

__all__ = [
    "Choice",
    "FitnessConfig",
    "GeneticConfig",
    "GoalFeedback",
    "GoalRejected",
    "GoalResult",
    "LimitsConfig",
    "MotionPlanner",
    "PathPhase",
    "PathSpec",
    "PlannerConfig",
    "PlannerError",
    "PlannerStep",
    "ProjectionConfig",
    "StepDiagnostics",
    "StepMethod",
    "figure_9",
    "nearest_on_path",
]

_MOVED = {
    "EndEffectorPath": "uvms_core.end_effector_path",
    "PathSample": "uvms_core.end_effector_path",
}


def __getattr__(name: str) -> Any:
    return moved(__name__, name, _MOVED)
