import numpy as np
import pytest
from planner_rig import START, solver_of, target_near

from uvms_dynamics import restoring_wrench
from uvms_planner.constraints import attitude_violation, better, free_attitude

SOLVER = solver_of()


@pytest.mark.parametrize(
    ("q_deg", "roll", "pitch"),
    [
        ((0, 0, 135, 0), 0.0, 0.0),
        ((0, 0, 0, 0), 0.0, -16.9),
        ((90, 0, 0, 0), 25.2, 8.5),
        ((-90, 0, 0, 0), -25.2, 8.5),
        ((45, 0, 0, 0), 18.4, -9.0),
        ((0, 90, 0, 0), 0.0, 4.7),
    ],
)
def test_the_free_attitude_of_the_reference_vehicle(q_deg, roll, pitch):
    attitude = free_attitude(SOLVER.model, np.deg2rad(np.array(q_deg, dtype=float)))
    assert np.rad2deg(attitude) == pytest.approx([roll, pitch], abs=0.06)


def test_in_its_free_attitude_the_vehicle_feels_no_moment():
    q = np.deg2rad([30.0, 20.0, 40.0, 0.0])
    roll, pitch = free_attitude(SOLVER.model, q)
    quaternion = np.array(
        [
            np.sin(roll / 2) * np.cos(pitch / 2),
            np.cos(roll / 2) * np.sin(pitch / 2),
            -np.sin(roll / 2) * np.sin(pitch / 2),
            np.cos(roll / 2) * np.cos(pitch / 2),
        ]
    )
    level = restoring_wrench(SOLVER.model, np.array([0.0, 0.0, 0.0, 1.0]), q)
    assert np.linalg.norm(level[3:]) > 1.0
    assert np.linalg.norm(restoring_wrench(SOLVER.model, quaternion, q)[3:]) < 1e-9


def test_only_what_exceeds_the_limits_counts():
    problem = SOLVER.problem(START, np.zeros(8), target_near(SOLVER, START, [0, 0, 0]))
    assert attitude_violation(SOLVER.model, problem, START[4:].copy()) == 0.0
    q = np.deg2rad([90.0, 0.0, 0.0, 0.0])
    roll, pitch = free_attitude(SOLVER.model, q)
    beyond = abs(roll) - np.deg2rad(5.0) + abs(pitch) - np.deg2rad(4.0)
    assert attitude_violation(SOLVER.model, problem, q) == pytest.approx(beyond)


def test_deb_puts_feasible_before_infeasible_and_less_violation_before_more():
    assert better(0.0, 100.0, 0.1, 0.001)
    assert not better(0.1, 0.001, 0.0, 100.0)
    assert better(0.1, 100.0, 0.2, 0.001)
    assert better(0.0, 1.0, 0.0, 2.0)
    assert not better(0.0, 2.0, 0.0, 1.0)
    assert not better(0.0, 1.0, 0.0, 1.0)
