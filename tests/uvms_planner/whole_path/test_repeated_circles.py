"""Circle after circle: no joint wanders to its stop."""

import numpy as np
import pytest
from planner_rig import drive, reference_vehicle
from whole_path_rig import bluerov2, start_of

from uvms_planner import PathSpec, PlannerConfig
from uvms_planner.limits import JointLimits
from uvms_planner.problem import VEHICLE

VEHICLES = {"reference": reference_vehicle, "bluerov2": bluerov2}
SPARE_DEG = 0.5  # more than the planned margin: the soft one begins 6 deg before that


@pytest.mark.parametrize("plane", ["XOZ", "YOZ", "XOY"])
@pytest.mark.parametrize("name", VEHICLES)
def test_five_circles_bring_no_joint_near_its_stop(name, plane):
    vehicle = VEHICLES[name]()
    circle = {"radius_m": 0.3, "plane": plane, "turns": 5, "period_s": 60}
    run = drive(vehicle, tuple(np.rad2deg(start_of(vehicle)[VEHICLE:])))
    goal = PathSpec.model_validate({"circle": circle}).goal(*run.planner.end_effector)
    run.planner.accept(goal)
    assert run.until_finished().success
    joints, stops = run.joined("q"), JointLimits.of(vehicle)
    room = np.rad2deg(np.minimum(joints - stops.lower, stops.upper - joints))
    assert len(joints) > 300 / 0.05
    assert room.min() > PlannerConfig().limits.joint_margin_deg + SPARE_DEG
