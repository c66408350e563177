"""What a vehicle can do is never refused: limp, capsizing, sinking, spinning, in a current."""

import numpy as np
import pytest

from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario

OFF = {"control.enabled": False}
CASES = {
    "nominal": ({}, {}),
    "control off": (OFF, {}),
    "rolled over": (OFF | {"plant.initial_rpy_deg": [170.0, 0.0, 0.0]}, {}),
    "pitched up and spinning": (
        OFF
        | {
            "plant.initial_rpy_deg": [0.0, 80.0, 0.0],
            "plant.initial_velocity": [1.0, 0.5, 0.5, 6.0, 3.0, 3.0],
        },
        {},
    ),
    "strong current": ({"plant.current_ned_m_s": [2.0, -2.0, 0.3]}, {}),
    "ten times the mass": (OFF, {"mass_kg": 10.0}),
    "a tenth of the mass": (OFF, {"mass_kg": 0.1}),
    "heavy above": (OFF, {"cg_m": (0.0, 0.0, -1.0)}),
    "at the surface, with fixes": ({"plant.initial_position_m": [0.0, 0.0, -0.2]}, {}),
    "a fast start": ({"plant.initial_velocity": [4.0, 0.0, 0.0, 0.0, 0.0, 0.0]}, {}),
}


@pytest.mark.parametrize("vehicle", ["reference_auv", "bluerov2_alpha5"])
@pytest.mark.parametrize(("settings", "hull"), CASES.values(), ids=CASES)
def test_nothing_that_a_vehicle_can_do_is_refused(settings, hull, vehicle):
    changes = [f"vehicle={vehicle}", *(f"{name}={value}" for name, value in settings.items())]
    scenario = load_scenario("hover", changes)
    model = scenario.load_vehicle()
    values = dict(hull)
    if "mass_kg" in values:
        values["mass_kg"] *= model.hull.mass_kg
    # no file would be taken with these, but a plant may have them
    odd = model.model_copy(update={"hull": model.hull.model_copy(update=values)})
    loop = Loop(scenario, odd)
    for _ in range(200):
        tick = loop.tick()
        loop.advance(tick)
    process = loop._process
    assert (process.refused, process.unsafe) == (0, 0)
    assert np.isfinite(tick.odometry.position).all()
