"""Going to a pose: as fast as the limits allow, smoothly, and refused where it cannot be."""

import numpy as np
import pytest
from planner_rig import START, drive, reference_vehicle
from scipy.spatial.transform import Rotation

from uvms_core.scene import Obstacle
from uvms_core.signals import PoseGoal
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.locate import vehicle_path
from uvms_dynamics import inverse_dynamics, thruster_matrix
from uvms_planner import GoalRejected
from uvms_planner.segment import Samples
from uvms_planner.straight_motion import Profile


def heading(yaw_deg: float) -> np.ndarray:
    return Rotation.from_euler("z", yaw_deg, degrees=True).as_quat()


def pose(x=0.0, y=0.0, z=10.0, yaw_deg=0.0, **more) -> PoseGoal:
    return PoseGoal(np.array([x, y, z], dtype=float), heading(yaw_deg), **more)


def world_motion(run):
    """Position, velocity (k, 3) and yaw rate (k,) of all references, in map_ned."""
    nu, position = run.joined("nu"), run.joined("position")
    turned = Rotation.from_quat(run.joined("quaternion"))
    return position, turned.apply(nu[:, :3]), nu[:, 5]


@pytest.mark.parametrize(
    ("rate", "acceleration"), [(0.1, 1.0), (10.0, 1.0), (0.5, 0.01), (0.02, 0.1)]
)
def test_a_profile_is_the_integral_of_its_derivatives_and_within_its_bounds(rate, acceleration):
    profile = Profile.fastest(rate, acceleration)
    t = np.linspace(0.0, profile.duration, 20001)
    share, slope, bend = profile.at(t)
    assert (share[0], share[-1], slope[0], bend[0]) == (0.0, 1.0, 0.0, 0.0)
    assert (slope[-1], bend[-1]) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert slope.max() <= rate * (1 + 1e-12)
    assert np.abs(bend).max() <= acceleration * (1 + 1e-12)
    dt, peak = t[1], np.abs(bend).max()
    jump = 4.01 * dt / profile.ramp * peak  # in dt, where 6 u (1 - u) is steepest
    np.testing.assert_allclose(np.gradient(share, dt)[1:-1], slope[1:-1], atol=dt * jump)
    np.testing.assert_allclose(np.gradient(slope, dt)[1:-1], bend[1:-1], atol=jump)
    assert np.abs(np.diff(bend)).max() < jump  # the acceleration is continuous
    bang_bang = (
        2 / np.sqrt(acceleration) if rate**2 > acceleration else 1 / rate + rate / acceleration
    )
    assert bang_bang <= profile.duration < 1.23 * bang_bang + 0.5 * rate / acceleration


def test_the_vehicle_goes_there_straight_and_stays_with_the_arm_as_it_is():
    run = drive()
    run.planner.accept(pose(2.0, -1.0, 10.5, 30.0))
    assert run.until_finished().success
    run.advance(4)
    position, velocity, _ = world_motion(run)
    np.testing.assert_allclose(position[-1], [2.0, -1.0, 10.5], atol=1e-12)
    np.testing.assert_allclose(run.references[-1].quaternion[-1], heading(30.0), atol=1e-12)
    off = np.cross(position - START[:3], np.array([2.0, -1.0, 0.5]))
    assert np.abs(off).max() < 1e-12
    np.testing.assert_array_equal(run.joined("q"), np.tile(START[4:], (len(position), 1)))
    assert not run.joined("q_dot").any()
    dt = 0.05
    mean = (velocity[1:] + velocity[:-1]) / 2
    np.testing.assert_allclose(np.diff(position, axis=0) / dt, mean, atol=2e-5)


@pytest.mark.parametrize("name", ["reference_auv", "bluerov2_alpha5"])
def test_it_is_as_fast_as_a_limit_allows_and_no_faster(name):
    vehicle = load_vehicle(vehicle_path(name))
    run = drive(vehicle, tuple(vehicle.arm.stowed_deg))
    limits, solver = run.planner._solver.motion_limits, run.planner._solver
    run.planner.accept(pose(8.0, 3.0, 10.0, 20.0))
    assert run.until_finished().success
    _, velocity, turning = world_motion(run)
    speed = np.linalg.norm(velocity[:, :2], axis=1)
    ratios = [speed.max() / limits.rate[0], np.abs(turning).max() / limits.rate[3]]
    acceleration = np.diff(velocity, axis=0) / 0.05
    ratios.append(np.linalg.norm(acceleration[:, :2], axis=1).max() / limits.acceleration[0])
    ratios += [_thrust(vehicle, solver, run), _tilt(solver, run)]
    assert max(ratios) <= 1.003
    assert max(ratios) > 0.97


