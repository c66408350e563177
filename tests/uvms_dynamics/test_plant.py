"""The plant as its users see it: commands, limits, time, errors."""

import numpy as np
import pytest
from random_vehicles import REFERENCE

from uvms_core.errors import ConfigError, PlantDiverged, SignalError
from uvms_core.signals import JointCommand, ThrusterCommand
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import quat_to_rpy
from uvms_dynamics.simulation import Plant, PlantConfig

N, M = REFERENCE.n_joints, REFERENCE.n_thrusters


def plant_of(vehicle=REFERENCE, seed=1, **config):
    return Plant(vehicle, PlantConfig(**config), seed)


def run(plant, ticks, thrust=None, effort=None):
    thrust = np.zeros(M) if thrust is None else np.array(thrust, dtype=float)
    effort = np.zeros(N) if effort is None else np.array(effort, dtype=float)
    for _ in range(ticks):
        plant.step(ThrusterCommand(plant.stamp, thrust), JointCommand(plant.stamp, effort))
    return plant.truth()


def test_it_starts_where_the_configuration_says():
    plant = plant_of(
        initial_position_m=(1.0, 2.0, 3.0),
        initial_rpy_deg=(4.0, 5.0, 6.0),
        initial_velocity=(0.1, 0.2, 0.3, 0.4, 0.5, 0.6),
        initial_joints_deg=(10.0, 20.0, 30.0, 40.0),
        current_ned_m_s=(0.5, -0.5, 0.1),
    )
    truth = plant.truth()
    assert plant.stamp == truth.odometry.stamp == 0
    np.testing.assert_array_equal(truth.odometry.position, (1.0, 2.0, 3.0))
    np.testing.assert_allclose(np.degrees(quat_to_rpy(truth.odometry.quaternion)), (4.0, 5.0, 6.0))
    np.testing.assert_allclose(truth.odometry.nu, (0.1, 0.2, 0.3, 0.4, 0.5, 0.6), rtol=1e-12)
    np.testing.assert_allclose(np.degrees(truth.joints.position), (10.0, 20.0, 30.0, 40.0))
    np.testing.assert_array_equal(truth.thrust, np.zeros(M))


def test_the_arm_starts_stowed_by_default():
    joints = plant_of().truth().joints.position
    np.testing.assert_allclose(np.degrees(joints), REFERENCE.arm.stowed_deg)


def test_a_held_arm_floats_level_where_it_is():
    """Neutral and trimmed; the drives hold the arm against its wet weight."""
    plant = plant_of()
    for _ in range(200):
        joints = plant.truth().joints
        effort = 200.0 * (np.radians(REFERENCE.arm.stowed_deg) - joints.position)
        plant.step(None, JointCommand(plant.stamp, effort - 40.0 * joints.velocity))
    truth = plant.truth()
    np.testing.assert_allclose(truth.odometry.position, (0.0, 0.0, 10.0), atol=0.02)
    np.testing.assert_allclose(np.degrees(quat_to_rpy(truth.odometry.quaternion)), 0.0, atol=0.6)


def test_time_goes_by_control_periods():
    plant = plant_of(control_period_s=0.02)
    run(plant, 3)
    assert plant.stamp == 60_000_000


def test_thrust_follows_with_its_lag():
    """Small commands: no slew, T = u (1 - exp(-t / tau))."""
    thrust = run(plant_of(), 4, thrust=[5.0] * M).thrust
    lag = np.array([thruster.time_constant_s for thruster in REFERENCE.thrusters])
    np.testing.assert_allclose(thrust, 5.0 * (1.0 - np.exp(-0.2 / lag)), rtol=1e-6)


def test_thrust_keeps_its_slew_and_its_limit():
    plant = plant_of()
    first = run(plant, 1, thrust=[1e6] * M).thrust
    slew = np.array([thruster.slew_limit_n_s for thruster in REFERENCE.thrusters])
    np.testing.assert_allclose(first, 0.05 * slew, rtol=1e-9)
    last = run(plant, 100, thrust=[1e6] * M).thrust
    limit = np.array([thruster.limit_n for thruster in REFERENCE.thrusters])
    np.testing.assert_allclose(last, limit, rtol=1e-9)


def test_effort_is_the_torque_that_the_drives_apply():
    plant = plant_of()
    truth = run(plant, 1, effort=[1e3, -1e3, 2.0, -1e3])
    np.testing.assert_array_equal(truth.joints.effort, (40.0, -40.0, 2.0, -10.0))
    np.testing.assert_array_equal(plant.sense().joints.effort, truth.joints.effort)


def test_a_stop_holds_a_joint_near_its_limit():
    truth = run(plant_of(initial_joints_deg=(0, 0, 90, 0)), 200, effort=[40.0, 0, 0, 0])
    over = np.degrees(truth.joints.position[0]) - 120.0
    assert 0.0 < over < np.degrees(40.0 / 2000.0) + 0.1


def test_a_step_half_as_long_gives_the_same_run():
    thrust, effort = [60.0, 5.0, -5.0, 10.0, -10.0, 3.0, 3.0], [3.0, 4.0, 5.0, 1.0]
    coarse = run(plant_of(), 60, thrust, effort)
    fine = run(plant_of(step_s=0.0025), 60, thrust, effort)
    np.testing.assert_allclose(coarse.odometry.position, fine.odometry.position, atol=1e-5)
    np.testing.assert_allclose(coarse.odometry.quaternion, fine.odometry.quaternion, atol=1e-5)


