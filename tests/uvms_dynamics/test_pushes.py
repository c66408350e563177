"""Pushes between control ticks: their impulse, and what they leave as it is."""

import numpy as np
import pytest
from random_vehicles import REFERENCE

from uvms_core.errors import ConfigError
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.kernels import mass_matrix
from uvms_dynamics.model import build_model
from uvms_dynamics.simulation import Plant, PlantConfig
from uvms_dynamics.simulation.events import event_from_text

N = REFERENCE.n_joints
BRAKED = {f"arm.joints.{i}.brake_nm": 60.0 for i in range(N)}
AT_REST = load_vehicle(
    None,
    BRAKED
    | {
        "environment.gravity_m_s2": 1e-9,
        "hull.mass_kg": 184.0,
        "hull.cg_m": [0.0, 0.0, 0.012],
    },
)
SWAY = 1


def pushed(begin, until, force):
    text = f"{{at_s: {begin}, until_s: {until}, wrench: {{force_n: [0, {force}, 0]}}}}"
    return event_from_text(text, 0)


def plant_until(ends, *events, vehicle=AT_REST):
    plant = Plant(vehicle, PlantConfig(), 1, events)
    while plant.stamp < 1e9 * ends - 1:
        plant.step(None, None)
    return plant


@pytest.mark.parametrize(
    ("begin", "until", "force", "impulse"),
    [
        (1.0, 1.05, 4.0, 0.2),  # a control period
        (1.01, 1.06, 4.0, 0.2),  # from one into the next
        (1.02, 1.03, 20.0, 0.2),  # within one
        (1.001, 1.049, 10.0, 0.48),  # between plant steps: 50 ms at 9.6 N
        (1.0, 1.005, 40.0, 0.2),  # one plant step
        (0.003, 0.0081, 50.0, 0.255),  # 5 ms at 51 N, from one step after the start
    ],
)
def test_the_impulse_of_a_push_is_what_was_asked_whenever_it_begins_and_ends(
    begin, until, force, impulse
):
    """M dv = F dt with the arm held by its brakes; drag takes half a per cent."""
    truth = plant_until(1.1 if begin > 0.5 else 0.05, pushed(begin, until, force)).truth()
    mass = mass_matrix(build_model(AT_REST), truth.joints.position)[:6, :6]
    momentum = mass @ truth.odometry.nu
    assert momentum[SWAY] == pytest.approx(impulse, rel=0.01)


@pytest.mark.parametrize("vehicle", [REFERENCE, AT_REST], ids=["free arm", "brakes"])
def test_a_control_period_in_pieces_is_the_same_period(vehicle):
    """A push of nothing: every state and every sample stays as it is, to the bit."""
    config = PlantConfig(initial_velocity=(0.5, 0.1, 0.0, 0.0, 0.0, 0.05))
    nothing = pushed(0.11, 0.13, 0.0), pushed(0.12, 0.28, 0.0)
    ours, theirs = (Plant(vehicle, config, 1, events) for events in (nothing, ()))
    for _ in range(8):
        ours.step(None, None)
        theirs.step(None, None)
        np.testing.assert_array_equal(ours.truth().odometry.nu, theirs.truth().odometry.nu)
        for mine, other in zip(ours.sense().imu, theirs.sense().imu, strict=True):
            np.testing.assert_array_equal(mine.linear_acceleration, other.linear_acceleration)
    told = [(event.stamp, event.asked_s) for event in ours.take_happened()]
    assert told == [(110_000_000, 0.11), (120_000_000, 0.12), (130_000_000, 0.13)] + [
        (280_000_000, 0.28)
    ]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "{at_s: 1.001, until_s: 1.002, wrench: {force_n: [1000, 0, 0]}}",
            r"events.0: until_s 1.002: the push from 1.001 s on .* lasts until 1.005 s",
        ),
        (
            "{at_s: 1.01, until_s: 1.05, sensor: dvl, fault: zeros}",
            r"events.0: until_s 1.05: no sample of the dvl, .* every 0.125 s, .* that of 1.125 s",
        ),
        (
            "{at_s: 1.01, until_s: 1.05, sensor: encoders, fault: zeros}",
            r"events.0: until_s 1.05: no sample of the encoders, .* every 0.05 s",
        ),
    ],
)
def test_an_event_that_would_be_over_before_it_has_an_effect_is_refused(text, words):
    with pytest.raises(ConfigError, match=words):
        Plant(REFERENCE, PlantConfig(), 1, (event_from_text(text, 0),))


def test_an_empty_push_is_refused_at_run_time_too():
    plant = plant_until(0.1)
    with pytest.raises(ConfigError, match=r"until_s 0.101: the push from 0.1 s on would be over"):
        plant.apply(event_from_text("{until_s: 0.101, wrench: {}}", plant.stamp))
