"""The scenarios of the project run on arms of four, five and seven joints."""

import numpy as np
from arms import every_arm, vehicle_name
from test_scenarios import Watch

from uvms_bringup.loop import LoopTick
from uvms_bringup.scenario import load_scenario
from uvms_bringup.simulate import simulate
from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.signals import to_seconds
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.frames import arm_length
from uvms_dynamics import build_model, end_effector

PHASES = [
    {"duration_s": 16.0, "to_m": [0.0, 0.0, 0.35]},
    {"duration_s": 16.0, "to_m": [0.0, 0.0, 0.15], "bulge_m": [0.1, 0.0, 0.0]},
    {"duration_s": 16.0, "to_m": [0.0, 0.0, 0.0], "bulge_m": [0.0, 0.1, 0.0]},
]
"""The manipulation's path in 48 instead of 900 s."""

BEGAN = 1.0
"""Stamp of the path's start, s: two planner steps after the goal comes."""


@every_arm
def test_the_arm_swings_from_side_to_side(name, tmp_path):
    scenario = load_scenario("arm_swing", vehicle=vehicle_name(name, tmp_path))
    vehicle = scenario.load_vehicle()
    goal = scenario.goal.build(vehicle, scenario.plant)
    watch, joints = Watch(build_model(vehicle)), []

    def observe(tick: LoopTick) -> None:
        watch.see(tick)
        joints.append(tick.truth.joints.position)

    assert simulate(scenario, vehicle, goal, observe=observe)
    sides = []
    for time, expected in zip((15.9, 33.9, 49.0), goal.positions[[0, 2, 4]], strict=True):
        k = int(np.argmin(np.abs(np.array(watch.stamps) - time)))
        np.testing.assert_allclose(joints[k], expected, atol=np.radians(0.5))
        sides.append((watch.tools[k] - watch.tools[0])[1])
    reach = arm_length(vehicle.arm)
    assert sides[0] > 0.7 * reach  # starboard
    assert sides[1] < -0.4 * reach
    assert abs(sides[2]) < 0.1 * reach
    assert watch.largest_deg(0) < 5.0


@every_arm
def test_the_end_effector_follows_the_path_that_fits_the_arm(name, tmp_path):
    """Judged with the estimated pose: the BlueROV2's pressure sensor alone is 5 cm off."""
    settings = [f"goal.path.phases={PHASES}", "duration_s=50"]
    scenario = load_scenario("manipulation", settings, vehicle=vehicle_name(name, tmp_path))
    vehicle = scenario.load_vehicle()
    goal = scenario.goal.build(vehicle, scenario.plant)
    size = np.ptp(goal.positions, axis=0)[2]
    scale = arm_length(vehicle.arm) / arm_length(load_vehicle().arm)
    np.testing.assert_allclose(size, 0.35 * scale, rtol=1e-9)
    model, stamps, tools, results = build_model(vehicle), [], [], []

    def observe(tick: LoopTick) -> None:
        pose = tick.odometry.position, tick.odometry.quaternion
        stamps.append(to_seconds(tick.stamp))
        tools.append(end_effector(model, *pose, tick.truth.joints.position)[0])
        if tick.plan is not None and tick.plan.finished is not None:
            results.append(tick.plan.finished)

    assert simulate(scenario, vehicle, goal, observe=observe)
    assert [result.success for result in results] == [True]
    assert results[0].max_planned_error < 1e-3
    wanted = EndEffectorPath(goal).positions(np.array(stamps) - BEGAN)
    error = np.linalg.norm(np.array(tools) - wanted, axis=1)
    late = np.array(stamps) > 10.0  # by then the BlueROV2 has come to its rest by the bow
    assert error[late].max() < 0.02
