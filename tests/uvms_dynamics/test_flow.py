"""How the water moves: currents by their definitions, waves by the equations of potential flow."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_vehicles import REFERENCE

from uvms_dynamics.numpy_reference.flow import flow_at
from uvms_dynamics.simulation.water import CurrentConfig, build_water
from uvms_dynamics.simulation.water.airy import highest_wave, wave_length, wave_number
from uvms_dynamics.simulation.water.stream import stream_at
from uvms_dynamics.simulation.water.waves import wave_head, wave_motion_at

GRAVITY = REFERENCE.environment.gravity_m_s2
TURNING = {"speed_m_s": 0.2, "period_s": 30.0, "start_deg": 40.0}
GUST = {"at_s": 3.0, "duration_s": 5.0, "velocity_ned_m_s": [0.1, 0.8, -0.05], "rise_s": 1.5}
OSCILLATING = {"amplitude_m_s": 0.3, "period_s": 7.0, "direction_deg": 70.0, "phase_deg": 25.0}
WAVES = [
    {"height_m": 0.8, "period_s": 6.0, "water_depth_m": 15.0, "direction_deg": 30.0},
    {"height_m": 0.4, "period_s": 4.0, "water_depth_m": 15.0, "direction_deg": 110.0}
    | {"phase_deg": 50.0},
]
ALL = CurrentConfig(
    constant_ned_m_s=(0.1, -0.2, 0.03),
    turning=TURNING,
    gusts=[GUST, GUST | {"at_s": 4.0, "velocity_ned_m_s": [-0.2, 0.0, 0.1]}],
    oscillating=[OSCILLATING, OSCILLATING | {"direction_deg": -20.0, "period_s": 3.0}],
    waves=WAVES,
)
PLACES = st.tuples(st.floats(-50.0, 50.0), st.floats(-50.0, 50.0), st.floats(0.5, 14.5))
TIMES = st.floats(0.0, 12.0)


def at(place, time, current=ALL):
    return flow_at(current, np.asarray(place, dtype=float), time, GRAVITY)


def slope(of, at, h=1e-5):
    """Central difference with respect to a number."""
    return (of(at + h) - of(at - h)) / (2.0 * h)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(PLACES, TIMES)
def test_rates_and_gradients_are_those_of_the_velocity(place, time):
    flow = at(place, time)
    np.testing.assert_allclose(flow.rate, slope(lambda t: at(place, t).velocity, time), atol=1e-6)
    for axis, unit in enumerate(np.eye(3)):
        found = slope(lambda d, u=unit: at(place + d * u, time).velocity, 0.0)
        np.testing.assert_allclose(flow.gradient[:, axis], found, atol=1e-8)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(PLACES, TIMES)
def test_waves_have_no_source_and_no_rotation(place, time):
    """The velocity is the gradient of a potential that satisfies Laplace's equation."""
    gradient = np.array(
        [slope(lambda d, u=unit: at(place + d * u, time).velocity, 0.0) for unit in np.eye(3)]
    )
    assert abs(np.trace(gradient)) < 1e-8
    np.testing.assert_allclose(gradient, gradient.T, atol=1e-8)


@pytest.mark.parametrize("wave", WAVES)
def test_no_water_goes_through_the_bottom(wave):
    current = CurrentConfig(waves=[wave])
    for x in np.linspace(0.0, 60.0, 13):
        assert at([x, -x, 15.0], 1.0, current).velocity[2] == 0.0
        assert abs(at([x, -x, 14.0], 1.0, current).velocity[2]) > 0.0


@pytest.mark.parametrize("wave", WAVES)
def test_the_surface_moves_with_the_water_and_has_no_pressure(wave):
    """Both linear conditions at z = 0: d eta / dt = -w, and p = rho g eta there."""
    current = CurrentConfig(waves=[wave])
    waves = build_water(REFERENCE, current).waves
    k = waves[0, 0]
    for north in np.linspace(0.0, 40.0, 9):
        place = np.array([north, 5.0, 0.0])

        def surface(t, place=place):
            way = place[0] * waves[0, 2] + place[1] * waves[0, 3]
            return waves[0, 5] * np.cos(k * way - waves[0, 1] * t + waves[0, 4])

        rise = slope(surface, 2.0, 1e-4)
        np.testing.assert_allclose(at(place, 2.0, current).velocity[2], -rise, atol=1e-8)
        np.testing.assert_allclose(wave_head(waves, place, 2.0), surface(2.0), atol=1e-12)


