"""The vehicle's default law against the plant, the paper's law and no control at all."""

from functools import cache

import numpy as np
import pytest

from uvms_bringup.scenario import load_scenario
from uvms_bringup.simulate import simulate
from uvms_dynamics import quat_to_rpy

STILL = ("plant.current_ned_m_s=[0, 0, 0]",)
DEEP = (*STILL, "plant.initial_position_m=[0, 0, 10]")
GUST = (
    *DEEP,
    "plant.current={gusts: [{at_s: 5.0, duration_s: 14.0, velocity_ned_m_s: [0.0, 0.8, 0.0],"
    " rise_s: 1.0}]}",
)
WAVES = (
    *DEEP,
    "plant.current={oscillating: [{amplitude_m_s: 0.2, period_s: 8.0, direction_deg: 90.0}]}",
)
BUOYANCY = (*STILL, "plant.vehicle_overrides.hull.cb_m=[0.0, 0.0024, 0.0]")


@cache
def run(name, duration, *settings):
    """Greatest roll, degrees, and greatest distance from the start, m."""
    scenario = load_scenario(name, list(settings), duration_s=duration)
    vehicle = scenario.load_vehicle()
    poses = []

    def keep(tick):
        true = tick.truth.odometry
        poses.append((*true.position, quat_to_rpy(true.quaternion)[0]))

    simulate(scenario, vehicle, scenario.goal.build(vehicle, scenario.plant), observe=keep)
    found = np.array(poses)
    moved = np.linalg.norm(found[:, :3] - found[0, :3], axis=1)
    return np.degrees(np.abs(found[:, 3]).max()), moved.max()


def test_the_swing_rolls_the_vehicle_by_less_than_half_a_degree():
    roll, _ = run("arm_swing", 40.0)
    assert roll < 0.4


@pytest.mark.parametrize("observer", ["combined", "none"])
def test_buoyancy_off_its_place_is_borne_better_than_without_control(observer):
    """2.4 mm to starboard: the hull's own equilibrium is at 8.9 degrees."""
    settings = BUOYANCY if observer != "none" else (*BUOYANCY, "observer=none")
    roll, _ = run("hover", 20.0, *settings)
    free, _ = run("hover", 20.0, *BUOYANCY, "control=off")
    assert free > 8.0
    assert roll < 0.5 * free


@pytest.mark.parametrize("external", ["true", "false"])
def test_a_gust_rolls_the_vehicle_less_than_without_control(external):
    roll, moved = run("hover", 25.0, *GUST, f"observer.external={external}")
    free, drift = run("hover", 25.0, *GUST, "control=off")
    assert roll < free
    assert moved < drift


def test_in_waves_the_default_law_is_better_than_the_paper_s_and_than_none():
    default, paper, free = (
        run("hover", 25.0, *WAVES, setting)
        for setting in ("control=default", "control=paper", "control=off")
    )
    assert default[0] < min(free[0], paper[0])
    assert default[1] < 0.2 * free[1]
    assert default[1] < 0.5 * paper[1]
