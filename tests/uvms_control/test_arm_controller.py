"""The arm's law: sampled gains are stable at every period, for every joint of the vehicle."""

import numpy as np
import pytest
from closed_loop import PERIOD, at_rest, hold, joint_motion, run
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from uvms_control import ArmControlConfig, ArmController, ControlConfig, Controller
from uvms_control.arm_controller import JointAim
from uvms_control.arm_gains import (
    NOISE_SHARE,
    RADIANS_PER_PERIOD,
    WHOLE_EFFORT_ERROR_RAD,
    arm_gains,
    floating_inertia,
    sampled_gains,
)
from uvms_control.errors import ControlSetupError
from uvms_control.vehicle_data import effort_limits
from uvms_core.vehicle import joint_limits, load_vehicle
from uvms_dynamics import (
    build_model,
    forward_dynamics,
    inverse_dynamics,
    joint_passive_torque,
    mass_matrix,
)
from uvms_dynamics.joint_prediction import encoder_variances
from uvms_dynamics.payload import with_payload

VEHICLE = load_vehicle()
MODEL = build_model(VEHICLE)
LOWER, UPPER = joint_limits(VEHICLE)
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
    data = VEHICLE.arm.joints[joint]
    gains = arm_gains(VEHICLE, PERIOD, ArmControlConfig())
    k, d = gains.stiffness[joint], gains.damping[joint]
    friction = data.viscous_friction_nm_s
    if not sliding:
        friction += data.coulomb_friction_nm / np.radians(data.coulomb_width_deg_s)
    damping = friction / data.rotor_inertia_kg_m2
    # Friction at the steered rate (k / d) e adds to the stiffness, the joint's own damps it.
    stiffness = k + damping * k / d
    loop = sampled_loop(stiffness, d, PERIOD, inertia_ratio, damping / inertia_ratio)
    assert np.max(np.abs(np.linalg.eigvals(loop))) < (0.98 if sliding else 0.998)


def test_the_least_bound_sets_the_bandwidth():
    rule = arm_gains(VEHICLE, PERIOD, ArmControlConfig())
    assert rule.limited_by == ("period",) * 4
    assert np.allclose(rule.bandwidth * PERIOD, 0.3)
    fast = arm_gains(VEHICLE, 0.005, ArmControlConfig())
    assert np.all(fast.bandwidth < 0.3 / 0.005)
    assert "period" not in fast.limited_by
    mine = arm_gains(VEHICLE, PERIOD, ArmControlConfig(bandwidth=3.0))
    assert np.array_equal(mine.bandwidth, np.full(4, 3.0))
    assert mine.limited_by == ("config",) * 4


@pytest.mark.parametrize("name", ["reference_auv", "bluerov2_alpha5", "reference_auv_light"])
@pytest.mark.parametrize("period", [0.002, 0.02, 0.05, 0.2])
def test_bounds_of_the_rule_hold(name, period):
    vehicle = load_vehicle(name)
    gains = arm_gains(vehicle, period, ArmControlConfig())
    effort, (s_q, s_rate) = effort_limits(vehicle), np.sqrt(encoder_variances(vehicle))
    w = gains.bandwidth
    slack = 1.0 + 1e-9
    assert np.all(w * period <= RADIANS_PER_PERIOD * slack)
    assert np.all(w**2 * gains.inertia * WHOLE_EFFORT_ERROR_RAD <= effort * slack)
    noise = gains.inertia * (w**2 * s_q + 2.0 * w * s_rate)
    assert np.all(noise <= NOISE_SHARE * effort * slack)


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


def controller(limits=None):
    limits = effort_limits(VEHICLE) if limits is None else limits
    arm = ArmController(limits, 10.0, 1.0)
    arm.gains = arm_gains(VEHICLE, PERIOD, ArmControlConfig())
    return arm


def torque(arm, q, aim, load=None, q_dot=None):
    """Effort (n,) at rest and level, and what holds the joints there without any feedback."""
    zero = np.zeros(4)
    load = zero if load is None else load
    motion = np.array([0.0, 0.0, 0.0, 1.0]), np.zeros(6), np.zeros(6)
    joints = np.array([q, zero if q_dot is None else q_dot, load])
    effort, drive = arm.step(MODEL, motion, mass_matrix(MODEL, q), joints, aim)
    hold = inverse_dynamics(MODEL, *motion, q, joints[1], zero)[6:] - load
    return effort, drive, hold


