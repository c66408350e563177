"""The arm's law: sampled gains are stable at every period, for every joint of the vehicle."""

import numpy as np
import pytest
from closed_loop import PERIOD, at_rest, hold, joint_motion, run
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from uvms_control import ArmControlConfig, ArmController, ControlConfig, Controller
from uvms_control.arm_controller import floating_inertia, sampled_gains
from uvms_control.errors import ControlSetupError
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import build_model, forward_dynamics, mass_matrix

VEHICLE = load_vehicle()
MODEL = build_model(VEHICLE)
STOWED = np.radians([0.0, 0.0, 135.0, 0.0])
FORWARD = np.radians([0.0, 30.0, 60.0, 0.0])


def sampled_loop(k, d, dt, inertia_ratio=1.0, friction=0.0):
    """Transition matrix over a period of (e, e_dot) under a held torque.

    The joint: e_ddot = -friction e_dot + a, a = -(k e + d e_dot) / inertia_ratio at the sample.
    """
    free = np.array([[0.0, 1.0, 0.0], [0.0, -friction, 1.0], [0.0, 0.0, 0.0]])
    held = expm(free * dt)
    return held[:2, :2] + np.outer(held[:2, 2], [-k, -d]) / inertia_ratio


@settings(deadline=None)
@given(w=st.floats(0.1, 50.0), zeta=st.floats(0.3, 3.0), dt=st.floats(0.001, 0.2))
def test_sampled_gains_place_the_poles(w, zeta, dt):
    k, d = sampled_gains(w, zeta, dt)
    poles = np.roots([1.0, 2.0 * zeta * w, w * w])
    expected = np.poly(np.exp(poles * dt))
    assert np.allclose(np.poly(sampled_loop(k, d, dt)), expected, atol=1e-9)


def test_sampled_gains_tend_to_the_continuous_ones():
    assert sampled_gains(3.0, 0.8, 0.0) == pytest.approx((9.0, 4.8), rel=1e-12)
    assert np.allclose(sampled_gains(3.0, 0.8, 1e-4), (9.0, 4.8), rtol=1e-3)


@pytest.mark.parametrize("joint", range(4))
@pytest.mark.parametrize("inertia_ratio", [0.5, 0.75, 1.0, 2.0])
@pytest.mark.parametrize("sliding", [True, False])
def test_every_joint_is_stable_under_held_torques(joint, inertia_ratio, sliding):
    """With the friction that the joint has when it moves fast, and when it hardly moves.

    An inertia ratio of 0.5 is a joint half as heavy as the model believes. The lightest each joint
    can be is its rotor; there friction counts most.
    """
    data, config = VEHICLE.arm.joints[joint], ArmControlConfig()
    k, d = sampled_gains(config.bandwidth, config.damping_ratio, PERIOD)
    friction = data.viscous_friction_nm_s
    if not sliding:
        friction += data.coulomb_friction_nm / np.radians(data.coulomb_width_deg_s)
    damping = friction / data.rotor_inertia_kg_m2
    # Friction at the steered rate (k / d) e adds to the stiffness, the joint's own damps it.
    loop = np.eye(3)
    stiffness = k + damping * k / d
    loop[:2, :2] = sampled_loop(stiffness, d, PERIOD, inertia_ratio, damping / inertia_ratio)
    # The third state is the integral of the error, as an acceleration.
    loop[2, 0] = config.integral_rate * k * PERIOD
    from_torque = sampled_loop(1.0, 0.0, PERIOD, inertia_ratio, damping / inertia_ratio)
    without = sampled_loop(0.0, 0.0, PERIOD, inertia_ratio, damping / inertia_ratio)
    loop[:2, 2] = (from_torque - without)[:, 0]
    # Dry friction slows the integral's pole down, to a few seconds at most.
    assert np.max(np.abs(np.linalg.eigvals(loop))) < (0.98 if sliding else 0.998)


