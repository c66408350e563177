import numpy as np
import pytest
import yaml
from planner_rig import reference_vehicle, six_joint_vehicle, solver_of, stubby_vehicle

from uvms_core.vehicle import dump_vehicle, load_vehicle
from uvms_core.vehicle.loader import vehicle_from_data
from uvms_planner import PlannerError
from uvms_planner.planar_inverse import planar_pair, solve_planar
from uvms_planner.projection import configuration_jacobian, tool_pose

VEHICLES = {
    "reference": reference_vehicle(),
    "stubby": stubby_vehicle(),
    "six_joints": six_joint_vehicle(),
    "bluerov2": load_vehicle("bluerov2_alpha5"),  # its axes are 0.005 deg from parallel
}


@pytest.fixture(params=VEHICLES)
def arm(request):
    """(solver, pair) of a vehicle."""
    solver = solver_of(VEHICLES[request.param])
    return solver, planar_pair(solver.model, solver.joints)


def random_configuration(solver, rng):
    share = rng.random(len(solver.joints.names))
    q = solver.joints.lower + share * (solver.joints.upper - solver.joints.lower)
    return np.concatenate([rng.normal(size=4), q])


def in_plane(solver, pair, configuration, gap):
    """The part of `gap` (3,) across the first joint's axis."""
    axis = configuration_jacobian(solver.model, configuration)[3:, 4 + pair.first]
    return gap - axis * (axis @ gap)


def test_shoulder_and_elbow_are_found(arm):
    _, pair = arm
    assert (pair.first, pair.second) == (1, 2)  # theta_2 and theta_3


def test_the_tool_is_where_it_shall_be_in_the_plane_by_both_branches(arm):
    solver, pair = arm
    rng, solved = np.random.default_rng(4), 0
    for _ in range(150):
        start = random_configuration(solver, rng)
        wanted = tool_pose(solver.model, start)[0] + 0.05 * rng.normal(size=3)
        ends = []
        for branch in (1.0, -1.0):
            end = start.copy()
            found, turns = solve_planar(solver.model, end, pair.first, pair.second, wanted, branch)
            if not found:
                continue
            gap = wanted - tool_pose(solver.model, end)[0]
            assert np.linalg.norm(in_plane(solver, pair, start, gap)) < 1e-12
            moved = np.zeros_like(end)
            moved[4 + pair.first], moved[4 + pair.second] = turns
            assert end == pytest.approx(start + moved, abs=1e-14)
            ends.append(end)
            solved += 1
        assert len(ends) in (0, 2)  # out of reach for both, or for none
        if len(ends) == 2:
            assert abs(ends[0][4 + pair.second] - ends[1][4 + pair.second]) > 1e-6
    assert solved > 150


def test_the_posture_that_reached_a_point_is_one_of_the_two(arm):
    """The joints that forward kinematics started from come back, whatever they are turned to."""
    solver, pair = arm
    rng = np.random.default_rng(9)
    a, b = 4 + pair.first, 4 + pair.second
    for _ in range(60):
        known = random_configuration(solver, rng)
        wanted = tool_pose(solver.model, known)[0]
        nearest = np.inf
        for branch in (1.0, -1.0):
            turned = known.copy()
            turned[[a, b]] += rng.uniform(-1.0, 1.0, size=2)
            found, _ = solve_planar(solver.model, turned, pair.first, pair.second, wanted, branch)
            assert found
            angles = turned[[a, b]] - known[[a, b]]
            nearest = min(nearest, np.max(np.abs(np.angle(np.exp(1j * angles)))))
        assert nearest < 1e-7


def test_the_law_of_cosines_gives_the_reference_arm():
    """Closed form for the reference vehicle: links 0.46 m and 0.38 + 0.18 m in one plane."""
    solver = solver_of()
    pair = planar_pair(solver.model, solver.joints)
    start = np.zeros(8)  # stretched out ahead
    shoulder = tool_pose(solver.model, start)[0] - [0.46 + 0.56, 0.0, 0.0]
    wanted = shoulder + [0.6, 0.0, 0.5]
    distance = np.hypot(0.6, 0.5)
    elbow = np.arccos((distance**2 - 0.46**2 - 0.56**2) / (2 * 0.46 * 0.56))
    lift = np.arctan2(0.5, 0.6) - np.arctan2(0.56 * np.sin(elbow), 0.46 + 0.56 * np.cos(elbow))
    postures = []
    for branch in (1.0, -1.0):
        end = start.copy()
        found, turns = solve_planar(solver.model, end, 1, 2, wanted, branch)
        assert found
        postures.append(turns)
    assert any(turns == pytest.approx([lift, elbow], abs=1e-12) for turns in postures)
    assert pair.first == 1


def test_out_of_reach_is_not_found():
    solver = solver_of()
    start = np.zeros(8)
    far = tool_pose(solver.model, start)[0] + [0.01, 0.0, 0.0]  # it is stretched out already
    assert not solve_planar(solver.model, start, 1, 2, far, 1.0)[0]


def _changed(**dh):
    data = yaml.safe_load(dump_vehicle(reference_vehicle()))
    data["arm"]["joints"][1].update(dh)
    return vehicle_from_data(data)


@pytest.mark.parametrize(
    ("change", "lack"),
    [
        ({"alpha_deg": 90.0}, "shoulder, elbow: axes 90 deg from parallel"),
        ({"a_m": 0.0}, "shoulder, elbow: parallel, but the link between them is"),
    ],
)
def test_an_arm_without_two_joints_in_a_plane_is_refused_with_what_it_lacks(change, lack):
    solver = solver_of(_changed(**change))
    with pytest.raises(PlannerError) as caught:
        planar_pair(solver.model, solver.joints)
    assert lack in str(caught.value)
    assert "swing, shoulder: axes 90 deg from parallel" in str(caught.value)
    assert "Choose another planner.method" in str(caught.value)
    with pytest.raises(PlannerError, match="method paper"):
        solver_of(_changed(**change), method="paper")
