"""Unknown loads are found from torques and encoders; late samples are carried to the tick."""

import numpy as np
import pytest

from uvms_control import ArmControlConfig
from uvms_control.arm_gains import arm_gains
from uvms_control.vehicle_data import effort_limits
from uvms_core.signals import JointStates, to_nanoseconds
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import build_model
from uvms_dynamics.joint_filter import JointDrive, JointFilter, JointProcess
from uvms_dynamics.joint_prediction import encoder_variances
from uvms_dynamics.kernels import layout

VEHICLE = load_vehicle()
PERIOD = 0.05
EFFORT = effort_limits(VEHICLE)
INERTIA = np.diag([2.0, 1.5, 0.5, 0.1])
VARIANCES = encoder_variances(VEHICLE)


def frictionless():
    model = build_model(VEHICLE).copy()
    model[1:5, [layout.VISCOUS, layout.COULOMB]] = 0.0
    return model


def observer(model=None, variances=VARIANCES):
    gains = arm_gains(VEHICLE, PERIOD, ArmControlConfig())
    process = JointProcess(gains.drift, gains.shake, EFFORT / gains.inertia)
    return JointFilter(frictionless() if model is None else model, 0.5 * EFFORT, variances, process)


def follow(watch, load, ticks, *, late=0, noise=None, push=None):
    """Joints that the load (n,) accelerates, S q_ddot = torque + load; yields estimate and truth.

    Samples come `late` ticks after their stamp. The commanded torque makes up for what the
    observer has found, and moves the joints by `push(k)`.
    """
    q, q_dot, samples = np.full(4, 0.3), np.zeros(4), []
    for k in range(ticks):
        stamp = to_nanoseconds(k * PERIOD)
        seen = np.zeros((2, 4)) if noise is None else noise()
        samples.append(JointStates(stamp, q + seen[0], q_dot + seen[1], np.zeros(4)))
        now = watch.step(samples[max(k - late, 0)], stamp).copy()
        yield now, np.array([q, q_dot, load])
        wanted = np.zeros(4) if push is None else push(k)
        answered = now[2].copy()
        inverse = np.linalg.inv(INERTIA)
        watch.command(stamp, JointDrive(wanted, answered, q_dot.copy(), INERTIA, inverse))
        acceleration = wanted + inverse @ (load - answered)
        q = q + q_dot * PERIOD + 0.5 * acceleration * PERIOD**2
        q_dot = q_dot + acceleration * PERIOD


@pytest.mark.parametrize("late", [0, 2])
def test_a_load_is_found_within_a_fraction_of_a_second(late):
    load = np.array([5.0, -4.0, 1.0, 0.1])
    found = [now[2] for now, _ in follow(observer(), load, 20 + late, late=late)]
    assert np.allclose(found[6 + 2 * late], load, rtol=0.1, atol=0.01)
    assert np.allclose(found[-1], load, rtol=0.02, atol=0.005)


def test_in_quiet_the_noise_is_less_than_that_of_the_encoders():
    rng, sigma = np.random.default_rng(1), np.sqrt(VARIANCES)
    noise = lambda: sigma[:, None] * rng.standard_normal((2, 4))  # noqa: E731
    pairs = list(follow(observer(), np.zeros(4), 2000, noise=noise))
    error = np.array([now - truth for now, truth in pairs[200:]])
    assert np.all(error[:, 0].std(axis=0) < 0.7 * sigma[0])
    assert np.all(error[:, 1].std(axis=0) < 0.7 * sigma[1])


@pytest.mark.parametrize("late", [1, 2, 4])
def test_late_samples_are_carried_to_the_tick_by_what_was_commanded(late):
    """Without noise and load exactly, however the joints are accelerated."""
    push = lambda k: np.array([1.0, -0.5, 2.0, 0.3]) * np.sin(0.7 * k)  # noqa: E731
    pairs = list(follow(observer(), np.zeros(4), 60, late=late, push=push))
    for now, truth in pairs[late + 1 :]:
        assert np.allclose(now[:2], truth[:2], atol=1e-9)


def test_a_stop_is_no_load():
    """Pressed 0.01 rad into a stop, at rest: the stop's push does not count."""
    watch = observer(build_model(VEHICLE))
    upper = frictionless()[1:5, layout.UPPER]
    zero = np.zeros(4)
    for k in range(100):
        stamp = to_nanoseconds(k * PERIOD)
        now = watch.step(JointStates(stamp, upper + 0.01, zero, zero), stamp)
        drive = JointDrive(np.full(4, 0.2), now[2].copy(), zero, INERTIA, np.linalg.inv(INERTIA))
        watch.command(stamp, drive)
    assert not watch.load.any()


def test_a_load_never_exceeds_its_bound():
    for now, _ in follow(observer(), 10.0 * EFFORT, 40):
        assert np.all(np.abs(now[2]) <= 0.5 * EFFORT)


def test_a_reset_forgets():
    watch = observer()
    list(follow(watch, np.ones(4), 20))
    watch.reset()
    assert not watch.load.any()
