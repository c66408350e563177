"""The law `default`: what stays with the hull, what is fed forward, and how it returns."""

from dataclasses import replace

import numpy as np
import pytest
from closed_loop import at_rest, hold
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit
from trajectories import joints as arm_motion
from trajectories import vehicle as vehicle_motion

from uvms_control import ControlConfig, Controller, PaperController
from uvms_control.design.gains import VehicleGains
from uvms_control.vehicle_law import BRAKING, _feedback, law_wrench, return_speed
from uvms_core.signals import DisturbanceBudget, Payload, Wrench, to_nanoseconds
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.statics import first_moment
from uvms_dynamics import (
    build_model,
    coupling_wrench,
    forward_dynamics,
    hull_bias_wrench,
    inverse_dynamics,
    mass_matrix,
    restoring_wrench,
)
from uvms_dynamics.kernels.rotations import quat_to_matrix, rpy_to_quat
from uvms_dynamics.payload import with_payload

VEHICLE = load_vehicle()
MODEL = build_model(VEHICLE)
STOWED = np.radians([0.0, 0.0, 135.0, 0.0])
LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
PERIOD, ENGAGED = 0.05, 10.0
SWAY, ROLL = 1, 3
ALL, PASSING, FULL = np.ones(6, dtype=bool), np.eye(6), np.ones(6)


def make(law=Controller):
    controller = law(VEHICLE, ControlConfig(compensate_vehicle_motion=False))
    controller.prepare(PERIOD)
    return controller


def wrench_of(controller, state, known, reference=None, budget=None):
    """Wrench (6,) of a law that has been engaged for long, at one state."""
    reference = hold(STOWED) if reference is None else reference
    if budget is not None:
        controller.inform(budget, None)
    for stamp in (0, to_nanoseconds(ENGAGED)):
        odometry, joints = state.estimates(stamp)
        wrench, _ = controller.step(odometry, joints, Wrench(stamp, known), reference)
    return wrench.wrench


def by_hand(gains: VehicleGains, controller, error, rate, mass=None):
    """Feedback acceleration (6,), A S(2 D (e_dot + r(e)) / A), from its formula."""
    mass = mass_matrix(MODEL, STOWED)[:6, :6] if mass is None else mass
    A = gains.amplitude(controller._axes.authority, mass)
    slope, braking = gains.stiffness / gains.damping, BRAKING * A
    linear = braking / slope**2
    speed = np.where(
        np.abs(error) <= linear,
        slope * error,
        np.sign(error) * np.sqrt(2 * braking * np.maximum(np.abs(error) - linear / 2, 0.0)),
    )
    s = 2 * gains.damping * (rate + speed) / A
    return A * (2 / (1 + np.exp(-s)) - 1)


KNOWN = np.array([3.0, -8.0, 5.0, 2.0, -4.0, 1.5])


def test_at_the_reference_a_known_disturbance_is_balanced_exactly():
    assert np.allclose(wrench_of(make(), at_rest(STOWED), KNOWN), -KNOWN, rtol=0, atol=1e-12)


