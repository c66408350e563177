"""Planning a whole path at once: splines for yaw and joints, the vehicle in closed form."""

from uvms_planner.whole_path.path_problem import CostWeights, PathProblem, Posture, ToolPath
from uvms_planner.whole_path.plan import PathPlan
from uvms_planner.whole_path.plan_report import LimitShare, PlanReport
from uvms_planner.whole_path.sample import Water
from uvms_planner.whole_path.solve import solve

__all__ = [
    "CostWeights",
    "LimitShare",
    "PathPlan",
    "PathProblem",
    "PlanReport",
    "Posture",
    "ToolPath",
    "Water",
    "solve",
]
