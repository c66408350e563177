"""Limits of the plan by rule from the vehicle file, and as the configuration gives them."""

from pathlib import Path

import numpy as np
import pytest
from planner_rig import drive, reference_vehicle

from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.frames import arm_length
from uvms_core.vehicle.resistance import axis_resistance
from uvms_dynamics import build_model, mass_matrix
from uvms_dynamics.external_bandwidth import thrust_authority
from uvms_planner import PathSpec, PlannerConfig
from uvms_planner.config import LimitsConfig
from uvms_planner.errors import PlannerError
from uvms_planner.limits import JointLimits, MotionLimits, StepLimits

VEHICLES = (
    "reference_auv",
    "reference_auv_heavy",
    "reference_auv_light",
    "reference_auv_three_thrusters",
    "bluerov2_alpha5",
)


def limits_of(vehicle, **given) -> MotionLimits:
    return MotionLimits.of(vehicle, build_model(vehicle), LimitsConfig.model_validate(given))


def with_thrust(vehicle, factor: float):
    thrusters = tuple(
        thruster.model_copy(
            update={"limit_n": factor * thruster.greatest_n, "limits_n": None, "curve": None}
        )
        for thruster in vehicle.thrusters
    )
    return vehicle.model_copy(update={"thrusters": thrusters})


@pytest.mark.parametrize("name", VEHICLES)
def test_every_vehicle_has_limits_that_its_thrust_can_hold(name):
    vehicle = load_vehicle(name)
    limits = limits_of(vehicle)
    m = 4 + vehicle.n_joints
    for values in (limits.lower, limits.upper, limits.rate, limits.acceleration):
        assert values.shape == (m,)
    assert np.all(limits.rate > 0.0)
    assert np.all(limits.acceleration > 0.0)
    assert np.all(limits.lower < limits.upper)
    linear, quadratic = axis_resistance(vehicle.hull, vehicle.environment.water_density_kg_m3)
    authority = thrust_authority(vehicle)
    drag = linear[:3] * limits.rate[:3] + quadratic[:3] * limits.rate[:3] ** 2
    held = authority[:3] > 0.0
    assert np.all(drag[held] <= 0.5 * authority[:3][held])  # the arm has drag besides


def test_in_the_plane_the_weaker_axis_counts_with_the_drag_of_hull_and_arm():
    vehicle = reference_vehicle()
    limits, sway = limits_of(vehicle), 98.0
    linear, quadratic = axis_resistance(vehicle.hull, vehicle.environment.water_density_kg_m3)
    bare = (-linear[1] + np.sqrt(linear[1] ** 2 + 2 * quadratic[1] * sway)) / (2 * quadratic[1])
    assert thrust_authority(vehicle)[1] == pytest.approx(sway)
    assert limits.rate[0] == limits.rate[1]
    assert 0.9 * bare < limits.rate[1] < bare
    q = np.radians(vehicle.arm.stowed_deg)
    mass = mass_matrix(build_model(vehicle), q)[1, 1]
    assert limits.acceleration[1] == pytest.approx(0.25 * sway / mass)


def test_twice_the_thrust_gives_twice_the_acceleration_and_at_most_twice_the_speed():
    vehicle = reference_vehicle()
    once, twice = limits_of(vehicle), limits_of(with_thrust(vehicle, 2.0))
    assert np.allclose(twice.acceleration[:3], 2.0 * once.acceleration[:3])
    ratio = twice.rate[:3] / once.rate[:3]
    assert np.all((ratio > np.sqrt(2.0)) & (ratio < 2.0))
    assert np.array_equal(twice.rate[4:], once.rate[4:])


@pytest.mark.parametrize("name", VEHICLES)
def test_a_turn_moves_the_tool_no_faster_than_the_vehicle_may_move(name):
    vehicle = load_vehicle(name)
    limits, base = limits_of(vehicle), vehicle.arm.base.position_m
    lever = np.hypot(base[0], base[1]) + arm_length(vehicle.arm)
    assert limits.rate[3] * lever <= limits.rate[0] * (1 + 1e-12)
    assert limits.acceleration[3] * lever <= limits.acceleration[0] * (1 + 1e-12)


def test_an_axis_without_thrust_takes_the_limits_of_the_slower_of_the_others():
    vehicle = load_vehicle("reference_auv_three_thrusters")
    limits = limits_of(vehicle)
    assert thrust_authority(vehicle)[1] == 0.0
    assert limits.rate[0] == limits.rate[2]
    assert limits.acceleration[0] == limits.acceleration[2]


