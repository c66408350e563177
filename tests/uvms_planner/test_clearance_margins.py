"""Margins that a plan keeps: what is asked for, or almost what it begins with."""

import numpy as np
import pytest

from uvms_core.scene import Obstacle
from uvms_core.vehicle import Vehicle, load_vehicle
from uvms_core.vehicle.locate import known_vehicles, vehicle_path
from uvms_core.vehicle.postures import STOWED, posture_deg
from uvms_dynamics.geometry import OWN, build_geometry, clearances
from uvms_planner.clearance import ClearanceConfig, clearance_margins
from uvms_planner.config import PlannerConfig
from uvms_planner.solver import StepSolver

ROCK = Obstacle(name="rock", sphere={"center_m": [9.0, 0.0, 10.0], "radius_m": 1.0})


def margins_by_pair(vehicle, **config):
    geometry = build_geometry(vehicle, [ROCK])
    margins = clearance_margins(ClearanceConfig(**config), vehicle, geometry)
    return dict(zip(map(str, geometry.pairs), margins, strict=True))


def test_each_kind_of_pair_has_its_margin():
    data = load_vehicle().model_dump(mode="json")
    data["environment"]["seabed_depth_m"] = 20.0
    margins = margins_by_pair(
        Vehicle.model_validate(data),
        hull_m=0.02,
        arm_m=0.01,
        obstacle_m=0.3,
        seabed_m=0.4,
        tool_m=-0.05,
    )
    assert margins["forearm and hull"] == 0.02
    assert margins["gripper and upper_arm"] == 0.01
    assert margins["hull and rock"] == margins["forearm and rock"] == 0.3
    assert margins["hull and seabed"] == margins["upper_arm and seabed"] == 0.4
    assert margins["gripper and rock"] == margins["gripper and seabed"] == -0.05


@pytest.mark.parametrize("name", sorted(known_vehicles()))
def test_no_posture_of_a_vehicle_file_is_refused_and_none_is_left_for_a_much_closer_one(name):
    vehicle = load_vehicle(vehicle_path(name))
    solver, geometry = StepSolver(vehicle, PlannerConfig(), 1), build_geometry(vehicle)
    for posture in (STOWED, *vehicle.arm.postures_deg):
        angles = np.radians(posture_deg(vehicle.arm, posture))
        start = np.array([0.0, 0.0, 5.0, 1.0, *angles])
        room, margins = clearances(geometry, start), solver.around_from(start).margins
        assert (margins < room).all()
        assert (margins >= np.minimum(0.03, 0.9 * room - 1e-3) - 1e-12).all()


def test_the_reference_vehicle_has_the_whole_margin():
    vehicle = load_vehicle()
    geometry = build_geometry(vehicle)
    margins = clearance_margins(PlannerConfig().clearance, vehicle, geometry)
    assert {pair.kind for pair in geometry.pairs} == set(OWN)
    assert (margins == 0.03).all()
