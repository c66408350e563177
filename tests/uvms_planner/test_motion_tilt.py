"""The tilt of a vehicle under way, against closed forms and the free attitude."""

import numpy as np
import pytest
from planner_rig import solver_of
from scipy.spatial.transform import Rotation

from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.locate import vehicle_path
from uvms_dynamics import mass_matrix, restoring_wrench
from uvms_planner.motion_tilt import Tilt
from uvms_planner.segment import Samples


def solver_and_posture(name):
    vehicle = load_vehicle(vehicle_path(name))
    configuration = np.concatenate([[0.0, 0.0, 10.0, 0.4], np.radians(vehicle.arm.stowed_deg)])
    return solver_of(vehicle), configuration


def under_way(c, ahead=0.0, acceleration=0.0) -> Samples:
    """Going ahead at a heading, m/s and m/s^2."""
    along = np.zeros((2, len(c)))
    along[:, 0], along[:, 1] = np.cos(c[3]), np.sin(c[3])
    return Samples(c[None], ahead * along[:1], acceleration * along[1:])


def test_where_the_thrusters_act_in_roll_and_pitch_nothing_tilts():
    solver, c = solver_and_posture("reference_auv")
    assert not solver.tilt().along(solver.model, under_way(c, 1.0, 1.0)).any()


def test_at_rest_it_is_the_free_attitude_of_the_axes_that_no_thruster_turns():
    solver, c = solver_and_posture("bluerov2_alpha5")
    roll, pitch = np.rad2deg(solver.tilt().along(solver.model, under_way(c)))[0]
    assert roll == 0.0  # its thrusters hold it
    assert pitch == pytest.approx(np.rad2deg(solver.free_attitude(c)[1]), rel=0.01)


def test_above_the_speed_at_which_munks_moment_is_as_stiff_as_the_buoyancy_nothing_holds_it():
    """(Z_w - X_u) u^2 = K, with masses and added masses: Fossen 2021, sec. 6.3.1."""
    solver, c = solver_and_posture("bluerov2_alpha5")
    M = mass_matrix(solver.model, c[4:].copy())

    def pitch_moment(angle: float) -> float:
        quaternion = Rotation.from_euler("y", angle).as_quat()
        return restoring_wrench(solver.model, quaternion, c[4:].copy())[4]

    stiffness = (pitch_moment(-1e-3) - pitch_moment(1e-3)) / 2e-3
    critical = np.sqrt(stiffness / (M[2, 2] - M[0, 0]))
    tilts = [
        solver.tilt().along(solver.model, under_way(c, share * critical))[0, 1]
        for share in (0.3, 0.6, 0.97, 1.03, 2.0)
    ]
    assert np.isfinite(tilts[:3]).all()
    assert np.isinf(tilts[3:]).all()
    assert abs(tilts[0]) < abs(tilts[1]) < 0.1 * abs(tilts[2])


def test_the_tilt_is_where_the_moments_are_balanced():
    """Against pitch moment and buoyancy at the tilted attitude itself, not at the level one."""
    solver, c = solver_and_posture("bluerov2_alpha5")
    tilt, samples = solver.tilt(), under_way(c, 0.3, 0.02)
    found = tilt.along(solver.model, samples)[0]
    rows = samples.configuration[0], samples.rate[0], samples.acceleration[0]
    level = tilt._moment(solver.model, np.zeros(2), *rows)
    there = tilt._moment(solver.model, found, *rows)
    assert abs(there[0]) < 0.02 * abs(level[0])


def test_a_thruster_that_is_dead_leaves_its_axis_to_the_buoyancy():
    solver, c = solver_and_posture("reference_auv")
    vehicle = load_vehicle(vehicle_path("reference_auv"))
    health = np.array(
        [1.0 if each.name.startswith(("main", "side")) else 0.0 for each in vehicle.thrusters]
    )
    tilt = Tilt(vehicle, health).along(solver.model, under_way(c, 0.3))
    assert np.abs(tilt).max() > 0.0