def _tilt(solver, run) -> float:
    """Greatest pitch as a share of half of the free attitude's limit."""
    position, velocity, turning = world_motion(run)
    c = np.zeros((len(position), solver.size))
    v, a = c.copy(), c.copy()
    yaw = Rotation.from_quat(run.joined("quaternion")).as_euler("ZYX")[:, 0]
    c[:, :3], c[:, 3], c[:, 4:] = position, yaw, run.joined("q")
    v[:, :3], v[:, 3] = velocity, turning
    a[:-1, :3] = np.diff(velocity, axis=0) / 0.05
    every = slice(None, None, 4)
    tilt = solver.tilt().along(solver.model, Samples(c[every], v[every], a[every]))
    return float(np.abs(tilt[:, 1]).max() / (0.5 * solver.motion_limits.pitch_max))


def _thrust(vehicle, solver, run) -> float:
    """Greatest share of 80 % of a thruster's limit, by the least squares over the thrusters."""
    least = np.array(
        [min(-each.astern_n or each.ahead_n, each.ahead_n) for each in vehicle.thrusters]
    )
    B = thruster_matrix(vehicle) * least
    inverse, greatest = np.linalg.pinv(B, rcond=1e-6), 0.0
    level, still = np.array([0.0, 0.0, 0.0, 1.0]), np.zeros(len(vehicle.arm.joints))
    nu, nu_dot, q = run.joined("nu"), run.joined("nu_dot"), run.joined("q")
    for k in range(len(nu)):
        tau = inverse_dynamics(
            solver.model, level, nu[k].copy(), nu_dot[k].copy(), q[k].copy(), still, still
        )
        greatest = max(greatest, np.abs(inverse @ tau[:6]).max() / 0.8)
    return greatest


def test_a_time_for_the_way_is_kept_and_then_it_holds():
    run = drive()
    run.planner.accept(pose(1.0, duration_s=60.0, hold_s=5.25))
    step = run.advance()
    assert step.feedback.duration == pytest.approx(65.25)
    assert (step.feedback.distance, step.feedback.turn) == pytest.approx((1.0, 0.0))
    begun = run.tick
    assert run.until_finished().success
    assert 65.25 <= (run.tick - begun) * 0.5 <= 66.5
    position, velocity, _ = world_motion(run)
    there = np.linalg.norm(position - [1.0, 0.0, 10.0], axis=1) < 1e-9
    assert there.sum() * 0.05 == pytest.approx(5.25 + 1.0, abs=0.5)
    assert velocity[:, 0].max() == pytest.approx(4 / 3 / 60.0)


@pytest.mark.parametrize("longer", [1.0, 1.05, 1.5, 10.0])
@pytest.mark.parametrize(("rate", "acceleration"), [(0.1, 1.0), (10.0, 1.0), (0.5, 0.3)])
def test_a_profile_of_any_time_that_is_long_enough_is_within_its_bounds(rate, acceleration, longer):
    duration = longer * Profile.fastest(rate, acceleration).duration
    profile = Profile.lasting(duration, rate, acceleration)
    assert profile.duration == duration
    assert profile.rate <= rate * (1 + 1e-9)
    assert profile.acceleration <= acceleration * (1 + 1e-9)
    assert profile.ramp <= duration / 2


def test_a_greatest_speed_is_kept():
    run = drive()
    run.planner.accept(pose(1.0, 1.0, speed_max_m_s=0.04))
    assert run.until_finished().success
    speed = np.linalg.norm(world_motion(run)[1], axis=1)
    assert 0.0399 < speed.max() <= 0.04 + 1e-12


def test_it_turns_the_shorter_way():
    run = drive()
    run.planner.accept(pose(yaw_deg=170.0))
    assert run.until_finished().success
    run.planner.accept(pose(yaw_deg=-170.0))
    assert run.until_finished().success
    turned = np.rad2deg(np.sum(run.joined("nu")[:, 5]) * 0.05)
    assert turned == pytest.approx(190.0, abs=0.1)


def test_the_pose_where_it_is_is_held_for_its_time():
    run = drive()
    run.planner.accept(pose(hold_s=3.0))
    assert run.until_finished().success
    assert 3.0 <= run.tick * 0.5 <= 5.0
    assert not run.joined("nu").any()


