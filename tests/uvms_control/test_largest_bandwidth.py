"""Gains by rule: they keep their limits, scale with the vehicle, and are refused beyond."""

from dataclasses import replace

import numpy as np
import pytest

from uvms_control import ControlConfig, GainConfig
from uvms_control.controller import Controller
from uvms_control.design import (
    Axis,
    AxisGains,
    Limits,
    Timing,
    largest_bandwidth,
    loop_margins,
    sensor_noise,
    vehicle_axes,
)
from uvms_control.design.conditions import Gains, check_slopes
from uvms_control.design.gains import axis_designs
from uvms_control.errors import ControlSetupError
from uvms_control.paper_controller import PaperController
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.locate import known_vehicles, vehicle_path
from uvms_dynamics import build_model, mass_matrix
from uvms_dynamics.sensor_noise import settled

FREE = Axis(inertia=300.0, lag=0.12, authority=90.0, observer=0.9)
HULL = Axis(inertia=5.0, righting=28.0, drag=5.0, lag=0.12, authority=19.6, observer=0.8)
PERIOD = 0.05


def vehicle_of(name):
    return load_vehicle(vehicle_path(name))


@pytest.mark.parametrize("axis", [FREE, HULL, replace(FREE, lag=0.02), replace(HULL, lag=0.05)])
def test_the_loop_keeps_its_limits_and_would_not_with_more(axis):
    limits = Limits()
    found = largest_bandwidth(axis, limits)
    margins = found.margins
    assert margins.delay_margin >= limits.delay_periods * axis.period
    assert margins.gain_margin >= limits.gain
    assert margins.phase_margin >= limits.phase * (1.0 - 1e-6)
    assert margins.damping_ratio >= limits.damping * (1.0 - 1e-9)
    more = 1.01 * found.bandwidth
    whole = more**2 + axis.righting / axis.inertia
    gains = AxisGains(more**2, 2.0 * found.ratio * np.sqrt(whole), axis.observer)
    beyond = loop_margins(axis, gains)
    worse = {
        "delay margin": beyond.delay_margin < limits.delay_periods * axis.period,
        "gain margin": beyond.gain_margin < limits.gain,
        "phase margin": beyond.phase_margin < limits.phase,
        "damping": beyond.damping_ratio < limits.damping,
    }
    assert worse[found.limited_by]


def test_a_stiff_hull_with_a_slow_loop_keeps_at_least_its_own_damping():
    """No gains give this hull a damping ratio of a half; what is added takes nothing away."""
    slow = replace(HULL, period=0.2)
    found = largest_bandwidth(slow)
    own = loop_margins(slow, AxisGains(0.0, 0.0)).damping_ratio
    assert own < found.margins.damping_ratio < 0.5
    assert found.margins.delay_margin >= 2.0 * slow.period


def test_ideal_thrusters_are_bounded_by_the_period_alone():
    """The loop has no other time in it: the bandwidth is inverse to the period."""
    one, other = (
        largest_bandwidth(Axis(inertia=1.0, period=period)).bandwidth for period in (0.05, 0.1)
    )
    assert one == pytest.approx(2.0 * other, rel=5e-3)


def test_a_vehicle_that_is_slower_in_all_its_times_gets_a_bandwidth_as_much_lower():
    slow = replace(FREE, lag=3.0 * FREE.lag, period=3.0 * FREE.period, observer=FREE.observer / 3.0)
    expected = largest_bandwidth(FREE).bandwidth / 3.0
    assert largest_bandwidth(slow).bandwidth == pytest.approx(expected, rel=5e-3)


def test_size_alone_changes_nothing():
    big = replace(HULL, inertia=50.0, righting=280.0, drag=50.0, authority=196.0)
    assert largest_bandwidth(big).gains == largest_bandwidth(HULL).gains


def test_noise_bounds_the_bandwidth_where_the_authority_is_small():
    noisy = replace(FREE, rate_noise=0.01, authority=90.0)
    found = largest_bandwidth(noisy)
    assert found.limited_by == "noise"
    assert found.bandwidth < largest_bandwidth(FREE).bandwidth
    assert found.margins.noise_share == pytest.approx(0.05, rel=0.01)
    assert found.margins.noise_share <= 0.05


def test_a_bandwidth_that_is_asked_for_is_not_exceeded():
    found = largest_bandwidth(FREE, Limits(highest=0.7))
    assert (found.bandwidth, found.limited_by) == (0.7, "asked for")


def test_lag_that_the_allocator_makes_up_for_allows_more():
    made_up = replace(FREE, lag_compensated=1.0)
    assert largest_bandwidth(made_up).bandwidth > 1.3 * largest_bandwidth(FREE).bandwidth


def test_steady_state_of_the_scalar_filter_is_that_of_its_recursion():
    variance = 1.0
    for _ in range(2000):
        predicted = variance + 0.03**2
        variance = predicted * 0.2**2 / (predicted + 0.2**2)
    assert settled(0.03, 0.2) == pytest.approx(np.sqrt(variance))


