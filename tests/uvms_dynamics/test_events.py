"""Faults of thrusters and joints, pushes from outside, and when they take effect."""

import numpy as np
import pytest
from random_vehicles import REFERENCE

from uvms_core.errors import ConfigError
from uvms_core.signals import JointCommand, ThrusterCommand
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.kernels import forward_dynamics, joint_passive_torque, mass_matrix
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.model import build_model
from uvms_dynamics.simulation import Plant, PlantConfig, make_state, make_system
from uvms_dynamics.simulation.events import check_events, event_from_text, status_values
from uvms_dynamics.simulation.events.joint import JointEvent
from uvms_dynamics.simulation.events.thruster import ThrusterEvent
from uvms_dynamics.simulation.events.wrench import Push, WrenchEvent
from uvms_dynamics.simulation.integrator import advance, make_scratch
from uvms_dynamics.simulation.plant.brakes import lock

N, M = REFERENCE.n_joints, REFERENCE.n_thrusters
STEP, PERIOD = 5_000_000, 50_000_000  # of plant and control ticks, ns
MAIN, LAG = REFERENCE.thrusters[0].name, REFERENCE.thrusters[0].time_constant_s
WEIGHTLESS = load_vehicle(
    None, {"environment.gravity_m_s2": 1e-9, "hull.mass_kg": 184.0, "hull.cg_m": [0.0, 0.0, 0.012]}
)


def run(plant, ticks, thrust=0.0, effort=None):
    for _ in range(ticks):
        plant.step(
            ThrusterCommand(plant.stamp, np.full(M, thrust)),
            JointCommand(plant.stamp, np.zeros(N) if effort is None else effort),
        )
    return plant.truth()


def thrust_over_time(ticks, *events, thrust=20.0):
    plant = Plant(REFERENCE, PlantConfig(), 1, events)
    rows = [plant.truth().thrust]
    for _ in range(ticks):
        rows.append(run(plant, 1, thrust).thrust)
    return 0.05 * np.arange(ticks + 1), np.array(rows)


def test_a_dead_thruster_loses_its_thrust_with_its_lag_and_no_other_does():
    time, thrust = thrust_over_time(40, ThrusterEvent(at_s=1.0, thruster=MAIN, effectiveness=0.0))
    whole = thrust_over_time(40)[1]
    after = time >= 1.0
    full = thrust[time == 1.0, 0]
    np.testing.assert_allclose(
        thrust[after, 0], full * np.exp(-(time[after] - 1.0) / LAG), rtol=1e-5
    )
    np.testing.assert_array_equal(thrust[:, 1:], whole[:, 1:])


def test_a_weak_thruster_gives_its_share_and_a_stuck_one_its_thrust():
    last = thrust_over_time(60, ThrusterEvent(at_s=0.0, thruster=MAIN, effectiveness=0.3))[1][-1]
    assert last[0] == pytest.approx(6.0, rel=1e-6)
    stuck = ThrusterEvent(at_s=0.0, thruster=MAIN, stuck_at_n=-12.0)
    for command in (20.0, 0.0):
        last = thrust_over_time(60, stuck, thrust=command)[1][-1]
        assert last[0] == pytest.approx(-12.0, rel=1e-6)
        assert last[1] == pytest.approx(command, abs=1e-6)


def test_a_thruster_can_be_whole_again():
    events = (
        ThrusterEvent(at_s=0.0, thruster=MAIN, stuck_at_n=5.0),
        ThrusterEvent(at_s=1.0, thruster=MAIN, effectiveness=1.0),
    )
    assert thrust_over_time(80, *events)[1][-1, 0] == pytest.approx(20.0, rel=1e-6)


@pytest.mark.parametrize("frame", ["world", "body"])
def test_the_impulse_of_a_push_is_the_change_of_momentum(frame):
    """M dv = F dt of hull, arm and added mass together, at rest and for one control period."""
    wrench = np.array([8.0, -5.0, 3.0, 1.0, 2.0, -3.0])
    push = Push(force_n=tuple(wrench[:3]), moment_nm=tuple(wrench[3:]), frame=frame)
    config = PlantConfig(initial_rpy_deg=(10.0, -20.0, 70.0))
    plant = Plant(WEIGHTLESS, config, 1, (WrenchEvent(at_s=1.0, until_s=1.05, wrench=push),))
    before = run(plant, 20)
    np.testing.assert_allclose(before.odometry.nu, 0.0, atol=1e-9)
    np.testing.assert_allclose(
        before.disturbance.external, _in_body(wrench, before.odometry.quaternion, frame)
    )
    after = run(plant, 1)
    mass = mass_matrix(build_model(WEIGHTLESS), before.joints.position)
    change = np.concatenate([after.odometry.nu, after.joints.velocity])
    impulse = np.zeros(6 + N)
    impulse[:6] = 0.05 * _in_body(wrench, before.odometry.quaternion, frame)
    # Joint friction acts on the arm alone, and drag hardly: it is compared at the hull.
    friction = joint_passive_torque(
        build_model(WEIGHTLESS), before.joints.position, 0.5 * after.joints.velocity
    )
    impulse[6:] = 0.05 * friction
    np.testing.assert_allclose((mass @ change)[:6], impulse[:6], rtol=0.02, atol=2e-3)
    np.testing.assert_array_equal(after.disturbance.external, 0.0)


