"""The reference vehicle does what it was designed to do.

The numbers are those of the design, fitted to what the paper says in text and figures; the paper's
own tables are lost.
"""

import numpy as np
import pytest
from random_vehicles import REFERENCE
from scipy.integrate import solve_ivp
from scipy.optimize import linprog

from uvms_core.vehicle import load_vehicle
from uvms_dynamics import (
    build_model,
    coupling_wrench,
    end_effector,
    end_effector_jacobian,
    inverse_dynamics,
    mass_matrix,
    quat_multiply,
    quat_to_matrix,
    quat_to_rpy,
    restoring_wrench,
    rpy_to_quat,
    thruster_matrix,
)

MODEL = build_model(REFERENCE)
SLIPPERY = build_model(
    load_vehicle(overrides={f"arm.links.{i}.drag": [] for i in range(REFERENCE.n_joints)})
)
LEVEL = np.array([0.0, 0.0, 0.0, 1.0])


def joints(*degrees):
    return np.radians([*degrees, 0.0])


def first_moment(q, payload_n=0.0):
    """P = sum m g r_g - sum rho V g r_b, body frame, from the wrench at two attitudes."""
    level, on_side = (restoring_wrench(MODEL, rpy_to_quat(r, 0.0, 0.0), q) for r in (0, np.pi / 2))
    tool, _ = end_effector(MODEL, np.zeros(3), LEVEL, q)
    return np.array([-level[4], level[3], -on_side[3]]) + payload_n * tool


@pytest.mark.parametrize(
    ("pose", "moments", "attitude", "vertical_thrust"),
    [
        ((0, 0, 135), (0.0, 0.0), (0.0, 0.0), 0.0),
        ((0, 0, 0), (0.0, -7.5), (0.0, -16.9), 3.4),
        ((90, 0, 0), (11.6, 4.1), (25.2, 8.5), 30.8),
        ((-90, 0, 0), (-11.6, 4.1), (-25.2, 8.5), 30.8),
        ((45, 0, 0), (8.2, -4.1), (18.4, -9.0), 22.4),
        ((0, 90, 0), (0.0, 2.9), (0.0, 4.7), 1.3),
    ],
)
def test_static_table(pose, moments, attitude, vertical_thrust):
    q = joints(*pose)
    wrench = restoring_wrench(MODEL, LEVEL, q)
    np.testing.assert_allclose(wrench[:3], 0.0, atol=1e-9)  # neutral
    np.testing.assert_allclose(wrench[3:], (*moments, 0.0), atol=0.05)
    x, y, z = first_moment(q)
    free = np.degrees([np.arctan2(y, z), np.arctan2(-x, np.hypot(y, z))])
    np.testing.assert_allclose(free, attitude, atol=0.06)
    assert least_vertical_thrust(-wrench) == pytest.approx(vertical_thrust, abs=0.06)


def least_vertical_thrust(wrench):
    """The smallest possible largest thrust that makes this wrench."""
    matrix = thruster_matrix(REFERENCE)
    m = matrix.shape[1]
    bound = np.vstack([np.hstack([s * np.eye(m), -np.ones((m, 1))]) for s in (1, -1)])
    found = linprog(
        np.r_[np.zeros(m), 1.0],
        A_ub=bound,
        b_ub=np.zeros(2 * m),
        A_eq=np.hstack([matrix, np.zeros((6, 1))]),
        b_eq=wrench,
        bounds=[(None, None)] * m + [(0.0, None)],
    )
    return found.x[-1]


def test_free_equilibrium_has_no_moment():
    q = joints(90, 0, 0)
    x, y, z = first_moment(q)
    quat = rpy_to_quat(np.arctan2(y, z), np.arctan2(-x, np.hypot(y, z)), 0.3)
    np.testing.assert_allclose(restoring_wrench(MODEL, quat, q), 0.0, atol=1e-9)


def test_payload_of_5_newtons_at_the_tool_to_starboard():
    q = joints(90, 0, 0)
    jacobian = end_effector_jacobian(MODEL, LEVEL, q)[:3]
    wrench = restoring_wrench(MODEL, LEVEL, q) + jacobian[:, :6].T @ [0.0, 0.0, 5.0]
    np.testing.assert_allclose(wrench[3:5], (17.4, -0.4), atol=0.1)
    x, y, z = first_moment(q, payload_n=5.0)
    free = np.degrees([np.arctan2(y, z), np.arctan2(-x, np.hypot(y, z))])
    np.testing.assert_allclose(free, (34.2, -0.8), atol=0.15)
    assert least_vertical_thrust(-wrench) == pytest.approx(45.0, abs=0.5)


def test_hull_values_follow_from_its_shape():
    hull = REFERENCE.hull
    assert hull.volume_m3 == pytest.approx(0.18146, abs=1e-5)
    assert hull.mass_kg == pytest.approx(184.47, abs=0.01)
    np.testing.assert_allclose(np.diag(hull.inertia_kg_m2), (2.66, 54.5, 54.5), atol=0.05)
    expected = (7.78, 171.6, 171.6, 0.806, 42.7, 42.7)
    np.testing.assert_allclose(np.diag(hull.added_mass), expected, rtol=1e-3)