@settings(max_examples=30, deadline=None, derandomize=True)
@given(PLACES, TIMES)
def test_pressure_under_waves_accelerates_the_water(place, time):
    """Euler's equation, linear: du/dt = -g grad(head)."""
    current = CurrentConfig(waves=WAVES)
    waves, place = build_water(REFERENCE, current).waves, np.array(place)
    gradient = [
        slope(lambda d, u=unit: wave_head(waves, place + d * u, time), 0.0) for unit in np.eye(3)
    ]
    np.testing.assert_allclose(
        at(place, time, current).rate, -GRAVITY * np.array(gradient), atol=1e-8
    )


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.floats(1.0, 60.0), st.floats(0.1, 12000.0))
def test_wave_numbers_satisfy_the_dispersion_relation(period, depth):
    k = wave_number(period, depth, GRAVITY)
    omega = 2.0 * np.pi / period
    np.testing.assert_allclose(GRAVITY * k * np.tanh(k * depth), omega**2, rtol=1e-12)


def test_lengths_of_deep_and_shallow_water():
    """1.56 T^2 in deep water, T sqrt(g h) in shallow; Miche's 0.142 and 0.89 h."""
    assert wave_length(8.0, 500.0) == pytest.approx(9.80665 * 64.0 / (2.0 * np.pi), rel=1e-9)
    assert wave_length(60.0, 0.5) == pytest.approx(60.0 * np.sqrt(9.80665 * 0.5), rel=1e-3)
    assert highest_wave(8.0, 500.0) == pytest.approx(0.142 * wave_length(8.0, 500.0))
    assert highest_wave(60.0, 0.5) == pytest.approx(0.142 * 2.0 * np.pi * 0.5, rel=1e-3)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.tuples(st.floats(-50.0, 50.0), st.floats(-50.0, 50.0), st.floats(-2.0, 17.0)), TIMES)
def test_the_kernels_have_the_same_flow(place, time):
    """Waves and stream are apart in the kernels; above the surface and below the bottom, too."""
    expected, water = at(place, time), build_water(REFERENCE, ALL)
    moving = stream_at(water, np.array([time]))[0]
    carried = np.array(ALL.constant_ned_m_s) + moving[:3]
    waves = wave_motion_at(water.waves, np.array([place]), carried[None], np.array([time]))[0]
    np.testing.assert_allclose(carried + waves[:3], expected.velocity, atol=1e-13)
    np.testing.assert_allclose(moving[3:] + waves[3:], expected.acceleration, atol=1e-12)


def test_a_gust_moves_the_water_by_its_speed_times_its_duration_less_a_rise():
    water = build_water(REFERENCE, CurrentConfig(gusts=[GUST]))
    times = np.linspace(0.0, 12.0, 12001)
    flow = stream_at(water, times)
    expected = np.array(GUST["velocity_ned_m_s"]) * (5.0 - 1.5)
    np.testing.assert_allclose(np.trapezoid(flow[:, :3], times, axis=0), expected, atol=1e-6)
    np.testing.assert_allclose(np.trapezoid(flow[:, 3:], times, axis=0), 0.0, atol=1e-6)
    np.testing.assert_allclose(flow[6000, :3], GUST["velocity_ned_m_s"], atol=1e-15)
    np.testing.assert_array_equal(flow[times > 8.0], 0.0)


def test_a_turning_current_goes_round_clockwise_at_its_speed():
    water = build_water(REFERENCE, CurrentConfig(turning=TURNING | {"start_deg": 0.0}))
    flow = stream_at(water, np.array([0.0, 7.5, 15.0, 30.0]))[:, :3]
    expected = 0.2 * np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [1, 0, 0]])
    np.testing.assert_allclose(flow, expected, atol=1e-15)


@pytest.mark.parametrize("depth", [1.0, 12000.0])
def test_no_wave_overflows(depth):
    """Neither the shortest in the deepest sea nor the longest in a puddle."""
    for period in (1.0, 60.0):
        wave = {"height_m": 0.1, "period_s": period, "water_depth_m": depth}
        water = build_water(REFERENCE, CurrentConfig(waves=[wave]))
        places = np.array([[1.0, 2.0, z * depth] for z in (0.0, 0.5, 1.0)])
        flow = wave_motion_at(water.waves, places, np.zeros((3, 3)), np.zeros(3))
        assert np.isfinite(flow).all()
        assert np.abs(flow[0]).max() > 0.0