def _in_body(wrench, quaternion, frame):
    if frame == "body":
        return wrench
    rotation = quat_to_matrix(quaternion).T
    return np.concatenate([rotation @ wrench[:3], rotation @ wrench[3:]])


def test_pushes_add_up_and_leave_nothing_behind():
    def pushed(at, until, force):
        return WrenchEvent(at_s=at, until_s=until, wrench=Push(force_n=force, frame="body"))

    events = pushed(0.0, 1.0, (0.1, 0.7, 0.0)), pushed(0.5, 0.75, (0.2, 0.0, 0.3))
    plant = Plant(REFERENCE, PlantConfig(), 1, events)
    seen = [plant.truth().disturbance.external[:3]]
    seen += [run(plant, 1).disturbance.external[:3] for _ in range(25)]
    np.testing.assert_array_equal(seen[9], (0.1, 0.7, 0.0))
    np.testing.assert_allclose(seen[12], (0.3, 0.7, 0.3))
    np.testing.assert_array_equal(seen[16], (0.1, 0.7, 0.0))
    np.testing.assert_array_equal(seen[20], 0.0)


def test_a_stuck_joint_keeps_its_angle_exactly_and_others_do_not():
    plant = Plant(REFERENCE, PlantConfig(), 1, (JointEvent(at_s=0.5, joint="elbow", stuck=True),))
    effort = np.array([3.0, -4.0, 5.0, 1.0])
    at = run(plant, 10, effort=effort).joints.position
    truth = run(plant, 20, 10.0, effort)
    assert truth.joints.position[2] == at[2]
    assert truth.joints.velocity[2] == 0.0
    assert (np.abs(truth.joints.position - at)[[0, 1, 3]] > 1e-3).all()


def test_a_stuck_joint_takes_the_torque_that_keeps_its_acceleration_zero():
    """The rest accelerates as under that torque, solved from a(tau) = a_0 + M^-1 e_i tau."""
    q, q_dot = np.radians([20.0, 30.0, 60.0, 25.0]), np.array([0.3, -0.2, 0.0, 0.4])
    nu = np.array([0.3, -0.1, 0.2, 0.1, -0.2, 0.15])
    system = make_system(REFERENCE)
    model = system.model
    tau = np.zeros(6 + N)
    tau[6:] = joint_passive_torque(model, q, q_dot)
    quat = np.array([0.0, 0.0, 0.0, 1.0])
    free = forward_dynamics(model, quat, nu, q, q_dot, tau)
    column = np.linalg.inv(mass_matrix(model, q))[:, 6 + 2]
    expected = free - column * free[6 + 2] / column[6 + 2]
    state = make_state(q, M, nu_r=nu, q_dot=q_dot)
    rows, rates = np.empty((2, 1, len(state)))
    held = lock(system, np.array([False, False, True, False]))
    advance(held, state, np.zeros(M), np.zeros(N), 0.0, make_scratch(held), rows, rates, 0.0)
    found = np.concatenate([rates[0, 7:13], rates[0, 13 + N : 13 + 2 * N]])
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12)


def test_a_joint_that_sticks_in_motion_hands_its_momentum_on_and_loses_energy():
    plant = Plant(WEIGHTLESS, PlantConfig(), 1, (JointEvent(at_s=0.5, joint="swing", stuck=True),))
    run(plant, 9, effort=np.array([10.0, 0.0, 0.0, 0.0]))
    free = Plant(WEIGHTLESS, PlantConfig(), 1)
    run(free, 10, effort=np.array([10.0, 0.0, 0.0, 0.0]))
    stuck, moving = run(plant, 1, effort=np.array([10.0, 0.0, 0.0, 0.0])), free.truth()
    mass = mass_matrix(build_model(WEIGHTLESS), moving.joints.position)
    before = np.concatenate([moving.odometry.nu, moving.joints.velocity])
    after = np.concatenate([stuck.odometry.nu, stuck.joints.velocity])
    assert abs(before[6]) > 0.05
    assert after[6] == 0.0
    others = np.arange(6 + N) != 6
    np.testing.assert_allclose((mass @ after)[others], (mass @ before)[others], atol=1e-9)
    assert after @ mass @ after < before @ mass @ before


