"""What controller and observer hold of the joints, against the truth of the plant."""

import numpy as np
import pytest

from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario
from uvms_core import topics

SECONDS = 16.0
SETTLED = 20
WRONG = "plant.mismatch={mass: 0.2, added_mass: 0.2, damping: 0.2}"


def flown(vehicle, *further):
    """Estimates of controller and observer and true joints, at each tick of the arm's swing."""
    scenario = load_scenario("arm_swing", [f"vehicle={vehicle}", *further])
    vehicle = scenario.load_vehicle()
    scenario = scenario.for_vehicle(vehicle)
    loop, rows = Loop(scenario, vehicle), []
    while loop.plant.stamp < 1e9 * SECONDS:
        tick = loop.tick()
        if tick.stamp == 0:
            loop.planner.accept(scenario.goal.build(vehicle, scenario.plant))
        control = loop.parts[topics.CONTROLLER].law.arm.observer.estimate
        observed = loop.parts[topics.DISTURBANCE_OBSERVER].law._joints.filter.estimate
        rows.append((control, observed, tick.truth.joints, tick.sensors.joints))
        loop.advance(tick)
    return rows[SETTLED:]


def ratios(rows, who):
    """Mean normalised squared error (n,) of angle and rate, over its expectation."""
    found = []
    for row in rows:
        estimate, true = row[who], row[2]
        errors = np.array([estimate.q - true.position, estimate.q_dot - true.velocity])
        blocks = estimate.covariance[:, :2, :2]
        found.append([e @ np.linalg.solve(b, e) for e, b in zip(errors.T, blocks, strict=True)])
    return np.mean(found, axis=0) / 2.0


def rms(rows, angles):
    return np.sqrt(np.mean([(angles(row) - row[2].position) ** 2 for row in rows], axis=0))


@pytest.mark.parametrize("vehicle", ["reference_auv", "bluerov2_alpha5"])
@pytest.mark.parametrize("further", [(), (WRONG,)], ids=["model", "unlike"])
def test_their_errors_are_what_their_covariances_say(vehicle, further):
    """With a plant that is as its model, and with one that is not; the controller's are cautious.

    The hull shakes the arm less than the thrusters' bound on noise, which its filter counts with.
    """
    rows = flown(vehicle, *further)
    assert (ratios(rows, 0) < 2.0).all()
    assert ((ratios(rows, 1) > 0.5) & (ratios(rows, 1) < 2.5)).all()
    raw = rms(rows, lambda row: row[3].position)
    assert (rms(rows, lambda row: row[0].q) < 0.9 * raw).all()
    assert (rms(rows, lambda row: row[1].q) < 0.75 * raw).all()


@pytest.mark.parametrize(
    "fault",
    [
        "{fault: outliers, rate: 0.05, std: 0.1, field: position}",
        "{fault: bias, bias: 0.01, field: position}",
        "{fault: stuck}",
    ],
    ids=["spikes", "jump", "stuck"],
)
def test_encoders_that_lie_for_a_second_are_survived(fault):
    event = fault.replace("{", "{at_s: 6.0, until_s: 7.0, sensor: encoders, ")
    rows = flown("reference_auv", f"events=[{event}]")
    end = rows[-40:]
    for who in (0, 1):
        errors = [np.abs(row[who].q - row[2].position).max() for row in end]
        assert max(errors) < np.radians(0.05)
