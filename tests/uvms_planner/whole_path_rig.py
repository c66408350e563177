"""Problems of whole paths for the tests."""

import numpy as np
from planner_rig import START, reference_vehicle

from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.vehicle import Vehicle, load_vehicle
from uvms_core.vehicle.locate import vehicle_path
from uvms_core.vehicle.postures import posture_deg
from uvms_dynamics import build_model
from uvms_dynamics.geometry import build_geometry
from uvms_dynamics.kernels.rotations import matrix_to_quat
from uvms_planner import PathSpec, PlannerConfig
from uvms_planner.clearance import clearance_margins
from uvms_planner.limits import MotionLimits
from uvms_planner.problem import VEHICLE
from uvms_planner.projection import tool_pose
from uvms_planner.whole_path import PathProblem, Posture, ToolPath, surroundings


def bluerov2() -> Vehicle:
    return load_vehicle(vehicle_path("bluerov2_alpha5"))


def start_of(vehicle: Vehicle) -> np.ndarray:
    """At 10 m depth in the posture `home`."""
    start = START.copy()
    start[VEHICLE:] = np.deg2rad(posture_deg(vehicle.arm, "home"))
    return start


def problem_of(path: dict, vehicle: Vehicle | None = None, obstacles=(), **limits) -> PathProblem:
    """The path `path`, as a scenario words it, from `home`."""
    vehicle = vehicle or reference_vehicle()
    config = PlannerConfig.model_validate({"limits": limits})
    model, start = build_model(vehicle), start_of(vehicle)
    position, rotation = tool_pose(model, start)
    goal = PathSpec.model_validate(path).goal(position, matrix_to_quat(rotation))
    tool = ToolPath(EndEffectorPath(goal))
    geometry = build_geometry(vehicle, obstacles)
    around = surroundings(vehicle, geometry, clearance_margins(config.clearance, vehicle, geometry))
    return PathProblem(
        model, tool, tool.duration, Posture.at_rest(start[VEHICLE - 1 :]),
        MotionLimits.of(vehicle, model, config.limits), around=around,
    )  # fmt: skip


def random_path(seed: int) -> dict:
    """A curve through two to five points, at up to 5 cm/s on average."""
    rng = np.random.default_rng(seed)
    points = np.cumsum(rng.uniform(-0.4, 0.4, (rng.integers(2, 6), 3)), axis=0)
    return {
        "waypoints": {
            "points_m": points.round(3).tolist(),
            "speeds_m_s": float(rng.uniform(0.01, 0.05)),
        }
    }


CIRCLE = {"circle": {"radius_m": 0.3, "plane": "XOZ", "turns": 1, "period_s": 60}}
LINE = {"line": {"to_m": [1.0, 0.5, 0.2], "duration_s": 40}}