@pytest.mark.parametrize(
    ("elbow", "swing", "shoulder"),
    [(0, 2.13, 1.68), (45, 1.79, 1.25), (90, 1.12, 0.55), (135, 0.71, 0.33)],
)
def test_added_inertia_of_the_arm_varies_with_the_elbow(elbow, swing, shoulder):
    """The analogue of Fig. 6: M(q) in the water less M(q) of the same bodies without added mass."""
    q = joints(0, 0, elbow)
    data = REFERENCE.model_copy(
        update={
            "arm": REFERENCE.arm.model_copy(
                update={
                    "links": tuple(
                        link.model_copy(update={"added_mass": np.zeros((6, 6)).tolist()})
                        for link in REFERENCE.arm.links
                    )
                }
            )
        }
    )
    added = mass_matrix(MODEL, q) - mass_matrix(build_model(data), q)
    assert added[6, 6] == pytest.approx(swing, abs=0.01)
    assert added[7, 7] == pytest.approx(shoulder, abs=0.01)


def test_periods_of_roll_and_pitch():
    """Of the hull by itself, without damping."""
    inertia = np.diag(REFERENCE.hull.inertia_kg_m2) + np.diag(REFERENCE.hull.added_mass)[3:]
    stiffness = REFERENCE.hull.mass_kg * 9.81 * REFERENCE.hull.cg_m[2]
    periods = 2.0 * np.pi * np.sqrt(inertia / stiffness)
    assert periods[0] == pytest.approx(2.5, abs=0.05)
    assert periods[1] == pytest.approx(13.3, abs=0.1)


def test_main_thruster_drives_it_at_2_1_metres_a_second():
    """Hull, fins and stowed arm, with the angle at which it sails; `test_straight_course` sails."""
    q = np.radians(REFERENCE.arm.stowed_deg)
    nu = np.array([2.1, 0.008, -0.115, 0.0, 0.0, 0.0])
    at_rest = np.zeros(4)
    force = inverse_dynamics(MODEL, LEVEL, nu, np.zeros(6), q, at_rest, at_rest)
    assert force[0] == pytest.approx(98.0, rel=0.01)


def test_thrusters_have_the_designs_authority():
    matrix = thruster_matrix(REFERENCE)
    limits = np.array([thruster.limit_n for thruster in REFERENCE.thrusters])
    assert np.linalg.matrix_rank(matrix) == 6
    expected = (98.0, 98.0, 196.0, 19.6, 107.8, 73.5)
    np.testing.assert_allclose(np.abs(matrix) @ limits, expected, rtol=1e-12)


def quintic(t, duration=10.0):
    """Fraction of a rest-to-rest motion and its two derivatives."""
    s = min(t / duration, 1.0)
    return np.array(
        [
            10 * s**3 - 15 * s**4 + 6 * s**5,
            (30 * s**2 - 60 * s**3 + 30 * s**4) / duration,
            (60 * s - 180 * s**2 + 120 * s**3) / duration**2,
        ]
    )


def swing(t):
    """The arm of the analogue of Fig. 7: base 0 to 90, elbow 135 to 0 degrees in 10 s."""
    start, end = joints(0, 0, 135), joints(90, 0, 0)
    part, rate, acceleration = quintic(t)
    return start + part * (end - start), rate * (end - start), acceleration * (end - start)


def uncontrolled_run():
    """Times, attitude (rpy, degrees) and coupling wrench of 14 s with the joints prescribed."""

    def vehicle_rate(t, x, q, q_dot, q_ddot):
        quat, nu = x[3:7] / np.linalg.norm(x[3:7]), x[7:]
        needed = inverse_dynamics(MODEL, quat, nu, np.zeros(6), q, q_dot, q_ddot)[:6]
        nu_dot = np.linalg.solve(mass_matrix(MODEL, q)[:6, :6], -needed)
        turning = 0.5 * quat_multiply(quat, np.append(nu[3:], 0.0))
        return np.concatenate([quat_to_matrix(quat) @ nu[:3], turning, nu_dot])

    start = np.concatenate([[0.0, 0.0, 10.0], LEVEL, np.zeros(6)])
    run = solve_ivp(
        lambda t, x: vehicle_rate(t, x, *swing(t)),
        (0.0, 14.0), start, t_eval=np.linspace(0.0, 14.0, 281), rtol=1e-7, atol=1e-9,
        max_step=0.1,
    )  # fmt: skip
    states = run.y.T
    attitude = np.degrees([quat_to_rpy(x[3:7] / np.linalg.norm(x[3:7])) for x in states])
    motions = [(x[7:], vehicle_rate(t, x, *swing(t))[7:], *swing(t))
               for t, x in zip(run.t, states, strict=True)]  # fmt: skip
    return attitude, motions


def test_uncontrolled_swing_of_the_arm():
    attitude, motions = uncontrolled_run()
    roll, pitch, yaw = attitude.T
    np.testing.assert_allclose((roll.min(), roll.max()), (0.0, 25.3), atol=0.1)
    # The design sheet has pitch to 9.7 and yaw to -10.9, without fins, which resist both.
    np.testing.assert_allclose((pitch.min(), pitch.max()), (-2.0, 9.5), atol=0.1)
    assert yaw.max() == pytest.approx(0.0, abs=0.1)
    assert yaw[-1] == pytest.approx(-8.9, abs=0.2)

    # Inertia and added mass are what the design's 0.7 N and 0.75 N m say; drag comes on top.
    inertial = np.array([coupling_wrench(SLIPPERY, *motion) for motion in motions])
    assert np.abs(inertial[:, :3]).max() == pytest.approx(0.70, abs=0.03)
    assert np.abs(inertial[:, 3:]).max() == pytest.approx(0.75, abs=0.03)
    whole = np.array([coupling_wrench(MODEL, *motion) for motion in motions])
    assert np.abs(whole).max() < 1.1
    # so the restoring moment, 11.6 N m at the end, makes the attitude
