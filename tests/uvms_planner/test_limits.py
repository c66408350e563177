import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from planner_rig import START, reference_vehicle

from uvms_dynamics import build_model
from uvms_planner.config import LimitsConfig, PlannerConfig
from uvms_planner.limits import JointLimits, MotionLimits, StepLimits
from uvms_planner.methods.arm_only import ArmOnly

JOINTS = JointLimits.of(reference_vehicle())
GIVEN = LimitsConfig(
    translation_rate_m_s=0.05,
    translation_acceleration_m_s2=0.01,
    yaw_rate_deg_s=1.0,
    yaw_acceleration_deg_s2=0.5,
    base_joint_rate_deg_s=4.0,
    depth_min_m=0.4,
)
LIMITS = StepLimits.of(
    MotionLimits.of(reference_vehicle(), build_model(reference_vehicle()), GIVEN), 0.5
)


def test_a_step_is_at_most_what_the_rates_allow():
    assert np.rad2deg(LIMITS.reach[4]) == pytest.approx(2.0)  # base joint: 2 degrees a step
    assert LIMITS.reach[:3] == pytest.approx([0.025] * 3)
    assert np.all(LIMITS.reach[4:] <= JOINTS.rate * 0.5)
    assert np.all(LIMITS.jump[4:] <= JOINTS.acceleration * 0.25)
    lower, upper = LIMITS.increments(START, np.zeros(8))
    assert np.all(upper <= LIMITS.reach)
    assert np.all(-lower <= LIMITS.reach)
    assert np.all(upper <= LIMITS.jump + 1e-15)


@given(
    share=st.lists(st.floats(0.02, 0.98), min_size=4, max_size=4),
    choice=st.lists(st.floats(0.0, 1.0), min_size=60, max_size=60),
)
@settings(max_examples=60, deadline=None)
def test_whatever_is_chosen_within_the_bounds_stays_within_limits_rates_and_accelerations(
    share, choice
):
    low, high = LIMITS.lower[4:], LIMITS.upper[4:]
    configuration = START.copy()
    configuration[4:] = low + np.array(share) * (high - low)
    previous = np.zeros(8)
    for pick in choice:
        lower, upper = LIMITS.increments(configuration, previous)
        assert np.all(lower <= upper)
        increment = lower + (round(pick) if pick > 0.3 else pick) * (upper - lower)
        assert np.all(np.abs(increment) <= LIMITS.reach + 1e-12)
        assert np.all(np.abs(increment - previous) <= LIMITS.jump + 1e-12)
        configuration, previous = configuration + increment, increment
        assert np.all(LIMITS.violation(configuration) <= 1e-12)


def test_a_joint_that_is_driven_at_its_limit_arrives_there_and_stops():
    configuration, previous = START.copy(), np.zeros(8)
    for _ in range(400):
        increment = LIMITS.increments(configuration, previous)[1]
        configuration, previous = configuration + increment, increment
    gap = LIMITS.upper[4:] - configuration[4:]
    assert np.all(gap >= -1e-12)
    assert np.all(gap < np.deg2rad(0.2))


def test_what_is_beyond_a_bound_may_come_back_but_not_go_on():
    configuration = START.copy()
    configuration[2] = 0.1  # above the least depth
    lower, upper = LIMITS.increments(configuration, np.zeros(8))
    assert lower[2] == 0.0
    assert upper[2] > 0.0
    lower, upper = LIMITS.rate_increments(configuration)
    assert lower[2] == 0.0
    assert upper[2] == LIMITS.reach[2]
    assert LIMITS.violation(configuration)[2] == pytest.approx(0.3)


def test_holding_the_vehicle_leaves_the_joints_their_freedom():
    bounds = LIMITS.increments(START, np.zeros(8))
    held = ArmOnly(reference_vehicle(), PlannerConfig(), 1).bounds(*bounds)
    for side in range(2):
        assert np.all(held[side][:4] == 0.0)
        assert np.array_equal(held[side][4:], bounds[side][4:])
