"""Motion planning for vehicle and arm together, paper sec. 3."""

from uvms_planner.config import (
    FitnessConfig,
    GeneticConfig,
    LimitsConfig,
    PlannerConfig,
    ProjectionConfig,
)
from uvms_planner.errors import GoalRejected, PlannerError
from uvms_planner.path import EndEffectorPath, PathSample
from uvms_planner.path_spec import PathPhase, PathSpec, figure_9
from uvms_planner.planner import MotionPlanner
from uvms_planner.report import GoalFeedback, GoalResult, PlannerStep, StepDiagnostics

__all__ = [
    "EndEffectorPath",
    "FitnessConfig",
    "GeneticConfig",
    "GoalFeedback",
    "GoalRejected",
    "GoalResult",
    "LimitsConfig",
    "MotionPlanner",
    "PathPhase",
    "PathSample",
    "PathSpec",
    "PlannerConfig",
    "PlannerError",
    "PlannerStep",
    "ProjectionConfig",
    "StepDiagnostics",
    "figure_9",
]