def test_the_same_seed_gives_the_same_run_and_the_motion_does_not_depend_on_it():
    first, same, other = (run(plant_of(seed=s), 20, thrust=[9.0] * M) for s in (1, 1, 2))
    for truth in (same, other):
        np.testing.assert_array_equal(truth.odometry.position, first.odometry.position)
        np.testing.assert_array_equal(truth.joints.position, first.joints.position)


def test_truth_belongs_to_its_reader():
    plant = plant_of()
    before = plant.truth()
    position = before.odometry.position.copy()
    run(plant, 5, thrust=[50.0] * M)
    np.testing.assert_array_equal(before.odometry.position, position)
    plant.truth().odometry.position[:] = 1e9
    assert plant.truth().odometry.position[0] < 1.0


def test_a_command_of_wrong_size_is_refused_and_nothing_happens():
    plant = plant_of()
    with pytest.raises(SignalError) as fault:
        plant.step(ThrusterCommand(0, np.zeros(3)), None)
    assert str(fault.value) == (
        "thruster_command.thrust has shape (3,); it must have (7,) for main, side_fore, side_aft,"
        " vertical_fore_port, vertical_fore_starboard, vertical_aft_port, vertical_aft_starboard"
    )
    assert plant.stamp == 0


def test_a_command_that_is_not_finite_is_refused_and_nothing_happens():
    plant = plant_of()
    bad = JointCommand(0, np.array([0.0, np.nan, 0.0, np.inf]))
    with pytest.raises(SignalError) as fault:
        plant.step(None, bad)
    assert str(fault.value) == "joint_command.effort[shoulder] is nan; it must be finite"
    assert plant.stamp == 0
    run(plant, 1)
    assert plant.stamp == 50_000_000


def test_divergence_is_named_with_time_and_quantity():
    """A drive without limits, before no stop, for one period."""
    swing = {"effort_limit_nm": 1e200, "stop_stiffness_nm_rad": 0.0}
    endless = load_vehicle(overrides={f"arm.joints.swing.{k}": v for k, v in swing.items()})
    plant = plant_of(endless)
    run(plant, 3)
    with pytest.raises(PlantDiverged) as fault:
        run(plant, 1, effort=[1e200, 0.0, 0.0, 0.0])
    text = str(fault.value)
    start = (
        "the plant diverged at t = 0.155 s with step_s = 0.005 s: rate of joint swing [rad/s] is"
    )
    assert text.startswith(start)
    assert "; 0.005 s before it was " in text


def test_a_start_that_is_not_finite_is_named():
    free = load_vehicle(
        overrides={"hull.linear_damping": [0.0] * 6, "hull.quadratic_damping": [0.0] * 6}
    )
    config = PlantConfig().model_copy(  # past the bounds, which a file cannot do
        update={"initial_velocity": (1e170, 0.0, 0.0, 0.0, 1e170, 0.0)}
    )
    with pytest.raises(PlantDiverged, match=r"at t = 0\.000 s .*: derivative of .* is nan"):
        Plant(free, config, seed=1)


@pytest.mark.parametrize(
    ("config", "text"),
    [
        (
            {"control_period_s": 0.012},
            "control_period_s: its period of 0.012 s must be a multiple of step_s = 0.005 s",
        ),
        (
            {"step_s": 0.004, "control_period_s": 0.02},
            "sensors.imu.rate_hz: its period of 0.01 s must be a multiple of step_s = 0.004 s",
        ),
        (
            {"initial_joints_deg": (1.0, 2.0)},
            "initial_joints_deg: has 2 values for 4 joints: swing, shoulder, elbow, wrist",
        ),
        (
            {"step_s": 0.05},
            "step_s: 0.05 s is unstable with the stop_dissipation_s_rad of arm.joints.0 (swing): a"
            " mode of 354 1/s, swing pressed at effort_limit_nm; allowed: at most 0.00786 s",
        ),
        (
            {"initial_joints_deg": (0.0, 120.0, 0.0, 0.0)},
            "initial_joints_deg: 120 of joint shoulder is outside its limits -30 to 100",
        ),
    ],
)
def test_a_configuration_that_cannot_work(config, text):
    with pytest.raises(ConfigError) as fault:
        plant_of(**config)
    assert str(fault.value) == text


def test_a_step_near_the_longest_that_is_allowed_is_stable():
    slow_sensors = load_vehicle(
        overrides={f"sensors.{name}.rate_hz": 1.0 for name in ("imu", "dvl", "pressure", "gps")}
    )
    truth = run(plant_of(slow_sensors, step_s=0.0078125, control_period_s=0.0625), 320)
    assert np.abs(truth.joints.velocity).max() < 0.5


@pytest.mark.parametrize(
    ("path", "value", "text"),
    [
        (
            "arm.joints.wrist.stop_stiffness_nm_rad",
            1e6,
            "step_s: 0.005 s is unstable with the stop_stiffness_nm_rad of arm.joints.3 (wrist): a"
            " mode of 6.34e+03 1/s, wrist striking at the rate limit;"
            " allowed: at most 0.000346 s",
        ),
        (
            "thrusters.main.time_constant_s",
            1e-3,
            "step_s: 0.005 s is unstable with the time_constant_s of thrusters.0 (main): a"
            " mode of 1e+03 1/s, at the start; allowed: at most 0.00278 s",
        ),
        (
            "sensors.dvl.rate_hz",
            7.0,
            "sensors.dvl.rate_hz: its period of 0.142857 s must be a multiple of step_s = 0.005 s",
        ),
    ],
)
def test_a_vehicle_that_this_step_cannot_run(path, value, text):
    with pytest.raises(ConfigError) as fault:
        plant_of(load_vehicle(overrides={path: value}))
    assert str(fault.value) == text