angles = st.lists(st.floats(-4.0, 4.0), min_size=4, max_size=4).map(np.array)
rates = st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=4).map(np.array)


@settings(deadline=None, max_examples=60)
@given(q=angles, aim=angles, rate=rates, acceleration=rates, load=rates)
def test_no_torque_presses_into_a_stop(q, aim, rate, acceleration, load):
    """Beyond a limit the drive at most holds what model and load need there."""
    effort, _, _ = torque(controller(), q, JointAim(aim, rate, acceleration), load)
    assert np.all(np.isfinite(effort))
    arm = controller(np.full(4, 1e6))
    full, _, hold = torque(arm, q, JointAim(aim, np.zeros(4), np.zeros(4)), load)
    slope = arm.gains.stiffness / arm.gains.damping * (np.clip(aim, LOWER, UPPER) - q)
    friction = -joint_passive_torque(MODEL, 0.5 * (LOWER + UPPER), slope)
    assert np.all(full[q >= UPPER] <= (hold + friction)[q >= UPPER] + 1e-9)
    assert np.all(full[q <= LOWER] >= (hold + friction)[q <= LOWER] - 1e-9)


@settings(deadline=None, max_examples=60)
@given(q=angles, aim=angles, load=rates)
def test_effort_stays_within_the_limits(q, aim, load):
    limits = np.array([1.0, 2.0, 3.0, 4.0])
    effort, _, _ = torque(controller(limits), q, JointAim(aim, aim, aim), load)
    assert np.all(np.abs(effort) <= limits)


@settings(deadline=None, max_examples=30)
@given(q=angles, aim=angles)
def test_the_drive_tells_what_its_limited_torque_brings(q, aim):
    """Acceleration = S^-1 (effort - what holds), as the observer will expect it."""
    q = np.clip(q, LOWER, UPPER)
    arm = controller(np.array([0.5, 0.5, 0.5, 0.05]))
    zero = np.zeros(4)
    effort, drive, hold = torque(arm, q, JointAim(aim, zero, zero))
    friction = -joint_passive_torque(MODEL, 0.5 * (LOWER + UPPER), drive.steered)
    expected = np.linalg.solve(floating_inertia(mass_matrix(MODEL, q)), effort - hold - friction)
    assert np.allclose(drive.acceleration, expected, atol=1e-9)


def test_a_load_that_was_found_is_made_up_for():
    load, aim = np.array([1.0, -2.0, 0.5, 0.0]), JointAim(FORWARD, np.zeros(4), np.zeros(4))
    without, _, _ = torque(controller(), FORWARD, aim)
    effort, _, _ = torque(controller(), FORWARD, aim, load)
    assert np.allclose(effort, without - load)


def test_wrong_effort_limits_are_named():
    with pytest.raises(ControlSetupError) as error:
        ArmController(np.array([1.0, 0.0]), 10.0, 1.0)
    assert str(error.value) == "arm effort limits: [1. 0.] N m, expected positive numbers"


@pytest.mark.parametrize("weight", [5.0, 15.0])
def test_an_unknown_payload_sags_little_and_is_held_within_a_second(weight):
    """Grasped at once: mass and weight that neither controller nor observer knows."""
    loaded = with_payload(MODEL, weight / 5.0, weight, np.array([0.0, 0.0, 0.1]))
    control = Controller(VEHICLE, ControlConfig(compensate_vehicle_motion=False))
    first = [s for _, s, _, _ in run(MODEL, control, at_rest(FORWARD), hold(FORWARD), 3.0)][-1]
    control.reset()
    states = [s for _, s, _, _ in run(loaded, control, at_rest(first.q), hold(FORWARD), 2.0)]
    sag = [np.abs(state.q - FORWARD).max() for state in states]
    assert max(sag) < np.radians(1.5 * weight / 5.0)
    assert max(sag[20:]) < np.radians(0.3)


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