def test_a_braked_arm_with_a_stuck_joint_holds_and_comes_free_again():
    vehicle = load_vehicle(None, {f"arm.joints.{i}.brake_nm": 60.0 for i in range(N)})
    events = (
        JointEvent(at_s=0.0, joint="elbow", stuck=True),
        JointEvent(at_s=1.0, joint="elbow", stuck=False),
    )
    plant = Plant(vehicle, PlantConfig(), 1, events)
    start = plant.truth().joints.position
    for _ in range(20):
        plant.step(None, None)
    np.testing.assert_array_equal(plant.truth().joints.position, start)
    assert abs(run(plant, 10, effort=np.array([0.0, 0.0, 8.0, 0.0])).joints.velocity[2]) > 1e-3


def test_an_event_between_two_ticks_happens_at_the_next_one_and_is_told():
    plant = Plant(
        REFERENCE, PlantConfig(), 1, (ThrusterEvent(at_s=0.12, thruster=MAIN, effectiveness=0.5),)
    )
    assert plant.take_happened() == []
    run(plant, 2)
    assert plant.take_happened() == []
    run(plant, 1)
    (event,) = happened = plant.take_happened()
    assert event.asked_s == 0.12
    assert status_values(happened) == {
        "event_at_s": 0.15,
        "event_1": f"thruster {MAIN}: effectiveness 0.5",
    }
    assert plant.take_happened() == []


def test_events_at_run_time_are_those_of_a_scenario():
    planned = Plant(
        REFERENCE, PlantConfig(), 1, (ThrusterEvent(at_s=0.5, thruster=MAIN, effectiveness=0.0),)
    )
    asked = Plant(REFERENCE, PlantConfig(), 1)
    run(planned, 10, 15.0)
    run(asked, 10, 15.0)
    text = f"{{thruster: {MAIN}, effectiveness: 0.0}}"
    assert asked.apply(event_from_text(text, asked.stamp)) == (
        f"at 0.5 s: thruster {MAIN}: effectiveness 0"
    )
    ours, theirs = run(asked, 10, 15.0), run(planned, 10, 15.0)
    np.testing.assert_array_equal(ours.odometry.nu, theirs.odometry.nu)
    with pytest.raises(ConfigError, match=r"at_s 0.2: the plant is at 1 s already"):
        asked.apply(event_from_text(f"{{at_s: 0.2, thruster: {MAIN}, effectiveness: 0.0}}", 0))
    with pytest.raises(ConfigError, match="the arm holds none"):
        asked.apply(event_from_text("{payload: release}", asked.stamp))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{thruster: mian, effectiveness: 0}", r"thruster 'mian': choose one of main, side_fore"),
        ("{thruster: main, effectiveness: 2}", r"effectiveness: .* less than or equal to 1"),
        ("{thruster: main}", "either effectiveness .* or stuck_at_n"),
        ("{thruster: main, stuck_at_n: 500}", "stuck_at_n 500: thruster main gives -98 to 98 N"),
        ("{joint: knee, stuck: true}", "joint 'knee': choose one of swing, shoulder"),
        ("{sensor: dvl}", "fault: required; choose one of silent, zeros"),
        ("{sensor: dvl, fault: deaf}", "fault 'deaf': choose one of silent, zeros"),
        ("{sensor: sonar, fault: silent}", "sensor 'sonar': choose one of imu, dvl"),
        ("{sensor: imu, fault: bias, bias: 1}", "field: the imu measures quaternion, angular"),
        ("{sensor: imu, fault: silent}", "at_s 0: navigation takes its attitude"),
        ("{sensor: encoders, fault: silent}", "cannot go on without joint states"),
        ("{sensor: encoders, fault: latency, latency_s: 0.1}", "at_s 0: .* first joint states"),
        ("{sensor: dvl, fault: bias, bias: [1, 2]}", "has 2 numbers; dvl needs 1 or 3"),
        (
            "{sensor: dvl, fault: noise, std: -1}",
            "std: .* is >= 0, and this is -1",
        ),
        ("{sensor: dvl, fault: outliers, rate: 0.5, std: [1, -2, 1]}", "std: .* and this is -2"),
        ("{sensor: imu, fault: scale, scale: 2, field: quaternion}", "an attitude has no scale"),
        ("{until_s: -1, wrench: {}}", "until_s"),
        ("{wrench: {frame: moon}}", "'world' or 'body'"),
        ("{wrench: {force: 3}}", "known names here: force_n, frame, moment_nm"),
        ("{payload: {mass_kg: 1, volume_m3: 0, foo: 1}}", "known names here: added_mass_kg, at_m"),
        ("{payload: drop}", "payload: .*'release'"),
        ("{at_s: -1, payload: {mass_kg: 1, volume_m3: 0}}", "at_s: .* greater than or equal to 0"),
        ("{joint: elbow, thruster: main}", "exactly one of .*; this one has thruster and joint"),
        ("{truster: main}", "exactly one of payload, thruster, wrench, joint, sensor"),
        ("[1]", "an event is a mapping"),
        ("{", "event"),
    ],
)
def test_an_event_that_cannot_be_is_refused_with_the_choices(text, words):
    with pytest.raises(ConfigError, match=words):
        check_events((event_from_text(text, 0),), REFERENCE, STEP, PERIOD)