@pytest.mark.parametrize("t", [0.0, 0.4, 1.3, 2.9])
def test_without_error_the_reference_acceleration_comes_out(t):
    """Forward dynamics with the law's wrench gives nu_dot_d back; the arm moves meanwhile."""
    _, quaternion, nu, nu_dot = vehicle_motion(t)
    q, q_dot, q_ddot = arm_motion(t)
    coupling = coupling_wrench(MODEL, nu, np.zeros(6), q, q_dot, q_ddot)
    known = coupling + restoring_wrench(MODEL, quaternion, q)
    mass = np.ascontiguousarray(mass_matrix(MODEL, q)[:6, :6])
    none, some = np.zeros(6), np.full(6, 0.3)
    wrench = law_wrench(
        MODEL, ALL, PASSING, FULL, some, some, some, nu, mass, none, none, nu_dot, known
    )  # fmt: skip
    torque = inverse_dynamics(MODEL, quaternion, nu, nu_dot, q, q_dot, q_ddot)[6:]
    found = forward_dynamics(MODEL, quaternion, nu, q, q_dot, np.concatenate((wrench, torque)))
    assert np.allclose(found, np.concatenate((nu_dot, q_ddot)), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("phi", [-0.3, -0.05, 0.02, 0.3])
def test_tilted_the_righting_moment_is_left_to_the_hull(phi):
    """What vehicle and water do together, less the feedback: -c sin(phi), and 0 by the paper."""
    state = at_rest(STOWED, quaternion=rpy_to_quat(phi, 0.0, 0.0))
    external = np.array([0.0, 5.0, -3.0, 0.8, 0.0, 0.0])
    acts = restoring_wrench(MODEL, state.quaternion, STOWED) + external
    level = restoring_wrench(MODEL, LEVEL, STOWED)
    righting = (restoring_wrench(MODEL, state.quaternion, STOWED) - level)[3:]
    mass = mass_matrix(MODEL, STOWED)[:6, :6]
    error = np.array([0.0, 0.0, 0.0, -phi, 0.0, 0.0])

    ours = make()
    feedback = by_hand(ours._gains, ours, error, np.zeros(6))
    left = wrench_of(ours, state, acts) + acts - mass @ feedback
    assert np.allclose(left[3:], righting, rtol=0, atol=1e-9)
    assert np.allclose(left[:3], 0.0, atol=1e-9)
    metacentric = float(first_moment(VEHICLE, STOWED)[2])
    assert metacentric > 20.0
    off_keel = level[3] * (np.cos(phi) - 1.0)  # the arm's weight beside the keel
    assert left[ROLL] == pytest.approx(-metacentric * np.sin(phi) + off_keel, abs=0.02)

    paper = make(PaperController)
    u = paper.vehicle.law.acceleration(error, np.zeros(6))
    left = wrench_of(paper, state, acts) + acts - mass @ u
    assert np.allclose(left, 0.0, atol=1e-9)


def test_an_observer_without_a_restoring_part_is_fed_forward_as_it_is():
    state = at_rest(STOWED, quaternion=rpy_to_quat(0.2, 0.0, 0.0))
    none = DisturbanceBudget(0, np.zeros(6), np.zeros(6), KNOWN)
    with_it, without = (
        wrench_of(make(), state, known, budget=none) for known in (KNOWN, np.zeros(6))
    )
    assert np.allclose(with_it - without, -KNOWN, rtol=0, atol=1e-12)


@pytest.mark.parametrize("speed", [0.2, 0.5, 0.8])
def test_a_vehicle_that_a_current_carries_is_not_pushed_downstream(speed):
    """The paper's law takes the current for a motion whose drag the thrusters must overcome."""
    state = at_rest(STOWED)
    state.nu[SWAY] = speed
    ours = wrench_of(make(), state, np.zeros(6))
    paper = make(PaperController)
    printed = wrench_of(paper, state, np.zeros(6))
    mass = mass_matrix(MODEL, STOWED)[:6, :6]
    braking = mass @ paper.vehicle.law.acceleration(np.zeros(6), -state.nu)
    drag = hull_bias_wrench(MODEL, state.nu)
    assert ours[SWAY] < 0.0
    assert drag[SWAY] > 10.0
    assert printed[SWAY] - braking[SWAY] == pytest.approx(drag[SWAY], rel=1e-9)
    if speed > 0.7:
        assert printed[SWAY] > 50.0


def test_the_drag_of_the_reference_velocity_is_fed_forward():
    """A vehicle that moves as the reference wants it gets what that motion takes."""
    nu = np.array([0.4, -0.2, 0.1, 0.05, -0.1, 0.2])
    none, some = np.zeros(6), np.full(6, 0.3)
    mass = np.ascontiguousarray(mass_matrix(MODEL, STOWED)[:6, :6])
    found = law_wrench(
        MODEL, ALL, PASSING, FULL, some, some, some, nu, mass, none, none, none, none
    )  # fmt: skip
    assert np.allclose(found, hull_bias_wrench(MODEL, nu), atol=1e-12)
    slip = np.array([0.3, 0.0, 0.0, 0.0, 0.0, 0.0])  # as a current would give it
    slipping = law_wrench(
        MODEL, ALL, PASSING, FULL, 0 * some, 0 * some, some, nu - slip, mass, none, slip, none, none
    )  # fmt: skip
    assert np.allclose(slipping, hull_bias_wrench(MODEL, nu), atol=1e-12)


positive = st.floats(0.05, 10.0)


@settings(deadline=None)
@given(P=positive, D=positive, A=positive)
def test_slopes_near_the_reference_are_stiffness_and_damping(P, D, A):
    h = 1e-6 * A / max(P, D, 1.0)
    assert (_feedback(h, 0.0, P, D, A) - _feedback(-h, 0.0, P, D, A)) / (2 * h) == pytest.approx(
        P, rel=1e-6
    )
    assert (_feedback(0.0, h, P, D, A) - _feedback(0.0, -h, P, D, A)) / (2 * h) == pytest.approx(
        D, rel=1e-6
    )


@settings(deadline=None)
@given(e=st.floats(-50, 50), v=st.floats(-5, 5), P=positive, D=positive, A=positive)
def test_the_feedback_is_odd_and_within_its_amplitude(e, v, P, D, A):
    found = _feedback(e, v, P, D, A)
    assert found == -_feedback(-e, -v, P, D, A)
    assert abs(found) <= A
    assert _feedback(1e6, 0.0, P, D, A) == pytest.approx(A, rel=1e-9)


def test_an_axis_without_gains_gets_no_feedback():
    assert _feedback(1.0, 1.0, 0.0, 0.0, 1.0) == _feedback(1.0, 1.0, 1.0, 1.0, 0.0) == 0.0


@settings(deadline=None)
@given(k=positive, b=positive)
def test_return_speed_has_no_step_and_no_corner(k, b):
    edge, h = b / k**2, 1e-6 * b / k**2
    below, at, above = (return_speed(edge + d, k, b) for d in (-h, 0.0, h))
    assert at == pytest.approx(k * edge, rel=1e-12)
    assert above == pytest.approx(at + k * h, rel=1e-9)
    assert (at - below) / h == pytest.approx(k, rel=1e-4)
    assert (above - at) / h == pytest.approx(k, rel=1e-4)


@settings(deadline=None)
@given(k=positive, b=positive, e=st.floats(1e-3, 100.0))
def test_return_speed_is_one_that_braking_stops_in_time(k, b, e):
    """Its deceleration r dr/de is the braking at most, and r^2 / 2b reaches to the error at most.

    Anything faster by more than b / k would not stop within the distance.
    """
    h = 1e-6 * e
    r = return_speed(e, k, b)
    slope = (return_speed(e + h, k, b) - return_speed(e - h, k, b)) / (2 * h)
    assert r * slope <= b * (1 + 1e-5)
    assert r**2 / (2 * b) <= e
    assert return_speed(-e, k, b) == -r


@njit(cache=True)
def farthest_beyond(start, P, D, A, seconds):
    """How far a vehicle that may accelerate by A at most passes the reference, m."""
    h, x, v, beyond = 0.002, start, 0.0, 0.0
    for _ in range(int(seconds / h)):
        v += h * _feedback(-x, -v, P, D, A)
        x += h * v
        beyond = max(beyond, -x)
    return beyond


@settings(deadline=None, max_examples=60)
@given(start=st.floats(0.01, 20.0), P=st.floats(0.2, 20.0), A=st.floats(0.05, 1.0))
def test_a_return_from_any_distance_does_not_overshoot(start, P, A):
    """A critically damped return: none, whatever the distance, for it can always brake."""
    assert farthest_beyond(start, P, 2.0 * np.sqrt(P), A, 120.0) < 1e-6 * start


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("start", [0.05, 0.5, 3.0, 20.0])
def test_with_the_gains_by_rule_a_return_overshoots_by_less_than_four_centimetres(axis, start):
    controller = make()
    gains = controller._gains
    A = gains.amplitude(controller._axes.authority, mass_matrix(MODEL, STOWED)[:6, :6])[axis]
    P, D = gains.stiffness[axis], gains.damping[axis]
    assert farthest_beyond(start, P, D, A, 120.0) < 0.04  # damping ratio 0.6; 3 cm


@pytest.mark.parametrize("error", [0.05, 0.5, 20.0])
def test_the_law_engages_with_what_is_fed_forward_and_comes_up_in_equal_steps(error):
    """Of any error: at the second tick there is one step of many, and not the whole thrust."""
    controller = make()
    state = at_rest(STOWED, position=(-error, 0.0, 0.0))
    mass = mass_matrix(MODEL, STOWED)[:6, :6]
    found = []
    for k in range(60):
        stamp = k * to_nanoseconds(PERIOD)
        odometry, joints = state.estimates(stamp)
        wrench, _ = controller.step(odometry, joints, Wrench(stamp, KNOWN), hold(STOWED))
        found.append(np.linalg.solve(mass, wrench.wrench + KNOWN))
    assert np.allclose(found[0], 0.0, atol=1e-12)
    surge = np.array(found)[:, 0]
    step = PERIOD * np.sqrt(controller._gains.stiffness[0]) / 2.0
    share = np.minimum(step * np.arange(60), 1.0)
    assert np.allclose(surge, share * surge[-1], atol=1e-12)
    assert surge[-1] > 0.0
    assert share[-1] == 1.0
    controller.reset()
    odometry, joints = state.estimates(0)
    again, _ = controller.step(odometry, joints, Wrench(0, KNOWN), hold(STOWED))
    assert np.allclose(again.wrench, -KNOWN, atol=1e-12)


def swinging(q, rate):
    """Reference (20 s) of a vehicle that rests and joints that move at a constant rate."""
    held = hold(q)
    times = np.array([0.0, 20.0])
    return replace(
        held,
        times=times,
        **{n: np.repeat(getattr(held, n), 2, axis=0) for n in
           ("position", "quaternion", "nu", "nu_dot", "q_ddot", "end_effector")},
        q=q + times[:, None] * rate,
        q_dot=np.repeat(rate[None], 2, axis=0),
    )  # fmt: skip


def test_the_restoring_moment_is_that_of_the_arm_a_thruster_lag_ahead():
    """The arm swings sideways at a constant rate; its weight is carried where it will be."""
    controller, rate = make(), np.array([0.3, 0.0, 0.0, 0.0])
    q = np.radians([40.0, 0.0, 45.0, 0.0])
    reference = swinging(q, rate)
    lead = controller._lead * 1e-9
    assert lead >= PERIOD / 2
    stamp = to_nanoseconds(0.5)
    state = at_rest(q + 0.5 * rate)
    odometry, joints = state.estimates(stamp)
    acts = restoring_wrench(MODEL, LEVEL, state.q)
    wrench, _ = controller.step(odometry, joints, Wrench(stamp, acts), reference)
    ahead = restoring_wrench(MODEL, LEVEL, q + (0.5 + lead) * rate)
    assert np.allclose(wrench.wrench[3:], -ahead[3:], atol=1e-9)
    assert np.abs(ahead - acts)[ROLL] > 0.01


def test_a_confirmed_payload_is_carried_once_where_the_arm_will_be_and_let_go_again():
    """Weight, moment and inertia: tilted, with the arm on its way, and in force with an error."""
    q, rate, phi = np.radians([40.0, 0.0, 45.0, 0.0]), np.array([0.3, 0.0, 0.0, 0.0]), 0.1
    payload = Payload(
        True, 1.0, 0.01, 5.0, 0.05, np.array([0.02, -0.01, 0.1]), np.full(3, 1e-3)
    )  # fmt: skip
    loaded = with_payload(MODEL, payload.mass, payload.weight, payload.position)
    tilt = rpy_to_quat(phi, 0.0, 0.0)
    controller = make()
    lead, start = controller._lead * 1e-9, np.zeros(6)
    cases = ((0.5, payload, loaded), (20.0 - 1.0, None, MODEL))
    for t, held, model in cases:  # engaged in full at the second of them
        state = at_rest(q + t * rate, position=(0.0, -0.02, 0.0), quaternion=tilt)
        acts = restoring_wrench(model, tilt, state.q)
        stamp = to_nanoseconds(t)
        controller.inform(replace(DisturbanceBudget(stamp, acts, start, start), payload=held), None)
        odometry, joints = state.estimates(stamp)
        engaged = 0.0 if held else 1.0
        wrench, _ = controller.step(
            odometry, joints, Wrench(stamp, acts), swinging(q, rate)
        )  # fmt: skip
        seen = controller.arm.observer.now[0]
        assert np.allclose(seen, state.q, atol=1e-3)
        ahead = restoring_wrench(model, LEVEL, seen + lead * rate)
        turned = restoring_wrench(model, tilt, state.q) - restoring_wrench(model, tilt, seen)
        mass = mass_matrix(model, seen)[:6, :6]
        error = np.concatenate((quat_to_matrix(tilt).T @ -state.position, [-phi, 0.0, 0.0]))
        feedback = engaged * by_hand(controller._gains, controller, error, start, mass)
        left = wrench.wrench - mass @ feedback
        assert np.allclose(left[:3], -acts[:3], atol=1e-9)
        assert np.allclose(left[3:], -(ahead + turned)[3:], atol=1e-9)
    weight = acts - restoring_wrench(loaded, tilt, state.q)
    assert np.linalg.norm(weight[:3]) == pytest.approx(5.0, rel=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_the_paper_s_law_is_equation_22_written_out(seed):
    rng = np.random.default_rng(seed)
    nu = 0.3 * rng.normal(size=6)
    q = 0.5 * rng.normal(size=4)
    state = at_rest(q, 0.2 * rng.normal(size=3), LEVEL)
    state.nu[:] = nu
    known = 10.0 * rng.normal(size=6)
    c = ControlConfig().vehicle
    controller = make(PaperController)
    found = wrench_of(controller, state, known, hold(q))
    seen = controller.arm.observer.now[0]  # by encoders and torques
    error = np.concatenate((-state.position, np.zeros(3)))  # level: body axes are the world's
    s = np.array(c.k_error) * error / c.error_scale - np.array(c.k_rate) * nu / c.rate_scale
    S = 2.0 / (1.0 + np.exp(-s)) - 1.0
    M = mass_matrix(MODEL, seen)[:6, :6]
    # The reference rests, so that its acceleration is 0; C nu + D nu by the hull's own kernels.
    expected = M @ (np.array(c.amplitude) * S) + hull_bias_wrench(MODEL, nu) - known
    assert np.allclose(found, expected, rtol=1e-12, atol=1e-12)