def test_axes_of_the_reference_vehicle():
    vehicle = vehicle_of("reference_auv")
    q = np.radians(vehicle.arm.stowed_deg)
    axes = vehicle_axes(vehicle, q, Timing(PERIOD))
    inertia = np.diag(mass_matrix(build_model(vehicle), q))[:6]
    assert [axis.inertia for axis in axes] == pytest.approx(list(inertia))
    assert [axis.authority for axis in axes] == pytest.approx([98, 98, 196, 19.6, 107.8, 73.5])
    assert [axis.lag for axis in axes] == [0.15, 0.12, 0.12, 0.12, 0.12, 0.12]
    # First moment of weight less buoyancy of hull and stowed arm, by the statics of the file.
    assert axes[3].righting == axes[4].righting == pytest.approx(27.805, abs=1e-3)
    assert axes[5].righting == 0.0


def test_noise_of_the_rates_is_the_gyros():
    vehicle = vehicle_of("bluerov2_alpha5")
    pose, rate = sensor_noise(vehicle)
    assert rate[3:] == pytest.approx(np.radians([0.05] * 3))
    assert rate[0] < vehicle.sensors.dvl.noise_m_s
    assert list(pose[:2]) == [0.0, 0.0]


def test_an_axis_without_authority_is_left_to_the_hull():
    designs = axis_designs(vehicle_of("bluerov2_alpha5"), PERIOD, ControlConfig().gains)
    assert [axis is None for axis in designs] == [False] * 4 + [True, False]


@pytest.mark.parametrize("name", sorted(known_vehicles()))
@pytest.mark.parametrize("law", [Controller, PaperController])
def test_every_vehicle_keeps_the_conditions_with_the_defaults(name, law):
    law(vehicle_of(name), ControlConfig()).prepare(PERIOD)


@pytest.mark.parametrize(
    ("law", "change", "message"),
    [
        (
            Controller,
            {
                "gains": {
                    "bandwidth_rad_s": (2.0, 2.0, 30.0, 2.0, 2.0, 2.0),
                    "lag_compensation": 0.0,
                }
            },
            "control.gains.bandwidth_rad_s of heave: 30 rad/s makes the loop unstable, with a"
            " control period of 0.05 s and thrusters with 0.12 s of lag; at most 8.67 rad/s",
        ),
        (
            Controller,
            {
                "gains": {
                    "bandwidth_rad_s": (2.0,) * 6,
                    "damping_ratio": (1.0, 1.0, 1.0, 40.0, 1.0, 1.0),
                }
            },
            "control.gains.damping_ratio of roll: 40 makes the loop unstable, with a control"
            " period of 0.05 s and thrusters with 0.12 s of lag; at most ",
        ),
        (
            PaperController,
            {"vehicle": {"k_rate": (90.0,) * 6}},
            "control.vehicle.k_rate of surge: 90 makes the loop unstable, with a control"
            " period of 0.05 s and thrusters with 0.15 s of lag; at most ",
        ),
    ],
)
def test_an_unstable_gain_is_refused_with_its_bound(law, change, message):
    controller = law(vehicle_of("reference_auv"), ControlConfig(**change))
    with pytest.raises(ControlSetupError) as error:
        controller.prepare(PERIOD)
    assert str(error.value).startswith(message)


def test_the_bound_of_a_refused_gain_is_where_the_loop_turns_unstable():
    axis = Axis(inertia=3.0, period=0.1)
    one = np.ones(6)
    with pytest.raises(ControlSetupError, match=r"^k_d of surge: 50 .* at most \S+$") as error:
        check_slopes([axis] * 6, Gains("k_p", one, one), Gains("k_d", 50.0 * one, 25.0 * one))
    bound = float(str(error.value).split("at most ")[1])
    # Without lag: z^2 - (2 - hD - h^2 P/2) z + 1 - hD + h^2 P/2 is stable for h D < 2.
    assert bound == pytest.approx(40.0, rel=1e-3)


def test_gains_must_be_positive():
    none, one = Gains("k_d", np.zeros(6), np.zeros(6)), np.ones(6)
    with pytest.raises(ControlSetupError, match="k_d of surge: 0, expected above 0"):
        check_slopes([FREE] * 6, Gains("k_p", one, one), none)


@pytest.mark.parametrize("righting", [-0.05, -1.0, -5.0])
def test_a_hull_that_turns_over_is_held(righting):
    """No small bandwidth keeps it up, so that the least one has to be looked for."""
    axis = replace(HULL, righting=righting, lag=0.02)
    found = largest_bandwidth(axis)
    assert found.bandwidth > np.sqrt(-righting / axis.inertia)
    assert found.margins.stable


def test_limits_that_nothing_keeps_are_refused():
    config = ControlConfig(gains={"delay_margin_periods": 20.0})
    upside_down = load_vehicle(overrides={"hull.cb_m": [0.0, 0.0, 0.03]})
    with pytest.raises(ControlSetupError, match=r"no bandwidth of \w+ keeps the margins; lower"):
        Controller(upside_down, config).prepare(PERIOD)


def test_poor_sensors_cost_more_thrust_and_not_the_control():
    """Noise that takes more than its share at any bandwidth: there are gains all the same."""
    vehicle = load_vehicle(overrides={"sensors.dvl.noise_m_s": 5.0})
    for config in (GainConfig(), GainConfig(noise_share=1e-6)):
        designs = axis_designs(vehicle, PERIOD, config)
        assert all(each.gains.stiffness > 0.0 for each in designs)
    assert designs[0].limited_by == "noise"
