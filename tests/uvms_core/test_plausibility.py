"""Bounds of signals, which the vehicle file gives, and of jumps between samples."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import uvms_core
from uvms_core import topics
from uvms_core.errors import ImplausibleError
from uvms_core.plausibility import AGREEING, Plausibility, bounds_of
from uvms_core.plausibility.agility import agility_of
from uvms_core.plausibility.scale import diagonal
from uvms_core.signals import (
    GpsSample,
    ImuSample,
    JointStates,
    Odometry,
    PressureSample,
    Reference,
    Wrench,
)
from uvms_core.vehicle import load_vehicle

VEHICLE = load_vehicle()
N = VEHICLE.n_joints
LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
S = 1_000_000_000
DT = S // 20


def odometry(stamp=0, position=(0.0, 0.0, 10.0), nu=(0.0,) * 6, std=0.01, quaternion=LEVEL):
    covariance = std**2 * np.eye(6)
    return Odometry(stamp, np.array(position), quaternion, np.array(nu), covariance, covariance)


def joints(stamp=0, **fields):
    still = JointStates(stamp, np.radians([0.0, 30.0, 60.0, 0.0]), np.zeros(N), np.zeros(N))
    return replace(still, **fields)


IMU = ImuSample(0, LEVEL, np.zeros(3), np.array([0.0, 0.0, -9.81]), np.eye(3), np.eye(3), np.eye(3))
BAD = [
    (topics.ODOMETRY, odometry(nu=np.full(6, 1e3)), "odometry: nu[0] is 1000 m/s or rad/s"),
    (topics.ODOMETRY, odometry(position=(0.0, 1e30, 0.0)), "odometry: position[1] is 1e+30 m"),
    (topics.ODOMETRY, odometry(std=1e15), "odometry: pose_covariance[0, 0] is 1e+30"),
    (topics.JOINT_STATES, joints(velocity=np.full(N, 100.0)), "joint_states: velocity[0] is 100"),
    (topics.JOINT_STATES, joints(position=np.full(N, -20.0)), "joint_states: position[0] is -20"),
    (topics.JOINT_STATES, joints(effort=np.full(N, 1e9)), "joint_states: effort[0] is 1e+09 N m"),
    (topics.IMU, replace(IMU, angular_velocity=np.full(3, 100.0)), "angular_velocity[0] is 100"),
    (topics.IMU, replace(IMU, linear_acceleration=np.full(3, 1e4)), "linear_acceleration[0] is"),
    (topics.PRESSURE, PressureSample(0, 0.0, 1.0), "pressure is 0 Pa; possible for this vehicle"),
    (topics.PRESSURE, PressureSample(0, 1e9, 1.0), "pressure is 1e+09 Pa"),
    (topics.GPS, GpsSample(0, True, 91.0, 0.0, 0.0, np.eye(3)), "latitude_deg is 91 deg"),
    (topics.WRENCH_COMMAND, Wrench(0, np.full(6, 1e30)), "wrench[0] is 1e+30"),
    (topics.DISTURBANCE, Wrench(0, np.full(6, -1e30)), "wrench[0] is -1e+30"),
]


@pytest.mark.parametrize(("topic", "signal", "text"), BAD, ids=lambda each: str(each)[:30])
def test_what_is_impossible_is_named_with_its_bound(topic, signal, text):
    with pytest.raises(ImplausibleError) as fault:
        Plausibility(VEHICLE).admit(topic, signal)
    assert text in str(fault.value)
    assert "possible for this vehicle is" in str(fault.value)


def test_a_gps_without_a_fix_may_be_anywhere():
    nan = float("nan")
    assert (
        Plausibility(VEHICLE).admit(topics.GPS, GpsSample(0, False, nan, nan, nan, np.eye(3)))
        is None
    )


def test_a_jump_is_refused_until_samples_agree():
    plausible = Plausibility(VEHICLE)
    plausible.admit(topics.ODOMETRY, odometry(0))
    for k in range(1, AGREEING):
        with pytest.raises(ImplausibleError, match=r"position\[0\] jumps by 20 m"):
            plausible.admit(topics.ODOMETRY, odometry(k * DT, position=(20.0, 0.0, 10.0)))
    news = plausible.admit(topics.ODOMETRY, odometry(AGREEING * DT, position=(20.0, 0.0, 10.0)))
    assert "taken as real" in news
    assert plausible.admit(topics.ODOMETRY, odometry(7 * DT, position=(20.0, 0.0, 10.0))) is None


def test_outliers_that_do_not_agree_are_never_taken():
    plausible = Plausibility(VEHICLE)
    rng = np.random.default_rng(2)
    plausible.admit(topics.ODOMETRY, odometry(0))
    for k in range(1, 60):
        with pytest.raises(ImplausibleError):
            plausible.admit(
                topics.ODOMETRY,
                odometry(k * DT, position=rng.choice([-1, 1], 3) * (1e3 + k * 50.0)),
            )


def test_an_estimate_may_be_corrected_by_its_own_uncertainty():
    plausible = Plausibility(VEHICLE)
    plausible.admit(topics.ODOMETRY, odometry(0, std=10.0))
    assert plausible.admit(topics.ODOMETRY, odometry(DT, position=(40.0, 0.0, 10.0))) is None


def test_the_other_sign_of_a_quaternion_is_no_jump():
    plausible = Plausibility(VEHICLE)
    plausible.admit(topics.ODOMETRY, odometry(0))
    assert plausible.admit(topics.ODOMETRY, odometry(DT, quaternion=-LEVEL)) is None


def test_several_samples_at_once_are_judged_as_one_by_one():
    """The quick test takes nothing that the slow one would refuse, and misses no jump."""
    rng = np.random.default_rng(4)
    for _ in range(300):
        scale = 10.0 ** rng.uniform(-2, 3)
        samples = [
            replace(
                IMU,
                stamp=k * S // 100,
                angular_velocity=rng.normal(size=3) * scale,
                quaternion=_turned(rng.normal() * scale * 0.01),
            )
            for k in range(1, 6)
        ]
        slow, quick = Plausibility(VEHICLE), Plausibility(VEHICLE)
        for each in (slow, quick):
            each.admit(topics.IMU, IMU)
        if quick.are_good(topics.IMU, samples):
            assert all(slow.admit(topics.IMU, sample) is None for sample in samples)


def _turned(angle):
    return np.array([0.0, 0.0, np.sin(angle / 2), np.cos(angle / 2)])


@given(st.floats(allow_nan=True, allow_infinity=True), st.integers(0, 5))
def test_the_quick_test_agrees_with_the_bounds(value, index):
    rule = bounds_of(VEHICLE, topics.WRENCH_COMMAND)
    wrench = np.zeros(6)
    wrench[index] = value
    with np.errstate(all="ignore"):
        possible = rule.is_possible(rule.flat(Wrench(0, wrench)))
    assert possible == bool(rule.low[index] <= value <= rule.high[index])


@pytest.mark.parametrize("name", ["reference_auv", "bluerov2_alpha5"])
def test_every_topic_of_the_loop_has_bounds_for_every_vehicle(name):
    vehicle = load_vehicle(Path(uvms_core.__file__).parent / "vehicles" / f"{name}.yaml")
    for own in topics.NODES.values():
        for topic in own.inputs:
            if topic is not topics.CLOCK:
                assert bounds_of(vehicle, topic).bounds, topic.name


SUDDEN = [
    (topics.ODOMETRY, odometry, {"nu": (9.9, 0.0, 0.0, 19.0, 0.0, 0.0)}, "nu[0] jumps by 9.9 m/s"),
    (topics.ODOMETRY, odometry, {"nu": (0.0, 0.0, 0.0, 19.0, 0.0, 0.0)}, "nu[3] jumps by 19"),
    (topics.JOINT_STATES, joints, {"velocity": np.full(N, 25.0)}, "velocity[0] jumps by 25 rad/s"),
    *(
        (topics.JOINT_STATES, joints, {"velocity": 25.0 * np.eye(N)[i]}, f"velocity[{i}] jumps")
        for i in range(N)
    ),
]


@pytest.mark.parametrize(("topic", "make", "fields", "text"), SUDDEN)
def test_a_velocity_does_not_change_faster_than_forces_allow(topic, make, fields, text):
    plausible = Plausibility(VEHICLE)
    assert plausible.admit(topic, make(0)) is None
    with pytest.raises(ImplausibleError) as fault:
        plausible.admit(topic, make(DT, **fields))
    assert text in str(fault.value)
    assert plausible.admit(topic, make(2 * DT)) is None


def test_what_moves_may_stop_at_once_and_be_thrown_back_by_a_stop():
    plausible = Plausibility(VEHICLE)
    fast = np.array([0.0, 12.0, 0.0, 0.0])
    plausible.admit(topics.JOINT_STATES, joints(0, velocity=fast))
    assert plausible.admit(topics.JOINT_STATES, joints(DT, velocity=-fast)) is None
    plausible.admit(topics.ODOMETRY, odometry(0, nu=(4.0, 0.0, 0.0, 6.0, 0.0, 0.0)))
    assert plausible.admit(topics.ODOMETRY, odometry(DT)) is None


def test_the_greatest_accelerations_follow_from_newtons_law():
    """At least what the thrusters and the drives do alone, and not many times that."""
    vehicle, agility = VEHICLE, agility_of(VEHICLE)
    surge = vehicle.hull.mass_kg + diagonal(vehicle.hull.added_mass)[0]
    forward = [t for t in vehicle.thrusters if t.direction[0] == 1.0]
    own = sum(t.greatest_n for t in forward) / surge
    assert own < agility.nu_dot[0] < vehicle.environment.gravity_m_s2 + 10.0 * own
    assert agility.wrench[0] == sum(t.greatest_n for t in forward)
    for joint, rate in zip(vehicle.arm.joints, agility.q_ddot, strict=True):
        assert rate <= 1.2 * joint.effort_limit_nm / joint.rotor_inertia_kg_m2


def plan(stamp, x=0.0, k=11, **fields):
    zeros = np.zeros((k, N))
    return replace(
        Reference(
            stamp,
            np.linspace(0.0, 0.5, k),
            np.tile([x, 0.0, 10.0], (k, 1)),
            np.tile(LEVEL, (k, 1)),
            np.zeros((k, 6)),
            np.zeros((k, 6)),
            zeros,
            zeros,
            zeros,
            np.tile([x + 1.0, 0.0, 10.0], (k, 1)),
        ),
        **fields,
    )


def test_a_plan_goes_on_where_the_last_one_ended():
    plausible = Plausibility(VEHICLE)
    assert plausible.admit(topics.REFERENCE, plan(0)) is None
    with pytest.raises(ImplausibleError, match="position of column 0 steps by 50"):
        plausible.admit(topics.REFERENCE, plan(S // 2, x=50.0))
    flipped = plan(S // 2, quaternion=np.tile(-LEVEL, (11, 1)))
    assert plausible.admit(topics.REFERENCE, flipped) is None
    sudden = np.zeros((11, N))
    sudden[5, 1] = 3.0
    with pytest.raises(ImplausibleError, match="q of column 1 steps by 3"):
        plausible.admit(topics.REFERENCE, plan(S, q=sudden))


def test_after_a_gap_a_plan_may_begin_anywhere():
    plausible = Plausibility(VEHICLE)
    plausible.admit(topics.REFERENCE, plan(0))
    assert plausible.admit(topics.REFERENCE, plan(2 * S, x=50.0)) is None


@given(
    st.sampled_from(["odometry", "joint_states", "imu", "wrench_command", "gps"]),
    st.floats(-3.0, 16.0),
    st.integers(0, 2**32 - 1),
)
def test_the_quick_test_of_a_whole_signal_refuses_what_the_words_refuse(name, decade, seed):
    rng, size = np.random.default_rng(seed), 10.0**decade
    topic, signal = {
        "odometry": (topics.ODOMETRY, odometry(nu=size * rng.standard_normal(6))),
        "joint_states": (topics.JOINT_STATES, joints(velocity=size * rng.standard_normal(N))),
        "imu": (topics.IMU, replace(IMU, linear_acceleration=size * rng.standard_normal(3))),
        "wrench_command": (topics.WRENCH_COMMAND, Wrench(0, size * rng.standard_normal(6))),
        "gps": (topics.GPS, GpsSample(0, seed % 2 == 0, size, 0.0, 0.0, np.eye(3))),
    }[name]
    refused = bounds_of(VEHICLE, topic).explain(signal)
    fault = Plausibility(VEHICLE).fault(topic, signal)
    assert fault == (refused and f"{topic.name}: {refused}")
