"""Where no thruster acts, the hull has the attitude of its own equilibrium."""

import numpy as np

from uvms_bringup.scenario import load_scenario
from uvms_bringup.simulate import simulate
from uvms_dynamics import build_model, quat_to_rpy
from uvms_planner.constraints import free_attitude

PHASES = """goal.path.phases=[{duration_s: 20.0, to_m: [0.0, 0.0, 0.35]},
 {duration_s: 20.0, to_m: [0.0, 0.0, 0.15], bulge_m: [0.1, 0.0, 0.0]},
 {duration_s: 20.0, to_m: [0.0, 0.0, 0.0], bulge_m: [0.0, 0.1, 0.0]}]"""
FOLDED_DEG = [36.0, 143.0, 138.0, 0.0]
"""The posture in which the plan of that path leaves the arm."""
SWUNG_S = 10.0  # four of its natural periods after it was released


def test_the_pitch_of_the_bluerov2_is_that_of_its_hull_with_the_arm_as_it_is():
    scenario = load_scenario(
        "manipulation", [PHASES], duration_s=62.0, vehicle="bluerov2_alpha5", seed=2
    )
    vehicle = scenario.load_vehicle()
    scenario = scenario.for_vehicle(vehicle)
    model, rows = build_model(vehicle), []

    def see(tick):
        truth = tick.truth
        pitch = quat_to_rpy(truth.odometry.quaternion)[1]
        rows.append((1e-9 * tick.stamp, pitch, free_attitude(model, truth.joints.position)[1]))

    simulate(scenario, vehicle, scenario.goal.build(vehicle, scenario.plant), observe=see)
    time, pitch, own = np.array(rows).T
    pitch, own = np.degrees(pitch), np.degrees(own)
    assert 6.0 < abs(own[0]) < 7.0
    assert np.abs(pitch).max() < 2.0 * abs(own[0])  # released level: a pendulum, damped
    assert np.abs(pitch - own)[time > SWUNG_S].max() < 3.0


def test_a_hull_that_swings_comes_to_rest_while_the_arm_holds_the_tool():
    """With the arm following the swing it grew to 6 deg and stayed there."""
    scenario = load_scenario(
        "hover",
        [f"plant.initial_joints_deg={FOLDED_DEG}", "plant.initial_rpy_deg=[0, 8, 0]"],
        duration_s=40.0,
        vehicle="bluerov2_alpha5",
        seed=2,
    )
    stamps, pitch = [], []

    def see(tick):
        stamps.append(1e-9 * tick.stamp)
        pitch.append(np.degrees(quat_to_rpy(tick.truth.odometry.quaternion)[1]))

    vehicle = scenario.load_vehicle()
    simulate(scenario, vehicle, None, observe=see)
    time, pitch = np.array(stamps), np.array(pitch)
    assert np.ptp(pitch[time < 5.0]) > 8.0
    assert np.ptp(pitch[time > 30.0]) < 1.0
