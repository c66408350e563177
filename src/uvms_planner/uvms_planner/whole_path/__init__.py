"""Planning a whole path at once: splines for yaw and joints, the vehicle in closed form."""

from uvms_planner.whole_path.path_problem import CostWeights, PathProblem, Posture, ToolPath
from uvms_planner.whole_path.plan import PathPlan
from uvms_planner.whole_path.plan_report import LimitShare, PlanReport
from uvms_planner.whole_path.sample import Surroundings
from uvms_planner.whole_path.slower import SlowerPlan, slow_down
from uvms_planner.whole_path.solve import solve
from uvms_planner.whole_path.surroundings import surroundings
from uvms_planner.whole_path.window import PathWindow, TimedPlan

__all__ = [
    "CostWeights",
    "LimitShare",
    "PathPlan",
    "PathProblem",
    "PathWindow",
    "PlanReport",
    "Posture",
    "SlowerPlan",
    "Surroundings",
    "TimedPlan",
    "ToolPath",
    "slow_down",
    "solve",
    "surroundings",
]
