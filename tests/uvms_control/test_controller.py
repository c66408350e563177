"""Checks of the controller's inputs: error messages, and that a bad input changes nothing."""

from dataclasses import replace

import numpy as np
import pytest
from closed_loop import at_rest, hold
from pydantic import ValidationError

from uvms_control import ControlConfig, Controller, VehicleControlConfig
from uvms_core.errors import SignalError
from uvms_core.signals import Wrench, to_nanoseconds
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.joint_prediction import joint_age_limit

VEHICLE = load_vehicle()
STOWED = np.radians([0.0, 0.0, 135.0, 0.0])
TICK = 50_000_000
JOINT_AGE_LIMIT_S = joint_age_limit(VEHICLE, 0.05)
TOO_OLD = TICK - to_nanoseconds(JOINT_AGE_LIMIT_S) - 1


def inputs(stamp=TICK):
    odometry, joints = at_rest(STOWED).estimates(stamp)
    return odometry, joints, Wrench(stamp, np.zeros(6)), hold(STOWED)


def with_nan(array, *index):
    out = np.array(array, dtype=float)
    out[index] = np.nan
    return out


def bad_inputs():
    odometry, joints, disturbance, reference = inputs()
    yield (
        (replace(odometry, nu=with_nan(odometry.nu, 4)), joints, disturbance, reference),
        "odometry.nu[4] is nan; it must be finite",
    )
    yield (
        (replace(odometry, position=np.zeros(2)), joints, disturbance, reference),
        "odometry.position has shape (2,); it must have (3,)",
    )
    yield (
        (replace(odometry, quaternion=np.ones(4)), joints, disturbance, reference),
        "odometry.quaternion has length 2; it must be 1",
    )
    yield (
        (odometry, replace(joints, position=np.zeros(3)), disturbance, reference),
        "joint_states.position has shape (3,); it must have (4,) for swing, shoulder, elbow, wrist",
    )
    yield (
        (odometry, replace(joints, velocity=with_nan(joints.velocity, 0)), disturbance, reference),
        "joint_states.velocity[swing] is nan; it must be finite",
    )
    yield (
        (odometry, replace(joints, stamp=TOO_OLD), disturbance, reference),
        f"joint_states: stamp {TOO_OLD} ns; it must lie within {JOINT_AGE_LIMIT_S:g} s before the "
        f"odometry's, {TICK} ns",
    )
    yield (
        (odometry, joints, Wrench(TICK, with_nan(np.zeros(6), 2)), reference),
        "disturbance.wrench[2] is nan; it must be finite",
    )
    yield (
        (odometry, joints, Wrench(TICK + 7, np.zeros(6)), reference),
        f"disturbance: stamp {TICK + 7} ns; it must lie within 0.5 s before the odometry's, "
        f"{TICK} ns",
    )
    yield (
        (odometry, joints, disturbance, replace(reference, q=with_nan(reference.q, 0, 3))),
        "reference.q[0, wrist] is nan; it must be finite",
    )


@pytest.mark.parametrize(("given", "message"), bad_inputs())
def test_a_bad_input_is_named_and_changes_nothing(given, message):
    controller, untouched = (Controller(VEHICLE, ControlConfig()) for _ in range(2))
    with pytest.raises(SignalError) as error:
        controller.step(*given)
    assert str(error.value) == message
    found, expected = controller.step(*inputs()), untouched.step(*inputs())
    assert np.array_equal(found[0].wrench, expected[0].wrench)
    assert np.array_equal(found[1].effort, expected[1].effort)


def test_time_must_go_on_until_a_reset():
    controller = Controller(VEHICLE, ControlConfig())
    controller.step(*inputs())
    with pytest.raises(SignalError) as error:
        controller.step(*inputs())
    assert str(error.value) == (
        f"odometry.stamp is {TICK} ns; it must be after the last one's, {TICK} ns"
    )
    controller.reset()
    controller.step(*inputs())


def test_commands_carry_the_stamp_of_the_odometry():
    wrench, command = Controller(VEHICLE, ControlConfig()).step(*inputs())
    assert wrench.stamp == command.stamp == TICK
    assert wrench.wrench.shape == (6,)
    assert command.effort.shape == (4,)


def test_a_missing_disturbance_is_no_disturbance():
    odometry, joints, _, reference = inputs()
    known = Wrench(TICK, np.array([1.0, -2.0, 3.0, 0.5, -0.5, 0.2]))
    found = [
        Controller(VEHICLE, ControlConfig(observer=observer))
        .step(odometry, joints, disturbance, reference)[0]
        .wrench
        for observer, disturbance in ((True, known), (True, None), (False, known))
    ]
    assert np.allclose(found[0], found[1] - known.wrench)
    assert np.array_equal(found[1], found[2])


def test_configuration_bounds_hold():
    with pytest.raises(ValidationError, match="at least 6 items"):
        VehicleControlConfig(k_error=(1.0,) * 5)
    with pytest.raises(ValidationError, match="greater than 0"):
        VehicleControlConfig(k_rate=(1.0, 1.0, 0.0, 1.0, 1.0, 1.0))
    with pytest.raises(ValidationError, match="Extra inputs are not permitted"):
        ControlConfig(kp=1.0)
