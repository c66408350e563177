"""What the observer makes of a grasp in the closed loop. As a program: the figures of ten seeds."""

import numpy as np
import pytest

from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario

LOAD = {"mass_kg": 1.02, "volume_m3": 0.0005, "at_m": [0.0, 0.0, 0.1]}
WATER, GRAVITY = 1025.0, 9.81
WEIGHT = (LOAD["mass_kg"] - WATER * LOAD["volume_m3"]) * GRAVITY
MASS = LOAD["mass_kg"] + 0.5 * WATER * LOAD["volume_m3"]  # a sphere carries half its water


def estimate(seed, after_s=10.0):
    """When it was confirmed, and what is known of it a while after its grasp at 20 s."""
    event = {"at_s": 20.0, "payload": LOAD}
    scenario = load_scenario("arm_swing", values={"events": [event]}, seed=seed)
    vehicle = scenario.load_vehicle()
    scenario = scenario.for_vehicle(vehicle)
    loop, confirmed = Loop(scenario, vehicle), None
    goal = scenario.goal.build(vehicle, scenario.plant)
    while True:
        tick = loop.tick()
        payload, t = tick.budget.payload, tick.stamp * 1e-9
        if payload.held and confirmed is None:
            confirmed = t
        if t >= 20.0 + after_s:
            return confirmed, payload
        if tick.stamp == 0:
            loop.planner.accept(goal)
        loop.advance(tick)


@pytest.mark.parametrize("seed", [1, 2])
def test_a_payload_in_the_swing(seed):
    vehicle = load_scenario("arm_swing").load_vehicle()
    assert vehicle.environment.water_density_kg_m3 == WATER
    confirmed, payload = estimate(seed)
    assert 20.0 < confirmed <= 21.0
    assert payload.weight == pytest.approx(WEIGHT, rel=0.05)
    assert payload.mass == pytest.approx(MASS, rel=0.1)
    np.testing.assert_allclose(payload.position, LOAD["at_m"], atol=0.03)


if __name__ == "__main__":
    print("seed  confirmed s  weight N       mass kg        position in the tool frame, m")
    for seed in range(1, 11):
        when, found = estimate(seed)
        place = " ".join(
            f"{x:6.3f}+-{s:.3f}" for x, s in zip(found.position, found.position_sigma, strict=True)
        )
        print(
            f"{seed:4d} {when:12.2f} {found.weight:6.2f}+-{found.weight_sigma:.2f}"
            f" {found.mass:7.2f}+-{found.mass_sigma:.2f}  {place}"
        )
    print(f"true {20.0:12.2f} {WEIGHT:6.2f} {MASS:13.2f}  {LOAD['at_m']}")