REFUSED = [
    ({"z": 0.1}, "its depth is 0.1 m, and the vehicle needs at least 0.3"),
    ({"z": -1.0}, "its depth is -1 m"),
    ({"x": np.nan}, r"position = \[nan  0. 10.\] is not finite"),
    ({"duration_s": -1.0}, "duration_s is -1, must be >= 0"),
    ({"hold_s": np.inf}, "hold_s is inf"),
    ({"speed_max_m_s": -0.1}, "speed_max_m_s is -0.1"),
    ({"x": 5.0, "duration_s": 3.0}, r"3 s are too short; .* takes \d"),
]


@pytest.mark.parametrize(("change", "message"), REFUSED)
def test_what_cannot_be_is_refused_and_nothing_moves(change, message):
    run = drive()
    with pytest.raises(GoalRejected, match=message):
        run.planner.accept(pose(**change))
    run.advance(4)
    assert not run.joined("nu").any()


@pytest.mark.parametrize(
    ("position", "quaternion", "message"),
    [
        (np.zeros(2), heading(0.0), r"position has shape \(2,\); needed is \(3,\)"),
        (np.ones(3), np.zeros(3), r"quaternion has shape \(3,\)"),
        (np.ones(3), np.array([0.0, 0.0, 0.0, 2.0]), "quaternion has norm 2, must be a unit"),
        (np.ones(3), np.array([1.0, 0.0, 0.0, 0.0]), "tilted by 180 deg, allowed 5 deg"),
    ],
)
def test_malformed_poses_are_refused(position, quaternion, message):
    with pytest.raises(GoalRejected, match=message):
        drive().planner.accept(PoseGoal(position, quaternion))


def test_a_slight_tilt_of_an_estimate_is_no_fault():
    run = drive()
    tilted = Rotation.from_euler("ZYX", [10.0, 2.0, -3.0], degrees=True).as_quat()
    run.planner.accept(PoseGoal(np.array([0.5, 0.0, 10.0]), tilted))
    assert run.until_finished().success
    np.testing.assert_allclose(run.references[-1].quaternion[-1], heading(10.0), atol=1e-12)


ROCK = Obstacle.model_validate(
    {"name": "rock", "sphere": {"center_m": [4.0, 0.0, 10.0], "radius_m": 0.5}}
)


def test_a_way_through_an_obstacle_is_refused_and_one_past_it_is_not():
    run = drive(obstacles=(ROCK,))
    with pytest.raises(GoalRejected, match=r"not clear: .* and rock come within"):
        run.planner.accept(pose(8.0))
    run.planner.accept(pose(0.0, 8.0))
    assert run.until_finished().success


def test_the_seabed_bounds_the_depth():
    vehicle = load_vehicle(None, {"environment.seabed_depth_m": 12.0})
    run = drive(vehicle)
    with pytest.raises(GoalRejected, match=r"its depth is 11.9 m, allowed|seabed come within"):
        run.planner.accept(pose(z=11.9))


def test_weak_thrusters_make_it_slower():
    run = drive()
    solver = run.planner._solver
    before, weaker = _duration(drive(), pose(6.0)), 12.0
    solver.around = solver.around._replace(shares=weaker * solver.around.shares)
    after = _duration(run, pose(6.0))
    assert after > 1.2 * before
    other = drive()
    other.planner._solver.around = solver.around
    with pytest.raises(GoalRejected, match=r"thruster 1 would have to give .*; allow \d"):
        other.planner.accept(pose(6.0, duration_s=before + 0.1))


def _duration(run, goal) -> float:
    run.planner.accept(goal)
    return run.advance().feedback.duration


def test_another_vehicle_by_its_own_limits():
    """BlueROV2 is faster sideways and up, and must not be ahead, where nothing holds its pitch."""
    slow, fast = reference_vehicle(), load_vehicle(vehicle_path("bluerov2_alpha5"))
    stowed = tuple(fast.arm.stowed_deg)

    def times(*position) -> tuple[float, float]:
        return _duration(drive(fast, stowed), pose(*position)), _duration(
            drive(slow), pose(*position)
        )

    sideways, reference = times(0.0, 6.0)
    assert sideways < 0.5 * reference
    ahead, reference = times(6.0)
    assert ahead > 4 * sideways
    assert ahead == pytest.approx(reference, rel=0.1)