def test_a_vehicle_without_thrust_needs_limits_that_are_given():
    vehicle = with_thrust(reference_vehicle(), 1.0)
    still = tuple(t.model_copy(update={"limit_n": 0.0}) for t in vehicle.thrusters)
    vehicle = vehicle.model_copy(update={"thrusters": still})
    with pytest.raises(PlannerError, match="give translation_rate_m_s"):
        limits_of(vehicle)
    given = {
        "translation_rate_m_s": 0.1,
        "translation_acceleration_m_s2": 0.02,
        "yaw_rate_deg_s": 3.0,
        "yaw_acceleration_deg_s2": 1.0,
    }
    assert limits_of(vehicle, **given).rate[:4] == pytest.approx([0.1] * 3 + [np.deg2rad(3.0)])


@pytest.mark.parametrize(
    ("field", "value", "where", "expected"),
    [
        ("translation_rate_m_s", 0.07, ("rate", slice(0, 3)), 0.07),
        ("translation_acceleration_m_s2", 0.03, ("acceleration", slice(0, 3)), 0.03),
        ("yaw_rate_deg_s", 2.0, ("rate", 3), np.deg2rad(2.0)),
        ("yaw_acceleration_deg_s2", 2.0, ("acceleration", 3), np.deg2rad(2.0)),
        ("base_joint_rate_deg_s", 2.0, ("rate", 4), np.deg2rad(2.0)),
        ("depth_min_m", 1.5, ("lower", 2), 1.5),
        ("depth_max_m", 15.0, ("upper", 2), 15.0),
    ],
)
def test_a_limit_that_is_given_counts_and_changes_no_other(field, value, where, expected):
    own, rule = limits_of(reference_vehicle(), **{field: value}), limits_of(reference_vehicle())
    name, index = where
    assert getattr(own, name)[index] == pytest.approx(expected)
    for other in ("lower", "upper", "rate", "acceleration"):
        same = getattr(own, other) == getattr(rule, other)
        if other == name:
            same[index] = True
        assert np.all(same), other


def test_the_hull_stays_between_surface_and_seabed():
    vehicle = reference_vehicle()
    radius = np.cbrt(3 * vehicle.hull.volume_m3 / (4 * np.pi))
    limits = limits_of(vehicle)
    assert limits.lower[2] == pytest.approx(radius)
    seabed = vehicle.environment.model_copy(update={"seabed_depth_m": 20.0})
    low = limits_of(vehicle.model_copy(update={"environment": seabed}))
    assert low.upper[2] == pytest.approx(20.0 - radius)
    bottomless = vehicle.environment.model_copy(update={"seabed_depth_m": None})
    assert limits_of(vehicle.model_copy(update={"environment": bottomless})).upper[2] == np.inf


def test_joints_have_their_margin_and_their_share():
    vehicle, config = reference_vehicle(), LimitsConfig()
    limits, joints = limits_of(vehicle), JointLimits.of(vehicle)
    assert np.allclose(limits.rate[4:], config.joint_rate_fraction * joints.rate)
    assert np.allclose(
        limits.acceleration[4:], config.joint_acceleration_fraction * joints.acceleration
    )
    assert np.allclose(np.rad2deg(limits.lower[4:] - joints.lower), config.joint_margin_deg)
    assert np.allclose(np.rad2deg(joints.upper - limits.upper[4:]), config.joint_margin_deg)
    assert (limits.roll_max, limits.pitch_max) == pytest.approx(np.deg2rad([5.0, 4.0]))


def test_a_step_has_the_limits_of_the_motion():
    limits, config = limits_of(reference_vehicle()), PlannerConfig()
    step = StepLimits.of(limits, config.step_s)
    assert np.allclose(step.reach / config.step_s, limits.rate)
    assert np.allclose(step.jump / config.step_s**2, limits.acceleration)
    assert np.array_equal(step.lower, limits.lower)


def test_twenty_metres_in_five_hundred_seconds_are_accepted():
    run = drive(method="vehicle_only")
    spec = PathSpec.model_validate({"line": {"to_m": [20.0, 0.0, 0.0], "duration_s": 500.0}})
    run.planner.accept(spec.goal(*run.planner.end_effector))
    result = run.until_finished()
    assert result.success
    way = run.joined("end_effector")[-1] - run.joined("end_effector")[0]
    assert way == pytest.approx([20.0, 0.0, 0.0], abs=1e-6)


@pytest.mark.parametrize("name", VEHICLES)
def test_the_page_on_paths_has_the_limits_of_every_vehicle(name):
    vehicle = load_vehicle(name)
    limits = limits_of(vehicle)
    rate, acceleration = limits.rate, limits.acceleration
    numbers = (
        f"{rate[0]:.2f} | {rate[2]:.2f} | {np.degrees(rate[3]):.1f}",
        f"{acceleration[0]:.3f} | {acceleration[2]:.3f} | {np.degrees(acceleration[3]):.1f}",
        f"{limits.lower[2]:.2f}",
    )
    page = Path(__file__).parents[2] / "docs/paths.md"
    assert f"| `{name}` | {' | '.join(numbers)} |" in page.read_text(encoding="utf-8")
