"""What a vehicle can do is never refused, and does not lose the filter: limp, capsizing, sinking,
spinning, in a current, thrown about by its own thrusters and against its joints' stops."""

from dataclasses import replace

import numpy as np
import pytest

from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario
from uvms_core import topics
from uvms_core.plausibility import Plausibility

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
    "at the surface, with fixes": ({"plant.initial_position_m": [0.0, 0.0, 0.05]}, {}),
    "a fast start": ({"plant.initial_velocity": [4.0, 0.0, 0.0, 0.0, 0.0, 0.0]}, {}),
}


SPHERE = 3.76
"""Distance within which 99.9 % of a right filter's errors in space are."""
START_S = 1.0
"""By which a filter that was told a wrong start has found the right one."""


MOST_M = {"reference_auv": 0.05, "bluerov2_alpha5": 0.3}
"""Error of the position after ten seconds, by the class of the sensors."""
WAY = 0.1
"""Share of the way travelled that is allowed for besides: some fall or rise by metres a second."""


def distance(loop, tick):
    """How far off the estimated position is, in its own standard deviations and in m; the place."""
    place = loop.plant.truth().odometry.position
    error = tick.odometry.position - place
    covariance = tick.odometry.pose_covariance[:3, :3]
    sigmas = np.sqrt(error @ np.linalg.solve(covariance, error))
    return float(sigmas), float(np.linalg.norm(error)), place.copy()


def check_estimate(distances, errors, places, most):
    way = np.linalg.norm(np.diff(places, axis=0), axis=1).sum()
    assert np.mean(np.array(distances) < SPHERE) > 0.99
    assert max(errors) < most + WAY * way


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
    off = []
    for _ in range(200):
        tick = loop.tick()
        off.append(distance(loop, tick))
        loop.advance(tick)
    process = loop._process
    assert (process.refused, process.unsafe) == (0, 0)
    if "plant.initial_velocity" in settings:  # of which nobody has told the filter
        off = off[round(START_S / 0.05) :]
    check_estimate(*zip(*off, strict=True), MOST_M[vehicle])


REVERSAL_TICKS = 15
"""Time in which the arm gets from stop to stop, and the thrusters to their limit and stay there."""


def unusual(model, name):
    """A plant that its vehicle file does not describe: five times the noise, other masses."""
    hull, sensors = model.hull, model.sensors
    if name == "five times the noise":
        noisier = {
            sensor: section.model_copy(
                update={
                    field: 5.0 * getattr(section, field)
                    for field in type(section).model_fields
                    if "noise" in field
                }
            )
            for sensor, section in ((each, getattr(sensors, each)) for each in SENSORS)
        }
        return model.model_copy(update={"sensors": sensors.model_copy(update=noisier)})
    factor = {"ten times the mass": 10.0, "a tenth of the mass": 0.1}.get(name, 1.0)
    heavier = hull.model_copy(update={"mass_kg": factor * hull.mass_kg})
    return model.model_copy(update={"hull": heavier})


SENSORS = ("imu", "dvl", "pressure", "gps", "encoders")
UNUSUAL = (
    "five times the noise",
    "ten times the mass",
    "a tenth of the mass",
    "joints thrown from stop to stop",
    "joints thrown from stop to stop, rolled over",
    "thrusters reversed",
    "joints and thrusters",
)


@pytest.mark.parametrize("vehicle", ["reference_auv", "bluerov2_alpha5"])
@pytest.mark.parametrize("name", UNUSUAL)
def test_nothing_is_refused_by_bounds_of_another_vehicle_or_at_full_authority(name, vehicle):
    roll = 170.0 if "rolled" in name else 0.0
    scenario = load_scenario(
        "hover", [f"vehicle={vehicle}", f"plant.initial_rpy_deg=[{roll}, 0.0, 0.0]"]
    )
    model = scenario.load_vehicle()
    loop = Loop(scenario, unusual(model, name))
    process = loop._process
    process._plausibility = Plausibility(model)  # nobody has told it
    limits = np.array([thruster.greatest_n for thruster in model.thrusters])
    torques = np.array([joint.effort_limit_nm for joint in model.arm.joints])
    off = []
    for k in range(200):
        tick, way = loop.tick(), 1.0 if (k // REVERSAL_TICKS) % 2 else -1.0
        outputs = []
        for topic, signal in tick.outputs:
            if topic is topics.THRUSTER_COMMAND and "thrusters" in name:
                signal = replace(signal, thrust=way * limits)
            if topic is topics.THRUSTER_COMMAND and "joints" in name:  # the arm alone moves it all
                signal = replace(signal, thrust=0.0 * limits)
            if topic is topics.JOINT_COMMAND and "joints" in name:
                signal = replace(signal, effort=way * torques)
            outputs.append((topic, signal))
        off.append(distance(loop, tick))
        loop.advance(replace(tick, outputs=outputs))
    assert (process.refused, process.unsafe) == (0, 0)
    check_estimate(*zip(*off, strict=True), MOST_M[vehicle])
