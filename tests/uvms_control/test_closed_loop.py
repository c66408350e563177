"""Vehicle and arm together: tool steadiness, wrong models, noise, and the Lyapunov function."""

from dataclasses import replace

import numpy as np
import pytest
from closed_loop import PERIOD, at_rest, hold, joint_motion, run

from uvms_control import (
    AllocatorConfig,
    ControlConfig,
    Controller,
    PaperController,
    ThrustAllocator,
    lyapunov,
    sample_reference,
    tracking_error,
)
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import build_model, end_effector
from uvms_dynamics.kernels.rotations import quat_multiply, quat_to_rpy, rotation_vector_to_quat

VEHICLE = load_vehicle()
MODEL = build_model(VEHICLE)
STOWED = np.radians([0.0, 0.0, 135.0, 0.0])
WORKING = np.radians([20.0, 30.0, 60.0, 0.0])
STARBOARD = np.radians([90.0, 0.0, 0.0, 0.0])
TOOL, _ = end_effector(MODEL, np.zeros(3), np.array([0.0, 0.0, 0.0, 1.0]), WORKING)


LAWS = pytest.mark.parametrize("law", [Controller, PaperController], ids=["default", "paper"])


def tool_errors(law, compensate, duration=20.0):
    """Distance of the tool from its target, under a push that no observer estimates."""
    controller = law(VEHICLE, ControlConfig(compensate_vehicle_motion=compensate))
    push = np.array([3.0, -3.0, 4.0, 0.3, 1.0, 1.0])
    reference = hold(WORKING, tool=TOOL)
    loop = run(
        MODEL, controller, at_rest(WORKING), reference, duration,
        allocator=ThrustAllocator(VEHICLE, AllocatorConfig()), lag=0.15, push=push,
    )  # fmt: skip
    tools = [end_effector(MODEL, s.position, s.quaternion, s.q)[0] for _, s, _, _ in loop]
    return np.linalg.norm(np.array(tools) - TOOL, axis=1)


@LAWS
def test_the_arm_holds_the_tool_where_the_vehicle_gives_way(law):
    without, with_it = tool_errors(law, False), tool_errors(law, True)
    assert without[-1] > 0.001
    assert with_it[-1] < 0.1 * without[-1]
    assert np.max(with_it) < np.max(without)


def test_the_default_law_gives_way_less_than_the_paper_s():
    """To a push that nobody observes: its stiffness is what the thrusters' lag allows."""
    assert tool_errors(Controller, False)[-1] < 0.2 * tool_errors(PaperController, False)[-1]


def test_lyapunov_function_of_the_paper_falls_along_a_run():
    controller = PaperController(VEHICLE, ControlConfig(compensate_vehicle_motion=False))
    start = at_rest(
        STOWED, (0.03, -0.02, 0.02), rotation_vector_to_quat(np.array([0.02, 0.03, -0.02]))
    )
    reference, law = hold(STOWED), controller.vehicle.law
    values = []
    for _, state, _, _ in run(MODEL, controller, start, reference, 10.0):
        odometry, _ = state.estimates(0)
        found = tracking_error(odometry, sample_reference(reference, 0))
        values.append(float(lyapunov(found.error, found.rate, law.stiffness, law.damping)))
    falling = np.array(values[: np.argmax(np.array(values) < 1e-3 * values[0])])
    assert falling.size > 20
    assert np.all(np.diff(falling) < 0.0)
    assert max(values[falling.size :]) < 1e-3 * values[0]


def test_lyapunov_function_of_the_default_law_falls_along_a_run():
    """Its own V, with the hull's righting stiffness in P, as it is published."""
    controller = Controller(VEHICLE, ControlConfig(compensate_vehicle_motion=False))
    controller.prepare(PERIOD)
    start = at_rest(
        STOWED, (0.01, -0.008, 0.006), rotation_vector_to_quat(np.array([0.02, 0.03, -0.02]))
    )
    values = [
        controller.stability.lyapunov for _ in run(MODEL, controller, start, hold(STOWED), 10.0)
    ]
    falling = np.array(values[: np.argmax(np.array(values) < 1e-3 * values[0])])
    assert falling.size > 10
    assert np.all(np.diff(falling) < 0.0)
    assert max(values[falling.size :]) < 1e-3 * values[0]


@pytest.mark.parametrize(
    "unknown",
    [
        {"arm.links.3.mass_kg": VEHICLE.arm.links[3].mass_kg + 5.0 / 9.81},
        {"hull.linear_damping": [20.0, 40.0, 40.0, 10.0, 150.0, 40.0]},
        {"hull.quadratic_damping": [5.0, 100.0, 100.0, 0.2, 30.0, 30.0]},
    ],
    ids=["payload of 5 N", "twice the linear damping", "a quarter of the quadratic damping"],
)
@LAWS
def test_what_the_model_does_not_know_is_survived(unknown, law):
    """The real vehicle differs from the controller's; the arm swings out and settles."""
    real = build_model(load_vehicle(overrides=unknown))
    controller = law(VEHICLE, ControlConfig(compensate_vehicle_motion=False))
    reference = joint_motion(STOWED, STARBOARD, 10.0, 25.0)
    states = [
        s for _, s, _, _ in run(
            real, controller, at_rest(STOWED), reference, 25.0, observer=MODEL,
            allocator=ThrustAllocator(VEHICLE, AllocatorConfig()), lag=0.15,
        )
    ]  # fmt: skip
    attitude = np.degrees([quat_to_rpy(s.quaternion) for s in states])
    assert np.max(np.abs(attitude[:, 0])) < 12.0
    assert np.max(np.abs(attitude[:, 1])) < 4.0
    assert np.max(np.abs(states[-1].q - STARBOARD)) < np.radians(0.2)
    assert np.linalg.norm(states[-1].nu) < 0.01


@pytest.mark.parametrize(
    ("law", "joints"), [(Controller, 5e-3), (PaperController, 2e-3)], ids=["default", "paper"]
)
def test_sensor_noise_is_not_amplified(law, joints):
    """The vehicle keeps still within the noise, which is white here: worse than a filter's.

    The arm, rad, feels what the law makes of it: the default law is stiffer by 5 to 20 times.
    """
    rng = np.random.default_rng(2)

    def noisy(_, state):
        turn = rotation_vector_to_quat(0.002 * rng.normal(size=3))
        return replace(
            state,
            position=state.position + 0.01 * rng.normal(size=3),
            quaternion=quat_multiply(state.quaternion, turn),
            nu=state.nu + np.repeat([0.005, 0.002], 3) * rng.normal(size=6),
            q=state.q + 2e-4 * rng.normal(size=4),
            q_dot=state.q_dot + 2e-3 * rng.normal(size=4),
        )

    controller = law(VEHICLE, ControlConfig(compensate_vehicle_motion=False))
    loop = run(
        MODEL, controller, at_rest(WORKING), hold(WORKING), 30.0,
        allocator=ThrustAllocator(VEHICLE, AllocatorConfig()), lag=0.15, noise=noisy,
    )  # fmt: skip
    states = [state for t, state, _, _ in loop if t > 100 * PERIOD]
    assert np.std([s.position for s in states], axis=0).max() < 0.01
    assert np.std([quat_to_rpy(s.quaternion) for s in states], axis=0).max() < 0.002
    assert np.std([s.q for s in states], axis=0).max() < joints