def test_the_law_has_the_slope_of_the_sampled_gains():
    config = ArmControlConfig()
    k, d = sampled_gains(config.bandwidth, config.damping_ratio, PERIOD)
    law = ArmController(config, np.ones(4)).law(PERIOD)
    assert np.allclose(law.stiffness, k)
    assert np.allclose(law.damping, d)


def test_floating_inertia_makes_torque_into_acceleration():
    """S a on the joints alone changes their acceleration by exactly a, vehicle free."""
    q, q_dot = FORWARD, np.array([0.1, -0.2, 0.1, 0.3])
    nu, level = np.array([0.2, -0.1, 0.1, 0.05, 0.1, -0.1]), np.array([0.0, 0.0, 0.0, 1.0])
    wanted = np.array([0.3, -0.2, 0.5, 1.0])
    extra = floating_inertia(mass_matrix(MODEL, q)) @ wanted
    tau = np.arange(10.0)
    before = forward_dynamics(MODEL, level, nu, q, q_dot, tau)
    tau[6:] += extra
    after = forward_dynamics(MODEL, level, nu, q, q_dot, tau)
    assert np.allclose(after[6:] - before[6:], wanted, atol=1e-10)


def test_effort_stays_within_the_limits():
    limits = np.array([1.0, 2.0, 3.0, 4.0])
    arm = ArmController(ArmControlConfig(), limits)
    effort = arm.effort(np.ones(4), np.zeros(4), 100.0 * np.eye(4), np.zeros(4), PERIOD)
    assert np.array_equal(effort, limits)
    assert np.array_equal(
        arm.effort(-np.ones(4), np.zeros(4), 100.0 * np.eye(4), np.zeros(4), PERIOD), -limits
    )


def test_the_integral_is_bounded_and_does_not_wind_up():
    config = ArmControlConfig(integral_limit=0.25)
    arm = ArmController(config, np.full(4, 2.0))
    small, zero, light = np.full(4, 1e-3), np.zeros(4), 0.1 * np.eye(4)
    for _ in range(5000):
        arm.effort(small, zero, light, zero, PERIOD)
    assert np.allclose(arm.integral, 0.5)
    arm.reset()
    for _ in range(100):
        arm.effort(np.ones(4), zero, 100.0 * light, zero, PERIOD)
    assert not arm.integral.any()


def test_wrong_effort_limits_are_named():
    with pytest.raises(ControlSetupError) as error:
        ArmController(ArmControlConfig(), np.array([1.0, 0.0]))
    assert str(error.value) == "arm effort limits: [1. 0.] N m, expected positive numbers"


@pytest.mark.parametrize("joint", range(4))
def test_every_joint_settles_from_an_offset(joint):
    """Full model, friction, free wrist: from 6 degrees off to under 0.2 degrees in 6 s."""
    start = FORWARD.copy()
    start[joint] += 0.1
    controller = Controller(VEHICLE, ControlConfig(compensate_vehicle_motion=False))
    states = [s for _, s, _, _ in run(MODEL, controller, at_rest(start), hold(FORWARD), 6.0)]
    assert np.max(np.abs(states[-1].q - FORWARD)) < np.radians(0.2)
    overshoot = max(FORWARD[joint] - s.q[joint] for s in states)
    assert overshoot < 0.02


def test_a_joint_motion_is_followed_closely():
    goal = np.radians([60.0, 20.0, 60.0, 45.0])
    reference = joint_motion(STOWED, goal, 10.0, 12.0)
    controller = Controller(VEHICLE, ControlConfig(compensate_vehicle_motion=False))
    worst = 0.0
    for t, state, _, _ in run(MODEL, controller, at_rest(STOWED), reference, 12.0):
        q = reference.q[min(round(t / PERIOD), reference.times.size - 1)]
        worst = max(worst, float(np.max(np.abs(state.q - q))))
    assert worst < np.radians(1.0)
