"""The law `paper`, eq. (22): exact with an exact model, convergent, steadier with feed-forward."""

import numpy as np
import pytest
from closed_loop import PERIOD, at_rest, hold, joint_motion, observed, run
from trajectories import reference as moving_reference
from trajectories import vehicle as vehicle_motion

from uvms_control import (
    AllocatorConfig,
    ControlConfig,
    PaperController,
    ThrustAllocator,
    VehicleControlConfig,
)
from uvms_core.signals import JointStates, Odometry, Wrench
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import build_model, forward_dynamics
from uvms_dynamics.kernels.rotations import (
    quat_conjugate,
    quat_multiply,
    quat_to_rotation_vector,
    quat_to_rpy,
    rpy_to_quat,
)

VEHICLE = load_vehicle()
MODEL = build_model(VEHICLE)
STOWED = np.radians([0.0, 0.0, 135.0, 0.0])
STARBOARD = np.radians([90.0, 0.0, 0.0, 0.0])
NO_FRICTION_COMPENSATION = {"friction_compensation": 0.0}


@pytest.mark.parametrize("t", [0.0, 0.4, 1.3, 2.9])
def test_zero_error_reproduces_the_reference_acceleration(t):
    """With the exact model and disturbance, forward dynamics returns nu_dot_d and q_ddot_d."""
    reference = moving_reference([0.0, 0.5], start=t)
    config = ControlConfig(arm=NO_FRICTION_COMPENSATION, compensate_vehicle_motion=False)
    controller = PaperController(VEHICLE, config)
    position, quaternion, nu, nu_dot = vehicle_motion(t)
    q, q_dot, q_ddot = (getattr(reference, n)[0] for n in ("q", "q_dot", "q_ddot"))
    state = at_rest(q, position, quaternion)
    state.nu[:], state.q_dot[:] = nu, q_dot
    odometry, joints = state.estimates(0)
    disturbance = Wrench(0, observed(MODEL, state, q_ddot))
    wrench, command = controller.step(odometry, joints, disturbance, reference)
    tau = np.concatenate((wrench.wrench, command.effort))
    limits = np.array([joint.effort_limit_nm for joint in VEHICLE.arm.joints])
    assert np.all(np.abs(command.effort) < limits)
    found = forward_dynamics(MODEL, quaternion, nu, q, q_dot, tau)
    assert np.allclose(found, np.concatenate((nu_dot, q_ddot)), rtol=1e-9, atol=1e-9)


def attitude_error(state, quaternion):
    return quat_to_rotation_vector(quat_multiply(quat_conjugate(state.quaternion), quaternion))


@pytest.mark.parametrize(
    ("rpy", "offset"),
    [
        ((0.0, 0.0, 0.0), (1.0, -0.5, 0.7)),
        ((0.0, 0.0, 3.0), (-0.6, 1.0, 0.4)),
        ((0.5, -0.4, 1.5), (0.5, 0.5, -1.0)),
        ((0.3, 1.2, -2.5), (0.4, -0.8, 0.3)),
    ],
)
def test_vehicle_converges_from_any_attitude(rpy, offset):
    """From metres and large angles away, to a level or tilted pose, within the thrusters."""
    goal = rpy_to_quat(*rpy)
    start = quat_multiply(goal, rpy_to_quat(0.3, -0.3, 0.6))
    reference = hold(STOWED, offset, goal)
    controller = PaperController(VEHICLE, ControlConfig(compensate_vehicle_motion=False))
    allocator = ThrustAllocator(VEHICLE, AllocatorConfig())
    states = [
        s for _, s, _, _ in run(
            MODEL, controller, at_rest(STOWED, quaternion=start), reference, 40.0,
            allocator=allocator, lag=0.15,
        )
    ]  # fmt: skip
    last = states[-1]
    assert np.linalg.norm(last.position - offset) < 0.01
    assert np.linalg.norm(attitude_error(last, goal)) < np.radians(0.3)
    assert np.linalg.norm(last.nu) < 0.01


def swing_attitude(observer):
    """Largest roll and pitch (degrees) while the arm swings out to starboard in 10 s."""
    reference = joint_motion(STOWED, STARBOARD, 10.0, 20.0)
    config = ControlConfig(observer=observer, compensate_vehicle_motion=False)
    controller = PaperController(VEHICLE, config)
    angles = [
        np.degrees(quat_to_rpy(state.quaternion))
        for _, state, _, _ in run(
            MODEL, controller, at_rest(STOWED), reference, 20.0,
            allocator=ThrustAllocator(VEHICLE, AllocatorConfig()), lag=0.15,
        )
    ]  # fmt: skip
    return np.max(np.abs(angles), axis=0)


def test_feed_forward_keeps_the_vehicle_upright_in_the_arm_swing():
    with_observer, without = swing_attitude(True), swing_attitude(False)
    assert with_observer[0] < 1.5
    assert with_observer[1] < 1.0
    assert without[0] > 5.0 * with_observer[0]


def test_a_moving_reference_is_tracked():
    """Turning and translating with feed-forward of rate and acceleration, arm in motion."""
    reference = moving_reference(np.arange(401) * PERIOD)
    start = at_rest(reference.q[0], reference.position[0], reference.quaternion[0])
    start.nu[:], start.q_dot[:] = reference.nu[0], reference.q_dot[0]
    controller = PaperController(VEHICLE, ControlConfig(compensate_vehicle_motion=False))
    worst_position = worst_attitude = 0.0
    for t, state, _, _ in run(MODEL, controller, start, reference, 20.0):
        k = round(t / PERIOD)
        worst_position = max(
            worst_position, float(np.linalg.norm(state.position - reference.position[k]))
        )
        error = np.linalg.norm(attitude_error(state, reference.quaternion[k]))
        worst_attitude = max(worst_attitude, float(error))
    assert worst_position < 0.04
    assert worst_attitude < np.radians(2.0)


def test_disabled_control_leaves_the_vehicle_free_and_the_arm_driven():
    reference = joint_motion(STOWED, STARBOARD, 10.0, 14.0)
    controller = PaperController(VEHICLE, ControlConfig(enabled=False))
    rolls = []
    for _, state, wrench, _ in run(MODEL, controller, at_rest(STOWED), reference, 14.0):
        assert not wrench.any()
        rolls.append(np.degrees(quat_to_rpy(state.quaternion)[0]))
    assert np.allclose(state.q, STARBOARD, atol=np.radians(1.0))
    assert 20.0 < max(rolls) < 32.0


def offset_under_push(controller, push, duration):
    """Distance from the reference at the end, under a wrench that nobody observes."""
    loop = run(MODEL, controller, at_rest(STOWED), hold(STOWED), duration, push=np.array(push))
    return float(np.linalg.norm(list(loop)[-1][1].position))


def test_the_integral_removes_what_nobody_observes():
    push = (3.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    plain = PaperController(VEHICLE, ControlConfig(compensate_vehicle_motion=False))
    integral = PaperController(
        VEHICLE,
        ControlConfig(
            compensate_vehicle_motion=False,
            vehicle=VehicleControlConfig(k_integral=(0.3, 0.3, 0.3, 0.0, 0.0, 0.0)),
        ),
    )
    left, removed = (offset_under_push(c, push, 25.0) for c in (plain, integral))
    assert left > 0.005
    assert removed < 0.1 * left


def test_the_integral_is_bounded():
    config = VehicleControlConfig(k_integral=(1.0,) * 6, integral_limit=0.2)
    controller = PaperController(VEHICLE, ControlConfig(vehicle=config))
    near = np.full(3, 0.05)
    for k in range(400):
        odometry = Odometry(
            k * 50_000_000, -near, np.array([0.0, 0.0, 0.0, 1.0]), np.zeros(6),
            np.zeros((6, 6)), np.zeros((6, 6)),
        )  # fmt: skip
        joints = JointStates(odometry.stamp, STOWED, np.zeros(4), np.zeros(4))
        controller.step(odometry, joints, None, hold(STOWED))
    assert np.allclose(controller.vehicle.delta_u[:3], 0.2)
    assert not controller.vehicle.delta_u[3:].any()


def test_the_integral_rests_while_the_law_is_saturated():
    config = VehicleControlConfig(k_integral=(1.0,) * 6)
    controller = PaperController(VEHICLE, ControlConfig(vehicle=config))
    far = hold(STOWED, (5.0, 0.0, 0.0))
    for k in range(3):
        odometry, joints = at_rest(STOWED).estimates(k * 50_000_000)
        controller.step(odometry, joints, None, far)
    assert not controller.vehicle.delta_u.any()
